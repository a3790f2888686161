#include "passes/scene/alias_table.hpp"
#include "passes/scene/inversion_tree.hpp"
#include "passes/scene/packed_scene.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace helio::pack {
namespace {

/** Most texels of an environment, so that it fits a texel buffer with its tables. */
constexpr std::uint64_t kMostTexels = std::uint64_t(1) << 26;

/** Linear radiance of an image's texels. */
std::vector<glm::vec3> linearTexels(const TextureImage& image) {
    const std::size_t count = std::size_t(image.width) * image.height;
    std::vector<glm::vec3> texels(count);
    std::visit(
        [&](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            for (std::size_t i = 0; i < count; ++i)
                for (glm::length_t c = 0; c < 3; ++c) {
                    const T value = values[i * 4 + std::size_t(c)];
                    if constexpr (std::is_same_v<T, float>)
                        texels[i][c] = value;
                    else
                        texels[i][c] =
                            float(srgbDecode(double(value) / double(std::numeric_limits<T>::max())));
                }
        },
        image.texels);
    return texels;
}

/** Replaces what is no radiance: NaN and negative values by 0, infinite ones by the largest finite one (a sun
 * that was too bright for its file). Returns how many of each. */
std::array<std::uint64_t, 3> clean(std::vector<glm::vec3>& texels) {
    float largest = 0.0f;
    for (const glm::vec3& texel : texels)
        for (glm::length_t c = 0; c < 3; ++c)
            if (std::isfinite(texel[c])) largest = std::max(largest, texel[c]);
    std::array<std::uint64_t, 3> bad{};
    for (glm::vec3& texel : texels)
        for (glm::length_t c = 0; c < 3; ++c) {
            float& value = texel[c];
            if (std::isnan(value)) {
                ++bad[0];
                value = 0.0f;
            } else if (value < 0.0f) {
                ++bad[1];
                value = 0.0f;
            } else if (std::isinf(value)) {
                ++bad[2];
                value = largest;
            }
        }
    return bad;
}

/**
 * Part of the mean radiance below which light is left to rays that arrive by chance, where they share the
 * work: the density of drawn directions follows what is above. The balance heuristic's variance falls where
 * one technique leaves alone what the other does well (Karlik, Sik, Vevoda, Skrivan, Krivanek, "MIS
 * compensation", 2019, whose optimum for a scattering that knows nothing of the image is a half; measured at
 * 0, 1/2, 3/4, 1, 3/2 and 2 times: FlightHelmet 1.74, 1.49, 1.45, 1.45, 1.46, 1.47e-4, Fox 1.32, 1.02, .97,
 * .97, 1.15, 1.36e-4 relMSE). Below 1, so that an even image keeps an even density.
 */
constexpr double kLeftToRays = 0.75;

double brightness(const glm::vec3& texel) {
    return (double(texel.x) + double(texel.y) + double(texel.z)) / 3.0;
}

/** Over solid angle. */
double meanBrightness(std::span<const glm::vec3> texels, std::uint32_t width, std::uint32_t height) {
    double sum = 0, weights = 0;
    for (std::uint32_t y = 0; y < height; ++y) {
        const double weight = std::sin(glm::pi<double>() * (y + 0.5) / height);
        for (std::uint32_t x = 0; x < width; ++x)
            sum += weight * brightness(texels[std::size_t(y) * width + x]);
        weights += weight * width;
    }
    return sum / weights;
}

/** sin^2 of half the angle from the nearer pole, of the cells' boundary at `angle` from the top. */
double poleDistance(double angle, bool top) {
    const double s = top ? std::sin(0.5 * angle) : std::cos(0.5 * angle);
    return s * s;
}

}  // namespace

void environment(const Scene& scene, const PackOptions& options, PackedScene& packed) {
    if (!scene.environment) return;
    packed.environment = scene.environment->radiance;
    if (scene.environment->image < 0 || packed.environment == glm::vec3(0.0f)) return;
    const TextureImage& image = scene.images[std::size_t(scene.environment->image)];
    const std::string place = fmt::format("image {}{}", scene.environment->image,
                                          image.name.empty() ? "" : " '" + image.name + "'");
    const std::uint32_t w = image.width, h = image.height;
    if (std::uint64_t(w) * h > kMostTexels)
        throw InputError(scene.name, place,
                         fmt::format("an environment of {} x {} texels is too large", w, h),
                         fmt::format("give at most {} texels", kMostTexels));
    std::vector<glm::vec3> texels = linearTexels(image);
    const auto [nan, negative, infinite] = clean(texels);
    std::vector<std::string> faults;
    if (nan > 0) faults.push_back(fmt::format("{} not a number", nan));
    if (negative > 0) faults.push_back(fmt::format("{} negative", negative));
    if (infinite > 0) faults.push_back(fmt::format("{} infinite", infinite));
    if (!faults.empty())
        packed.warnings.push_back(fmt::format(
            "{}: the environment has values that are no radiance ({}); they are taken as 0, infinite ones as "
            "its largest finite value",
            place, fmt::join(faults, ", ")));
    if (w != 2 * h)
        packed.warnings.push_back(
            fmt::format("{}: a latitude-longitude environment is twice as wide as high, this one is {} x {}",
                        place, w, h));
    for (glm::vec3& texel : texels) {
        texel *= packed.environment;
        if (glm::any(glm::greaterThan(texel, glm::vec3(0x1p100f))))
            throw InputError(scene.name, place, "the environment is brighter than 2^100 (1.27e30)",
                             "give the scene another unit of power");
    }

    // A cell lies between four texel centres; the first and last row of cells end at the poles. Within a cell
    // the density is bilinear in longitude and in the cosine of the polar angle, in which area is uniform.
    const double dim = options.raysFindEnvironment ? kLeftToRays * meanBrightness(texels, w, h) : 0.0;
    const auto sampled = [&](std::uint32_t x, std::uint32_t y) {
        return std::max(brightness(texels[std::size_t(y) * w + x]) - dim, 0.0);
    };
    const double pi = glm::pi<double>();
    std::vector<double> rowWeight(h + 1), cells(w);
    std::vector<glm::vec2> rowGeometry(h + 1);
    std::vector<std::array<std::uint32_t, 4>> columns;
    std::vector<glm::dvec2> turns(w);  // sine and cosine of the longitude of cells' middles
    for (std::uint32_t x = 0; x < w; ++x) {
        const double turn = 2.0 * pi * (0.5 - (x + 1.0) / w);
        turns[x] = {std::sin(turn), std::cos(turn)};
    }
    double total = 0;
    for (std::uint32_t row = 0; row <= h; ++row) {
        const double upper = row == 0 ? 0.0 : pi * (row - 0.5) / h;
        const double lower = row == h ? pi : pi * (row + 0.5) / h;
        const bool top = row <= h / 2;
        // Differences of sin^2 without cancelling.
        const double extent = std::sin(0.5 * (lower - upper)) * std::sin(0.5 * (lower + upper));
        rowGeometry[row] = glm::vec2(float(poleDistance(upper, top)), float(top ? extent : -extent));
        const double cellAngle = 2.0 * pi / w * 2.0 * extent;
        const std::uint32_t above = row == 0 ? 0 : row - 1, below = row == h ? h - 1 : row;
        for (std::uint32_t x = 0; x < w; ++x) {
            const std::uint32_t next = x + 1 == w ? 0 : x + 1;
            cells[x] = 0.25 * cellAngle *
                       (sampled(x, above) + sampled(next, above) + sampled(x, below) + sampled(next, below));
            rowWeight[row] += cells[x];
            const double angle = 0.5 * (upper + lower);
            const glm::dvec3 from(std::sin(angle) * turns[x].x, std::cos(angle),
                                  std::sin(angle) * turns[x].y);
            for (glm::length_t axis = 0; axis < 3; ++axis)
                packed.environmentIrradiance[std::size_t(axis) * 2 + (from[axis] < 0 ? 1 : 0)] +=
                    cells[x] * std::abs(from[axis]);
        }
        total += rowWeight[row];
        const InversionTree tree = inversionTree(wholeShares(cells));
        columns.insert(columns.end(), tree.nodes.begin(), tree.nodes.end());
    }
    packed.environmentPower = total;
    if (!(total > 0.0)) {
        packed.environment = glm::vec3(0.0f);
        return;
    }
    const InversionTree rows = inversionTree(wholeShares(rowWeight));
    packed.environmentSize = {w, h};
    if (options.diffuseEnvironment) packed.diffuseEnvironment = diffuseEnvironment(texels, w, h);
    packed.environmentLevels = {rows.levels, inversionLevels(w)};
    packed.environmentNodes = {std::uint32_t(rows.nodes.size()), std::uint32_t(columns.size() / (h + 1))};

    const glm::mat3 toMap(
        glm::mat3_cast(glm::inverse(glm::normalize(glm::dquat(scene.environment->rotation)))));
    packed.environmentRotated = toMap != glm::mat3(1.0f);
    std::vector<glm::vec4>& out = packed.environmentMap;
    out.reserve(kEnvironmentHeader + texels.size() + h + 1 + rows.nodes.size() + columns.size());
    out.emplace_back(0.0f, glm::intBitsToFloat(-1), 0.0f, 0.0f);  // until it is in the light table
    for (glm::length_t r = 0; r < 3; ++r) out.emplace_back(toMap[0][r], toMap[1][r], toMap[2][r], 0.0f);
    for (std::uint32_t y = 0; y < h; ++y)
        for (std::uint32_t x = 0; x < w; ++x)
            out.emplace_back(texels[std::size_t(y) * w + x], float(sampled(x, y) / total));
    for (const glm::vec2& row : rowGeometry) out.emplace_back(row, 0.0f, 0.0f);
    std::vector<std::array<std::uint32_t, 4>> nodes = rows.nodes;
    nodes.insert(nodes.end(), columns.begin(), columns.end());
    for (const std::array<std::uint32_t, 4>& node : nodes)
        out.emplace_back(glm::uintBitsToFloat(node[0]), glm::uintBitsToFloat(node[1]),
                         glm::uintBitsToFloat(node[2]), 0.0f);
}

}  // namespace helio::pack
