// Sample patterns by name.
#include "passes/temporal/temporal.hpp"

#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <random>
#include <string_view>

namespace helio {
namespace {

using Positions = std::vector<std::array<float, 2>>;

constexpr const char* kNames =
    "none, fxaa, taa, taau2, taau3, taau4, msaa2, msaa4, msaa8, msaa16, or samples each shaded: ssaaN, "
    "gridN, jitterN (N x N), randomN";

/** Vulkan's standard sample locations (Vulkan 1.3, 26.4), in sixteenths of a pixel. */
Positions standardPositions(std::uint32_t count) {
    switch (count) {
        case 2:
            return {{0.75f, 0.75f}, {0.25f, 0.25f}};
        case 4:
            return {{0.375f, 0.125f}, {0.875f, 0.375f}, {0.125f, 0.625f}, {0.625f, 0.875f}};
        case 8:
            return {{0.5625f, 0.3125f}, {0.4375f, 0.6875f}, {0.8125f, 0.5625f}, {0.3125f, 0.1875f},
                    {0.1875f, 0.8125f}, {0.0625f, 0.4375f}, {0.6875f, 0.9375f}, {0.9375f, 0.0625f}};
        case 16:
            return {{0.5625f, 0.5625f}, {0.4375f, 0.3125f}, {0.3125f, 0.625f},  {0.75f, 0.4375f},
                    {0.1875f, 0.375f},  {0.625f, 0.8125f},  {0.8125f, 0.6875f}, {0.6875f, 0.1875f},
                    {0.375f, 0.875f},   {0.5f, 0.0625f},    {0.25f, 0.125f},    {0.125f, 0.75f},
                    {0.0f, 0.5f},       {0.9375f, 0.25f},   {0.875f, 0.9375f},  {0.0625f, 0.0f}};
        default:
            return {};
    }
}

/** N points of the R2 sequence (Roberts 2018): any N fills the pixel evenly. Those in the middle of it, which
 * are symmetric about the pixel's centre: the first N would shift the picture. */
Positions lattice(std::uint32_t count) {
    constexpr double g = 1.32471795724474602596;  // g^3 = g + 1
    Positions result;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double step = i - 0.5 * (count - 1.0), x = 0.5 + step / g, y = 0.5 + step / (g * g);
        result.push_back({float(x - std::floor(x)), float(y - std::floor(y))});
    }
    return result;
}

Positions cells(std::uint32_t side, bool jitter, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto place = [&] { return jitter ? random() / 4294967296.0 : 0.5; };
    Positions result;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const double u = place(), v = place();
            result.push_back({float((x + u) / side), float((y + v) / side)});
        }
    return result;
}

Positions uniform(std::uint32_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    Positions result(count);
    for (auto& p : result)
        for (float& c : p) c = float(random() / 4294967296.0);
    return result;
}

}  // namespace

Antialiasing antialiasing(std::string_view name, std::uint32_t seed) {
    using Kind = Antialiasing::Kind;
    const auto refuse = [&](const std::string& fault) {
        throw InputError("", "antialiasing", fault, std::string("choose one of ") + kNames);
    };
    if (name == "none") return {};
    if (name == "fxaa") return {Kind::Fxaa, {}};
    const auto number = [&](std::string_view prefix, std::uint32_t most) -> std::uint32_t {
        if (!name.starts_with(prefix)) return 0;
        std::uint32_t value = 0;
        const char* end = name.data() + name.size();
        const auto [stop, error] = std::from_chars(name.data() + prefix.size(), end, value);
        if (error != std::errc{} || stop != end || value == 0 || value > most)
            refuse(fmt::format("'{}' needs a number from 1 to {}", name, most));
        return value;
    };
    if (const std::uint32_t n = number("msaa", 16)) {
        if (standardPositions(n).empty()) refuse(fmt::format("there is no '{}'", name));
        return {Kind::Multisampling, standardPositions(n)};
    }
    if (name == "taa") return {Kind::Temporal, temporalPositions(1)};
    if (const std::uint32_t n = number("taau", 4)) {
        if (n == 1) refuse("upscaling by 1 is 'taa'");
        return {.kind = Kind::Temporal, .positions = temporalPositions(n), .temporal = {.upscale = n}};
    }
    if (const std::uint32_t n = number("ssaa", 4096)) return {Kind::Supersampling, lattice(n)};
    if (const std::uint32_t n = number("grid", 64)) return {Kind::Supersampling, cells(n, false, seed)};
    if (const std::uint32_t n = number("jitter", 64)) return {Kind::Supersampling, cells(n, true, seed)};
    if (const std::uint32_t n = number("random", 4096)) return {Kind::Supersampling, uniform(n, seed)};
    refuse(fmt::format("'{}' is not known", name));
    return {};
}

}  // namespace helio
