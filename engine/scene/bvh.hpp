#pragma once
/** @file
 * Bounding volume hierarchy over triangles: a binary tree (bvh_binary.hpp), collapsed to eight children a
 * node with boxes quantised to 8 bits (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs
 * through compressed wide BVHs", 2017). Scale-free: no absolute epsilon; coordinates from 1e-30 to 1e30 work.
 */
#include <glm/glm.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace helio {

/**
 * A node of eight children, 80 bytes: five 16-byte texels on the device.
 * A child's box spans origin + lower * 2^exponent .. origin + upper * 2^exponent per axis. Child slot s lies
 * towards octant s of the node (bit 0: +x, 1: +y, 2: +z), so that slot ^ octant of the ray's direction orders
 * children from near to far.
 */
struct BvhNode {
    std::array<float, 3> origin;           ///< lower corner of the node's box
    std::array<std::uint8_t, 3> exponent;  ///< biased by 127, per axis
    std::uint8_t unusedByte;
    std::uint32_t firstChild;     ///< of a block of eight nodes, some of them unused
    std::uint32_t firstTriangle;  ///< place in Bvh::order of this node's first leaf triangle
    /** Bit s: child s is a node, at firstChild + s. Bits 8 + 3 s on: child s is a leaf of as many triangles
     * as bits are set, from the lowest on; triangles lie in the order of their bits. */
    std::uint32_t slots;
    std::uint32_t unusedWord;
    /** Quantised planes per axis: 8 lower, then 8 upper. A slot without a child has lower 255, upper 0. */
    std::array<std::array<std::uint8_t, 16>, 3> planes;

    bool isInner(int slot) const { return (slots >> slot & 1u) != 0; }
    /** Triangles of a leaf; 0 for an inner child and for a slot without a child. */
    std::uint32_t triangleCount(int slot) const {
        return std::uint32_t(std::popcount(slots >> (8 + 3 * slot) & 7u));
    }
    /** Place in Bvh::order of a leaf's first triangle. */
    std::uint32_t triangleBegin(int slot) const {
        return firstTriangle + std::uint32_t(std::popcount((slots >> 8) & ((1u << 3 * slot) - 1u)));
    }
};
static_assert(sizeof(BvhNode) == 80);

struct BvhOptions {
    static constexpr int kMaxBins = 32;
    int bins = 24;              ///< of the binned split, 8 to kMaxBins; nodes of few triangles take fewer
    double triangleCost = 0.6;  ///< of a triangle test, in visits of a node
    bool parallel = true;       ///< the result does not depend on it
    /** Places in leaves that spatial splits may add (engine/scene/bvh_splits.hpp), in parts of the triangles;
     * 0: every triangle is in one leaf. Corners must be the triangles' own, not those of boxes. */
    double spatialSplits = 0;
};

struct Bvh {
    static constexpr int kMaxLeafTriangles = 3;
    std::vector<BvhNode> nodes;        ///< [0] is the root; empty without triangles
    std::vector<std::uint32_t> order;  ///< triangle at each place; a permutation without spatial splits
    std::uint32_t depth = 0;           ///< levels of nodes
    std::uint32_t usedNodes = 0;       ///< reachable ones
    /** Surface area heuristic: expected visits of nodes of a line that meets the root's box, each triangle
     * test counted as BvhOptions::triangleCost. */
    double cost = 0;
};

/** Builds the tree of positions.size() / 3 triangles (corners in threes, finite). Triangles without area are
 * kept; every triangle is in exactly one leaf, with spatial splits in one or more. Same input, same result.
 */
Bvh buildBvh(std::span<const glm::vec3> positions, const BvhOptions& options = {});

/** Boxes for moved corners: the tree keeps its shape, so that rays cost more the farther triangles have moved
 * from their neighbours. `positions`: as many as the tree was built of, without spatial splits. */
void refitBvh(Bvh& tree, std::span<const glm::vec3> positions, const BvhOptions& options = {});

/** A child's box, decoded exactly. */
struct BvhBox {
    glm::dvec3 lower, upper;
};
BvhBox childBox(const BvhNode& node, int slot);

}  // namespace helio
