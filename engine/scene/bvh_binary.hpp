#pragma once
/** @file
 * Binary bounding volume hierarchy by the binned surface area heuristic (Wald, "On fast construction of
 * SAH-based bounding volume hierarchies", 2007), down to single triangles, and the cheapest way to cut every
 * subtree into up to eight boxes (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs
 * through compressed wide BVHs", 2017, section 3.1). The first step of engine/scene/bvh.hpp.
 */
#include "engine/scene/bvh.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace helio::bvh {

/** 16 bytes at once: x, y, z and what lies behind them. */
typedef float Vec4 __attribute__((vector_size(16)));

struct Box {
    Vec4 lower, upper;
    static Box empty() {
        constexpr float far = std::numeric_limits<float>::infinity();
        return {Vec4{far, far, far, far}, Vec4{-far, -far, -far, -far}};
    }
    void grow(const Box& other) {
        lower = lower < other.lower ? lower : other.lower;
        upper = upper > other.upper ? upper : other.upper;
    }
    /** Half the surface and `lengthWeight` times the sum of the edges, in double: the square of 1e30 is no
     * float. Edges tell apart boxes that have no surface. 0 for an empty box. */
    double size(double lengthWeight) const {
        const double x = double(upper[0]) - double(lower[0]), y = double(upper[1]) - double(lower[1]),
                     z = double(upper[2]) - double(lower[2]);
        return x >= 0 ? x * y + y * z + z * x + lengthWeight * (x + y + z) : 0.0;
    }
    glm::vec3 lowerCorner() const { return {lower[0], lower[1], lower[2]}; }
    glm::vec3 upperCorner() const { return {upper[0], upper[1], upper[2]}; }
};

/** A triangle's box; the fourth lane of `lower` holds the triangle's index. */
struct Reference {
    Box box;
    std::uint32_t triangle() const;
};

/** Its left child lies next to it, the right one behind all nodes that the left subtree may have. */
struct BinaryNode {
    glm::vec3 lower;
    std::uint32_t right;  ///< 0 for a single reference
    glm::vec3 upper;
    std::uint32_t count;  ///< references
};

/** How a subtree is cut into at most j boxes, j = 2 to 8: at [j] the number of boxes that the left child
 * gets, 0 where fewer boxes than j are as good. [1]: 1 where the subtree is a leaf, [0] unused. */
using Cuts = std::array<std::uint8_t, 9>;

struct SpatialSplit;

class BinaryTree {
public:
    /** positions: corners in threes, at least one triangle. */
    BinaryTree(std::span<const glm::vec3> positions, const BvhOptions& options);

    const BinaryNode& node(std::uint32_t index) const { return nodes_[index]; }
    std::uint32_t left(std::uint32_t index) const { return index + 1; }
    bool isLeaf(std::uint32_t index) const { return cuts_[index][1] != 0; }
    const Cuts& cuts(std::uint32_t index) const { return cuts_[index]; }
    /** Triangles in the tree's order; a leaf's are consecutive. */
    std::uint32_t triangle(std::uint32_t place) const { return references_[place].triangle(); }
    /** Place of the right child's first triangle, given the node's. */
    std::uint32_t rightFirst(std::uint32_t index, std::uint32_t first) const {
        return first + (nodes_[index].right - index) / 2;
    }

private:
    /** References with room behind them for those that spatial splits add. */
    struct Range {
        std::uint32_t first, count;
        Box box, centroids;
        std::uint32_t room = 0;
    };
    struct Split {
        Range left, right;
    };
    /** Cost of a subtree as at most j boxes, at [j]. */
    using Costs = std::array<double, 8>;

    Costs build(std::uint32_t index, const Range& range, int depth);
    Split partition(const Range& range, int depth);
    Split partitionSpace(const Range& range, const SpatialSplit& at);
    void shareRoom(const Range& range, Split& split);
    Split partitionFew(const Range& range);
    Split halves(const Range& range) const;
    Range measured(std::uint32_t first, std::uint32_t count) const;

    BvhOptions options_;
    std::span<const glm::vec3> positions_;
    double leastOverlap_ = 0;  ///< of two children's boxes, in surface, from which on planes are tried
    double lengthWeight_ =
        0;  ///< a millionth of the root's edges: decides only where surfaces are as good as 0
    std::vector<Reference> references_;
    std::unique_ptr<BinaryNode[]> nodes_;
    std::unique_ptr<Cuts[]> cuts_;
};

}  // namespace helio::bvh
