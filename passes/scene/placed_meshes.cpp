#include "passes/scene/placed_meshes.hpp"

#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

namespace helio::pack {
namespace {

/** What a flattened triangle and a placement take on the device and the host, roughly: bytes. */
constexpr double kBytesOfTriangle = 120, kBytesOfPlacement = 400;
/** What placing must save: below, rays are worth more, which take up to twice as long through two trees. */
constexpr double kWorthwhile = 1024.0 * (1 << 20);
/** Of a placement: |M| |M^-1|, by largest sums of rows. */
constexpr double kMostSkew = 1e4;
/** Of a placement from the origin, in sizes of the mesh: beyond, the rounding of corners in the world is more
 * than a few hundredths of it. */
constexpr double kFarthest = 5e4;
/** Slots are positive integers of 32 bits; those of the scene's own triangles have 24. */
constexpr std::uint64_t kSlotsAtMost = (1ull << 31) - (1ull << 25);

bool isPlaceable(const Scene& scene, const Mesh& mesh) {
    return std::ranges::all_of(mesh.primitives, [&](const Primitive& p) {
        if (p.shape) return false;
        if (p.material < 0 || p.material >= int(scene.materials.size())) return p.material < 0;
        const Material& look = scene.materials[std::size_t(p.material)];
        return look.emission == glm::vec3(0.0f) && !needsTangents(look);
    });
}

std::uint64_t triangleCount(const Mesh& mesh) {
    std::uint64_t sum = 0;
    for (const Primitive& p : mesh.primitives) sum += p.indices.size() / 3;
    return sum;
}

double extentOf(const Mesh& mesh) {
    glm::vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
    for (const Primitive& p : mesh.primitives)
        for (const glm::vec3& at : p.positions) {
            lower = glm::min(lower, at);
            upper = glm::max(upper, at);
        }
    const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
    return std::max({size.x, size.y, size.z, 0.0});
}

double largestRow(const glm::dmat3& m) {
    const glm::dmat3 rows = glm::transpose(m);
    double most = 0;
    for (int i = 0; i < 3; ++i)
        most = std::max(most, std::abs(rows[i].x) + std::abs(rows[i].y) + std::abs(rows[i].z));
    return most;
}

bool isPlaceable(const glm::dmat4& transform, const glm::dvec3& origin, double extent) {
    const glm::dmat3 linear(transform), inverse = glm::inverse(linear);
    const double size = largestRow(linear), skew = size * largestRow(inverse);
    const glm::dvec3 away = glm::abs(glm::dvec3(transform[3]) - origin);
    // Comparisons that fail for NaN.
    return skew <= kMostSkew && size >= 1e-10 && size <= 1e10 &&
           std::max({away.x, away.y, away.z}) <= kFarthest * size * extent &&
           largestRow(glm::dmat3(transform[3], {}, {})) <= 1e15;
}

struct BytesHash {
    std::size_t operator()(const std::pair<int, glm::dmat4>& key) const {
        std::uint64_t h = std::uint64_t(key.first);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                h = (h ^ std::bit_cast<std::uint64_t>(key.second[c][r] + 0.0)) * 0x9e3779b97f4a7c15u,
                h ^= h >> 32;
        return std::size_t(h);
    }
};

glm::vec3 placedCorner(const glm::dmat4& m, const glm::vec3& corner) {
    return glm::vec3(m * glm::dvec4(corner, 1.0));
}

struct Box {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
    void grow(const glm::dvec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
};

/** Of a placed tree: the boxes of the root's children in the world, with all roundings. */
Box worldBox(const Bvh& tree, const glm::dmat4& m) {
    Box box;
    const BvhNode& root = tree.nodes[0];
    double largest = 0;
    for (int s = 0; s < 8; ++s) {
        if (!root.isInner(s) && root.triangleCount(s) == 0) continue;
        const BvhBox child = childBox(root, s);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) != 0 ? child.upper.x : child.lower.x,
                               (corner & 2) != 0 ? child.upper.y : child.lower.y,
                               (corner & 4) != 0 ? child.upper.z : child.lower.z);
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max(largest, std::abs(m[0][axis] * p.x) + std::abs(m[1][axis] * p.y) +
                                                std::abs(m[2][axis] * p.z) + std::abs(m[3][axis]));
            box.grow(glm::dvec3(m * glm::dvec4(p, 1.0)));
        }
    }
    // Sums of doubles err by some 2^-52 of their terms; rounding to float keeps the order.
    const double slack = 8.0 * std::numeric_limits<double>::epsilon() * largest;
    box.lower -= slack;
    box.upper += slack;
    return box;
}

float lowerFloat(double x) {
    const float f = float(x);
    return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

glm::uvec2 words(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return {std::uint32_t(bits), std::uint32_t(bits >> 32)};
}

}  // namespace

PlacedMeshes choosePlaced(const Scene& scene, const PackOptions& options) {
    PlacedMeshes placed;
    if (options.placing == Placing::Flatten) return placed;
    const std::vector<Instance> instances = scene.instances();
    struct Use {
        bool isPlaceable = false;
        std::uint64_t triangles = 0, uses = 0;
        double extent = 0;  ///< largest side of the box, in the mesh's space
    };
    std::vector<Use> meshes(scene.meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i)
        meshes[i] = {isPlaceable(scene, scene.meshes[i]), triangleCount(scene.meshes[i]), 0,
                     extentOf(scene.meshes[i])};
    const auto count = [&](const Instance& instance) -> Use& { return meshes[std::size_t(instance.mesh)]; };
    std::uint64_t candidates = 0;
    for (const Instance& instance : instances)
        candidates += count(instance).isPlaceable ? ++count(instance).uses : 0;
    const auto saves = [&](const Use& use) {
        return use.isPlaceable && use.uses > 1 && use.triangles > 0
                   ? double(use.uses - 1) * double(use.triangles) * kBytesOfTriangle -
                         double(use.uses) * kBytesOfPlacement
                   : 0.0;
    };
    double saved = 0;
    for (Use& use : meshes) {
        if (options.placing == Placing::WhereItSaves)
            use.isPlaceable = saves(use) > 0;
        else
            use.isPlaceable = use.isPlaceable && use.uses > 1 && use.triangles > 0;
        saved += std::max(saves(use), 0.0);
    }
    if (options.placing == Placing::WhereItSaves && saved < kWorthwhile) return placed;

    // Placements of one mesh in one place stay with the flattened ones, where the first hides the others.
    std::unordered_map<std::pair<int, glm::dmat4>, std::uint32_t, BytesHash> places;
    for (const Instance& instance : instances)
        if (count(instance).isPlaceable) ++places[{instance.mesh, instance.transform}];
    std::vector<std::array<std::int32_t, 2>> indexOf(scene.meshes.size(), {-1, -1});
    for (bool fits = false; !fits;) {
        placed = {};
        std::ranges::fill(indexOf, std::array<std::int32_t, 2>{-1, -1});
        std::uint64_t largest = 0;
        for (std::size_t i = 0; i < instances.size(); ++i) {
            const Instance& instance = instances[i];
            if (!count(instance).isPlaceable ||
                !isPlaceable(instance.transform, options.origin, count(instance).extent) ||
                places.at({instance.mesh, instance.transform}) > 1)
                continue;
            const bool mirrored = glm::determinant(glm::dmat3(instance.transform)) < 0.0;
            std::int32_t& index = indexOf[std::size_t(instance.mesh)][mirrored ? 1 : 0];
            if (index < 0) {
                index = std::int32_t(placed.meshes.size());
                placed.meshes.push_back(
                    {std::uint32_t(instance.mesh), mirrored, std::uint32_t(count(instance).triangles), 0});
                largest = std::max(largest, count(instance).triangles);
            }
            glm::dmat4 toWorld = instance.transform;
            toWorld[3] -= glm::dvec4(options.origin, 0.0);
            placed.placements.push_back({std::uint32_t(i), std::uint32_t(index), toWorld});
        }
        placed.triangleBits = std::uint32_t(std::bit_width(std::max<std::uint64_t>(largest, 1) - 1));
        fits = (std::uint64_t(placed.placements.size()) << placed.triangleBits) <= kSlotsAtMost;
        // Rather few large meshes flattened than many small ones.
        if (!fits)
            for (Use& use : meshes) use.isPlaceable = use.isPlaceable && use.triangles < largest;
    }
    return placed;
}

std::vector<glm::vec3> placedSamples(const PlacedMeshes& placed, std::span<const glm::vec3> positions) {
    constexpr std::size_t most = std::size_t(1) << 20, each = 8;
    std::vector<glm::vec3> corners;
    const std::size_t count = placed.placements.size();
    const std::size_t samples = count == 0 ? 0 : std::clamp<std::size_t>(most / count, 1, each);
    for (const MeshPlacement& p : placed.placements) {
        const PlacedMesh& mesh = placed.meshes[p.mesh];
        const std::size_t taken = std::min<std::size_t>(samples, mesh.triangles);
        for (std::size_t i = 0; i < taken; ++i) {
            const std::size_t g = mesh.firstG + i * mesh.triangles / taken;
            for (std::size_t k = 0; k < 3; ++k)
                corners.push_back(placedCorner(p.toWorld, positions[g * 3 + k]));
        }
    }
    return corners;
}

PlacedTrees::PlacedTrees(const PlacedMeshes& placed, std::span<const glm::vec3> positions)
    : placed_(placed), trees_(placed.meshes.size()) {
    tbb::parallel_for(std::size_t(0), trees_.size(), [&](std::size_t i) {
        const PlacedMesh& mesh = placed.meshes[i];
        trees_[i] =
            buildBvh(positions.subspan(std::size_t(mesh.firstG) * 3, std::size_t(mesh.triangles) * 3));
    });
}

std::vector<glm::vec3> PlacedTrees::boxes() const {
    std::vector<glm::vec3> corners(placed_.placements.size() * 3);
    tbb::parallel_for(std::size_t(0), placed_.placements.size(), [&](std::size_t i) {
        const MeshPlacement& p = placed_.placements[i];
        const Box box = worldBox(trees_[p.mesh], p.toWorld);
        for (int axis = 0; axis < 3; ++axis) {
            // The third corner would add nothing to the box of the other two.
            corners[i * 3][axis] = corners[i * 3 + 2][axis] = lowerFloat(box.lower[axis]);
            corners[i * 3 + 1][axis] = -lowerFloat(-box.upper[axis]);
        }
    });
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (!std::isfinite(corners[i].x) || !std::isfinite(corners[i].y) || !std::isfinite(corners[i].z))
            throw InputError("", fmt::format("instance {}", placed_.placements[i / 3].instance),
                             "its mesh is not finite in world space",
                             "correct the positions or the node's transform");
    return corners;
}

void PlacedTrees::append(std::span<const glm::vec3> positions, std::span<const Surface> surfaces,
                         PackedScene& packed) const {
    struct Place {
        std::uint32_t root, firstTriangle;
        double reach;
    };
    std::vector<Place> places;
    std::uint32_t depth = 0, triangles = 0;
    for (std::size_t i = 0; i < trees_.size(); ++i) {
        const Bvh& tree = trees_[i];
        const PlacedMesh& mesh = placed_.meshes[i];
        const std::uint32_t root = std::uint32_t(packed.nodes.size() / 5);
        const std::uint32_t first = packed.triangleCount + triangles;
        places.push_back({root, triangles, 0.0});
        for (BvhNode node : tree.nodes) {
            node.firstChild += root;
            node.firstTriangle += first;
            std::array<glm::uvec4, 5> texels;
            std::memcpy(texels.data(), &node, sizeof node);
            packed.nodes.insert(packed.nodes.end(), texels.begin(), texels.end());
        }
        for (const std::uint32_t t : tree.order) {
            const std::size_t g = mesh.firstG + t;
            const auto texel = [&](std::size_t corner, std::uint32_t bits) {
                packed.triangles.emplace_back(positions[g * 3 + corner], glm::uintBitsToFloat(bits));
            };
            texel(0, std::uint32_t(g));
            texel(1, 0);
            texel(2, surfaces[g].material);
        }
        triangles += mesh.triangles;
        depth = std::max(depth, tree.depth);
    }
    packed.nodeCount = std::uint32_t(packed.nodes.size() / 5);
    if (packed.nodeCount >= (1u << 24))
        throw InputError("", "", "its trees have more than 2^24 nodes", "reduce the meshes");
    packed.treeDepth += 1 + depth;  // an empty entry of the stack lies between the two
    packed.placedBits = placed_.triangleBits;
    packed.placed.reserve(placed_.placements.size() * kPlacedTexels);
    for (std::size_t i = 0; i < placed_.placements.size(); ++i) {
        const MeshPlacement& p = placed_.placements[i];
        const Bvh& tree = trees_[p.mesh];
        const glm::dmat4& m = p.toWorld;
        std::array<glm::uvec2, 12> column;
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t r = 0; r < 3; ++r) column[c * 3 + r] = words(m[int(c)][int(r)]);
        for (std::size_t k = 0; k < 12; k += 2) packed.placed.emplace_back(column[k], column[k + 1]);
        const Box box = worldBox(tree, m);
        const glm::dvec3 origin(m[3]);
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis)
            reach = std::max({reach, std::abs(origin[axis]), std::abs(box.lower[axis] - origin[axis]),
                              std::abs(box.upper[axis] - origin[axis]), std::abs(box.lower[axis]),
                              std::abs(box.upper[axis])});
        int exponent = 0;
        std::frexp(reach, &exponent);  // reach <= 2^exponent
        const std::uint32_t biased = std::uint32_t(std::clamp(exponent + 127, 1, 254));
        const glm::dmat3 rows = glm::transpose(glm::inverse(glm::dmat3(m)));
        const Place& place = places[p.mesh];
        // Unsigned: both sums wrap around alike.
        const std::uint32_t offset = (std::uint32_t(i) << placed_.triangleBits) - place.firstTriangle;
        const std::array<std::uint32_t, 3> last = {place.root | biased << 24, offset, p.instance};
        for (int r = 0; r < 3; ++r)
            packed.placed.emplace_back(glm::floatBitsToUint(glm::vec3(rows[r])), last[std::size_t(r)]);
    }
}

}  // namespace helio::pack
