#pragma once
/** @file
 * Other accelerators than the tree of bvh.hpp, to compare with: uniform grid (Amanatides and Woo, "A fast
 * voxel traversal algorithm for ray tracing", 1987), octree, kd-tree by the surface area heuristic (MacDonald
 * and Booth, 1990), and a binary space partition by the triangles' own planes (Fuchs, Kedem and Naylor,
 * 1980). All divide space: a triangle is referred to by every cell that it may touch, and the cells fill the
 * root's box. The hits are those of the tree: same triangle test, same rule for ties.
 *
 * A cell refers to triangles up to `margin` outside of it, since a ray's place is only known to its rounding:
 * rays may start up to 16 times the scene's size away.
 */
#include <heliograph/accelerator.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace helio {

/** "auto", "bvh", "brute-force", "grid", "octree", "kd-tree", "bsp". */
std::string_view acceleratorName(AcceleratorKind kind);

/** For the device, as words of shaders/intersection/comparators.glsl. */
struct Comparator {
    std::vector<glm::uvec4> words;
    std::uint32_t depth = 0;       ///< levels below the root
    std::uint64_t references = 0;  ///< to triangles, of all cells
};

/** Any kind from BruteForce on. positions: corners in threes, finite, of at least one triangle. Throws
 * InputError for brute force over more triangles than a ray may test (kMaxBruteForce). */
Comparator buildComparator(AcceleratorKind kind, std::span<const glm::vec3> positions);
inline constexpr std::uint32_t kMaxBruteForce = 15000;

// The structures themselves, for the builder and its tests.
namespace partition {

struct Bounds {
    glm::vec3 lower, upper;
};

/** What all structures know of the triangles. */
struct Input {
    explicit Input(std::span<const glm::vec3> positions);
    std::span<const glm::vec3> positions;
    std::vector<Bounds> boxes;  ///< of the triangles, widened by the margin
    Bounds root;                ///< of all, widened by twice the margin
    float margin = 0;
};

struct Grid {
    glm::ivec3 cells;
    glm::vec3 cellSize;
    std::vector<std::uint32_t> first;  ///< of every cell (x fastest) in `references`, and their number
    std::vector<std::uint32_t> references;
};
Grid buildGrid(const Input& input);

/** Node of an octree, or of a tree of planes. */
struct Node {
    glm::vec3 split{0.0f};         ///< octree: the middle; planes: the normal
    float distance = 0;            ///< planes: points p with dot(split, p) < distance are the first child's
    std::uint32_t firstChild = 0;  ///< of 8 or 2 in a row; 0 for a leaf
    std::vector<std::uint32_t> references;
};
struct Tree {
    std::vector<Node> nodes;
    std::uint32_t depth = 0;
};
Tree buildOctree(const Input& input);
Tree buildKdTree(const Input& input);
Tree buildBsp(const Input& input);

}  // namespace partition
}  // namespace helio
