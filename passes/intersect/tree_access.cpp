#include "passes/intersect/tree_access.hpp"

#include "engine/gpu/kept_data.hpp"
#include "passes/intersect/ray_intersector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

namespace helio {
namespace {

/** Part of a time by which another way must be faster to be taken. */
constexpr double kWorthChanging = 0.05;

constexpr std::string_view kKeptAs = "tree-access";

/** Hills under single stalks, in a square of side 2. */
Scene hills() {
    constexpr std::uint32_t side = 256;
    Primitive primitive;
    for (std::uint32_t z = 0; z <= side; ++z)
        for (std::uint32_t x = 0; x <= side; ++x) {
            const float u = 2.0f * float(x) / side - 1.0f, v = 2.0f * float(z) / side - 1.0f;
            const float high =
                0.1f * std::sin(9.0f * u) * std::cos(7.0f * v) + 0.02f * std::sin(90.0f * u + 50.0f * v);
            primitive.positions.emplace_back(u, (x * 7 + z * 13) % 61 == 0 ? high + 0.2f : high, v);
        }
    for (std::uint32_t z = 0; z < side; ++z)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = z * (side + 1) + x, b = a + side + 1;
            primitive.indices.insert(primitive.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    Scene scene;
    scene.meshes.push_back({"hills", {std::move(primitive)}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.roots.push_back(0);
    return scene;
}

/** Neighbouring rays from an eye, then rays in all directions from above the hills. */
std::vector<Ray> raysOver(std::uint32_t each) {
    std::vector<Ray> rays;
    const glm::vec3 eye(0.0f, 1.2f, 2.2f);
    const std::uint32_t width = std::uint32_t(std::sqrt(double(each)));
    for (std::uint32_t y = 0; y < width; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            rays.push_back({.origin = eye,
                            .direction = glm::vec3(2.4f * float(x) / float(width) - 1.2f, -1.2f,
                                                   -0.6f - 2.6f * float(y) / float(width))});
    std::mt19937 random(3);
    std::uniform_real_distribution<float> both(-1.0f, 1.0f);
    while (rays.size() < 2 * std::size_t(width) * width) {
        const glm::vec3 origin(both(random), 0.35f, both(random));
        rays.push_back(
            {.origin = origin, .direction = glm::vec3(both(random), 0.3f * both(random), both(random))});
    }
    return rays;
}

}  // namespace

std::string describe(const TreeAccess& access) {
    return fmt::format("{}, {} stack", access.nodesInStorage ? "storage buffer" : "texel buffer",
                       access.addressedStack ? "addressed" : "moved");
}

std::map<std::string, std::string> accessDefines(const TreeAccess& access, const Device& device,
                                                 const PackedScene& packed) {
    const std::uint64_t bytes = std::uint64_t(packed.nodeCount) * sizeof(BvhNode);
    if (!access.nodesInStorage || bytes > device.info().maxStorageBufferRange) return {};
    return {{"NODES_IN_STORAGE", "1"}};
}

SpecConstants accessConstants(const TreeAccess& access) {
    if (!access.addressedStack) return {};
    return {{"MOVED_STACK_AT_MOST", std::int32_t(0)}};
}

TreeAccess keptTreeAccess(const Device& device, const std::filesystem::path& folder) {
    const auto data = gpu::keptData(device, kKeptAs, folder);
    if (!data || data->size() != 2) return {};
    return {(*data)[0] == std::byte{1}, (*data)[1] == std::byte{1}};
}

bool keepTreeAccess(const Device& device, const TreeAccess& access, const std::filesystem::path& folder) {
    const std::array<std::byte, 2> data = {std::byte{access.nodesInStorage},
                                           std::byte{access.addressedStack}};
    return gpu::keepData(device, kKeptAs, data, folder);
}

std::vector<MeasuredAccess> measureTreeAccess(Device& device, int runs) {
    const PackedScene packed = packScene(hills());
    const std::vector<Ray> rays = raysOver(1u << 16);
    std::vector<MeasuredAccess> result;
    std::vector<std::vector<std::unique_ptr<RayIntersector>>> intersectors;
    for (const bool storage : {false, true})
        for (const bool addressed : {false, true}) {
            result.push_back({{storage, addressed}});
            auto& both = intersectors.emplace_back();
            for (const RayQuestion question : {RayQuestion::Closest, RayQuestion::Any}) {
                both.push_back(std::make_unique<RayIntersector>(device, packed, question, rays.size(),
                                                                result.back().access));
                both.back()->upload(rays);
                both.back()->run();  // compiles
            }
        }
    std::vector<std::vector<double>> seconds(result.size());
    for (int run = 0; run < runs; ++run)
        for (std::size_t i = 0; i < result.size(); ++i) {
            const auto start = std::chrono::steady_clock::now();
            for (const auto& intersector : intersectors[i]) intersector->run();
            seconds[i].push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
    for (std::size_t i = 0; i < result.size(); ++i) {
        std::ranges::sort(seconds[i]);
        result[i].seconds = seconds[i].empty() ? 0.0 : seconds[i][seconds[i].size() / 2];
    }
    return result;
}

TreeAccess fastestAccess(const std::vector<MeasuredAccess>& measured) {
    const auto best = std::ranges::min_element(measured, {}, &MeasuredAccess::seconds);
    const bool isWorth = best->seconds < (1.0 - kWorthChanging) * measured.front().seconds;
    return isWorth ? best->access : measured.front().access;
}

}  // namespace helio
