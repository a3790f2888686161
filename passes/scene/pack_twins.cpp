#include "passes/scene/packed_scene.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace helio::pack {
namespace {

/** Corners with the smallest first, in their order around the triangle: twins that face alike are equal. */
using Corners = std::array<glm::vec3, 3>;

Corners canonical(const glm::vec3* corners) {
    Corners result = {corners[0], corners[1], corners[2]};
    const auto smallest =
        std::min_element(result.begin(), result.end(), [](const glm::vec3& a, const glm::vec3& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        });
    std::rotate(result.begin(), smallest, result.end());
    return result;
}

Corners turned(const Corners& corners) {
    return {corners[0], corners[2], corners[1]};
}

/** Of the corners in any order: MurmurHash3's finaliser over each, summed. */
std::uint64_t hash(const glm::vec3* corners) {
    std::uint64_t sum = 0;
    for (int k = 0; k < 3; ++k) {
        std::uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            h ^= std::bit_cast<std::uint32_t>(corners[k][axis] + 0.0f);  // -0 becomes 0
            h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
            h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
        }
        sum += h ^ (h >> 33);
    }
    return sum;
}

}  // namespace

std::size_t collapseTwins(const Scene& scene, std::span<const Surface> surfaces, bool fromBothSides,
                          std::span<glm::vec3> positions) {
    constexpr std::uint64_t kIndexBits = (1u << 24) - 1;  // geometry() refuses more triangles
    std::vector<std::uint64_t> keys(surfaces.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), 4096), [&](const auto& range) {
        for (std::size_t g = range.begin(); g < range.end(); ++g)
            keys[g] = (hash(&positions[g * 3]) & ~kIndexBits) | g;
    });
    tbb::parallel_sort(keys.begin(), keys.end());

    const auto isOpaque = [&](std::size_t g) {
        const std::uint32_t material = surfaces[g].material;
        return material >= scene.materials.size() || scene.materials[material].alphaMode == AlphaMode::Opaque;
    };
    const auto emits = [&](std::size_t g) {
        const std::uint32_t material = surfaces[g].material;
        return material < scene.materials.size() && scene.materials[material].emission != glm::vec3(0.0f);
    };
    struct Covering {
        Corners corners;
        bool fromBothSides;
    };
    std::size_t collapsed = 0;
    for (std::size_t first = 0; first < keys.size();) {
        std::size_t end = first + 1;
        while (end < keys.size() && (keys[end] ^ keys[first]) <= kIndexBits) ++end;
        std::vector<Covering> covering;  // of a run of equal hashes, in the order of g
        for (std::size_t i = first; end - first > 1 && i < end; ++i) {
            const std::size_t g = keys[i] & kIndexBits;
            if (surfaces[g].shape > 0) continue;  // its vectors are no corners
            const Corners corners = canonical(&positions[g * 3]), other = turned(corners);
            const bool isCovered = std::any_of(covering.begin(), covering.end(), [&](const Covering& c) {
                return c.corners == corners || (c.fromBothSides && !emits(g) && c.corners == other);
            });
            if (isCovered) {
                positions[g * 3 + 1] = positions[g * 3 + 2] = positions[g * 3];
                ++collapsed;
            } else if (isOpaque(g)) {
                covering.push_back({corners, fromBothSides && !emits(g)});
            }
        }
        first = end;
    }
    return collapsed;
}

}  // namespace helio::pack
