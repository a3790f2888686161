#include "engine/scene/bvh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio {
namespace {

constexpr int kMaxBins = 64;
/** Below this many triangles a subtree is one task. */
constexpr std::uint32_t kTaskTriangles = 4096;
/** From this level on triangles are split into halves by count, which bounds the depth whatever the input. */
constexpr int kMaxSahDepth = 48;

struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void grow(const glm::vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    void grow(const Box& b) {
        lower = glm::min(lower, b.lower);
        upper = glm::max(upper, b.upper);
    }
    /** Half the surface, in double: the square of 1e30 is no float. 0 for an empty box. */
    double halfArea() const {
        if (!(lower.x <= upper.x)) return 0.0;
        const glm::dvec3 e = glm::dvec3(upper) - glm::dvec3(lower);
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    glm::vec3 centre() const { return 0.5f * lower + 0.5f * upper; }
};

/** Node of the binary tree. Its subtree lies behind it in the array: the left child next to it, the right one
 * after all nodes the left subtree could have, so that subtrees are built independently. */
struct BinaryNode {
    Box box;
    std::uint32_t first = 0, count = 0;
    std::uint32_t left = 0, right = 0;  ///< 0 for a leaf
    bool isLeaf() const { return left == 0; }
};

struct Bins {
    std::array<std::array<Box, kMaxBins>, 3> box;
    std::array<std::array<std::uint32_t, kMaxBins>, 3> count{};
    void merge(const Bins& other, int bins) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t b = 0; b < std::size_t(bins); ++b) {
                box[axis][b].grow(other.box[axis][b]);
                count[axis][b] += other.count[axis][b];
            }
    }
};

class Builder {
public:
    Builder(std::span<const glm::vec3> positions, const BvhOptions& options) : options_(options) {
        const std::uint32_t n = std::uint32_t(positions.size() / 3);
        boxes_.resize(n);
        order_.resize(n);
        nodes_.resize(std::size_t(n) * 2);
        std::iota(order_.begin(), order_.end(), 0u);
        forRange(0, n, [&](std::uint32_t i) {
            for (std::size_t k = 0; k < 3; ++k) boxes_[i].grow(positions[std::size_t(i) * 3 + k]);
        });
        BinaryNode& root = nodes_[0];
        root.first = 0;
        root.count = n;
        for (const Box& box : boxes_) root.box.grow(box);
        split(0, 0);
    }

    const std::vector<BinaryNode>& nodes() const { return nodes_; }
    const std::vector<std::uint32_t>& order() const { return order_; }

private:
    template <typename Body>
    void forRange(std::uint32_t begin, std::uint32_t end, const Body& body) {
        if (!options_.parallel || end - begin < kTaskTriangles) {
            for (std::uint32_t i = begin; i < end; ++i) body(i);
            return;
        }
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(begin, end, kTaskTriangles),
                          [&](const auto& range) {
                              for (std::uint32_t i = range.begin(); i < range.end(); ++i) body(i);
                          });
    }

    /** Bin of a centroid: monotonic in the coordinate, in [0, bins). Doubles, since the ratio of two extents
     * need not be a float. */
    int binOf(float coordinate, double lower, double scale) const {
        const int bin = int((double(coordinate) - lower) * scale);
        return std::clamp(bin, 0, options_.bins - 1);
    }

    void fillBins(const Box& centroids, const glm::dvec3& scale, std::uint32_t begin, std::uint32_t end,
                  Bins& bins) const {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Box& box = boxes_[order_[i]];
            const glm::vec3 centre = box.centre();
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t b =
                    std::size_t(binOf(centre[axis], double(centroids.lower[axis]), scale[axis]));
                bins.box[std::size_t(axis)][b].grow(box);
                ++bins.count[std::size_t(axis)][b];
            }
        }
    }

    /** Minima, maxima and counts: exact in any order, so the parallel sum equals the serial one. */
    Bins binned(const Box& centroids, const glm::dvec3& scale, std::uint32_t begin, std::uint32_t end) const {
        Bins bins;
        if (!options_.parallel || end - begin < 8 * kTaskTriangles) {
            fillBins(centroids, scale, begin, end, bins);
            return bins;
        }
        return tbb::parallel_reduce(
            tbb::blocked_range<std::uint32_t>(begin, end, kTaskTriangles), bins,
            [&](const tbb::blocked_range<std::uint32_t>& range, Bins sum) {
                fillBins(centroids, scale, range.begin(), range.end(), sum);
                return sum;
            },
            [&](Bins a, const Bins& b) {
                a.merge(b, options_.bins);
                return a;
            });
    }

    /** Splits a node's triangles in place; returns the size of the left part, or 0 for a leaf. */
    std::uint32_t partition(const BinaryNode& node, int depth) {
        const auto begin = order_.begin() + node.first, end = begin + node.count;
        if (node.count == 1) return 0;
        Box centroids;
        for (auto i = begin; i != end; ++i) centroids.grow(boxes_[*i].centre());
        const glm::dvec3 extent = glm::dvec3(centroids.upper) - glm::dvec3(centroids.lower);

        int bestAxis = -1, bestBin = 0;
        double bestCost = std::numeric_limits<double>::infinity();
        glm::dvec3 scale(0.0);
        if (depth < kMaxSahDepth && (extent.x > 0 || extent.y > 0 || extent.z > 0)) {
            for (int axis = 0; axis < 3; ++axis)
                scale[axis] = extent[axis] > 0 ? double(options_.bins) / extent[axis] : 0.0;
            const Bins bins = binned(centroids, scale, node.first, node.first + node.count);
            for (int axis = 0; axis < 3; ++axis) {
                if (!(extent[axis] > 0)) continue;
                sweep(bins.box[std::size_t(axis)], bins.count[std::size_t(axis)], axis, bestAxis, bestBin,
                      bestCost);
            }
        }
        if (node.count <= Bvh::kMaxLeafTriangles) {
            // Coincident triangles gain nothing from being split.
            const double area = node.box.halfArea();
            if (bestAxis < 0 || bestCost + options_.traversalCost * area >= double(node.count) * area)
                return 0;
        }
        if (bestAxis >= 0) {
            const double lower = double(centroids.lower[bestAxis]), s = scale[bestAxis];
            const auto middle = std::partition(begin, end, [&](std::uint32_t triangle) {
                return binOf(boxes_[triangle].centre()[bestAxis], lower, s) < bestBin;
            });
            if (middle != begin && middle != end) return std::uint32_t(middle - begin);
        }
        return node.count / 2;
    }

    void sweep(const std::array<Box, kMaxBins>& box, const std::array<std::uint32_t, kMaxBins>& count,
               int axis, int& bestAxis, int& bestBin, double& bestCost) const {
        std::array<double, kMaxBins> rightCost{};
        Box sum;
        std::uint32_t n = 0;
        for (int b = options_.bins - 1; b > 0; --b) {
            sum.grow(box[std::size_t(b)]);
            n += count[std::size_t(b)];
            rightCost[std::size_t(b)] = n > 0 ? sum.halfArea() * double(n) : -1.0;
        }
        sum = {};
        n = 0;
        for (int b = 1; b < options_.bins; ++b) {
            sum.grow(box[std::size_t(b - 1)]);
            n += count[std::size_t(b - 1)];
            if (n == 0 || rightCost[std::size_t(b)] < 0.0) continue;
            const double cost = sum.halfArea() * double(n) + rightCost[std::size_t(b)];
            if (cost < bestCost) {
                bestCost = cost;
                bestAxis = axis;
                bestBin = b;
            }
        }
    }

    void split(std::uint32_t index, int depth) {
        BinaryNode& node = nodes_[index];
        const std::uint32_t leftCount = partition(node, depth);
        if (leftCount == 0) return;
        node.left = index + 1;
        node.right = index + 2 * leftCount;
        BinaryNode& left = nodes_[node.left];
        BinaryNode& right = nodes_[node.right];
        left.first = node.first;
        left.count = leftCount;
        right.first = node.first + leftCount;
        right.count = node.count - leftCount;
        for (std::uint32_t i = 0; i < left.count; ++i) left.box.grow(boxes_[order_[left.first + i]]);
        for (std::uint32_t i = 0; i < right.count; ++i) right.box.grow(boxes_[order_[right.first + i]]);
        if (options_.parallel && node.count >= kTaskTriangles) {
            tbb::parallel_invoke([&] { split(node.left, depth + 1); }, [&] { split(node.right, depth + 1); });
        } else {
            split(node.left, depth + 1);
            split(node.right, depth + 1);
        }
    }

    BvhOptions options_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<BinaryNode> nodes_;
};

/** Up to eight descendants of a binary node that become children of one wide node: the largest box that is
 * not a leaf is opened until eight are there. */
std::vector<std::uint32_t> childrenOf(const std::vector<BinaryNode>& nodes, std::uint32_t index) {
    if (nodes[index].isLeaf()) return {index};
    std::vector<std::uint32_t> children = {nodes[index].left, nodes[index].right};
    while (children.size() < 8) {
        int largest = -1;
        double area = -1.0;
        for (std::size_t k = 0; k < children.size(); ++k) {
            const BinaryNode& child = nodes[children[k]];
            if (!child.isLeaf() && child.box.halfArea() > area) {
                area = child.box.halfArea();
                largest = int(k);
            }
        }
        if (largest < 0) break;
        const BinaryNode& opened = nodes[children[std::size_t(largest)]];
        children[std::size_t(largest)] = opened.left;
        children.push_back(opened.right);
    }
    return children;
}

/** Gives every child the free slot whose octant it lies towards most, best pair first; -1 for a free slot. */
std::array<int, 8> assignSlots(const std::vector<BinaryNode>& nodes, const Box& parent,
                               const std::vector<std::uint32_t>& children) {
    std::array<int, 8> slots;
    slots.fill(-1);
    std::vector<bool> placed(children.size(), false);
    const glm::dvec3 middle(parent.centre());
    for (std::size_t round = 0; round < children.size(); ++round) {
        double best = -std::numeric_limits<double>::infinity();
        int bestSlot = -1, bestChild = -1;
        for (int s = 0; s < 8; ++s) {
            if (slots[std::size_t(s)] >= 0) continue;
            for (std::size_t k = 0; k < children.size(); ++k) {
                if (placed[k]) continue;
                const glm::dvec3 d = glm::dvec3(nodes[children[k]].box.centre()) - middle;
                const double towards =
                    ((s & 1) != 0 ? d.x : -d.x) + ((s & 2) != 0 ? d.y : -d.y) + ((s & 4) != 0 ? d.z : -d.z);
                if (towards > best) {
                    best = towards;
                    bestSlot = s;
                    bestChild = int(k);
                }
            }
        }
        slots[std::size_t(bestSlot)] = bestChild;
        placed[std::size_t(bestChild)] = true;
    }
    return slots;
}

/** Least biased exponent with which 255 steps from `lower` reach `upper`. */
std::uint8_t exponentFor(float lower, float upper) {
    const double extent = double(upper) - double(lower);
    int exponent = extent > 0 ? int(std::ceil(std::log2(extent / 255.0))) : -126;
    exponent = std::clamp(exponent - 1, -126, 127);
    while (exponent < 127 && double(lower) + 255.0 * std::ldexp(1.0, exponent) < double(upper)) ++exponent;
    return std::uint8_t(exponent + 127);
}

/** Quantises a child's box so that the decoded box holds it: checked in double, not hoped for. */
void quantise(const Box& child, int slot, BvhNode& node) {
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = double(node.origin[std::size_t(axis)]);
        const double step = std::ldexp(1.0, int(node.exponent[std::size_t(axis)]) - 127);
        const double lower = double(child.lower[axis]), upper = double(child.upper[axis]);
        double low = std::clamp(std::floor((lower - origin) / step), 0.0, 255.0);
        double high = std::clamp(std::ceil((upper - origin) / step), 0.0, 255.0);
        while (low > 0.0 && origin + low * step > lower) low -= 1.0;
        while (high < 255.0 && origin + high * step < upper) high += 1.0;
        assert(origin + low * step <= lower && origin + high * step >= upper);
        node.planes[std::size_t(axis)][std::size_t(slot)] = std::uint8_t(low);
        node.planes[std::size_t(axis)][std::size_t(slot) + 8] = std::uint8_t(high);
    }
}

struct Pending {
    std::uint32_t binary, wide, level;
};

}  // namespace

BvhBox childBox(const BvhNode& node, int slot) {
    BvhBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t a = std::size_t(axis), s = std::size_t(slot);
        const double step = std::ldexp(1.0, int(node.exponent[a]) - 127);
        box.lower[axis] = double(node.origin[a]) + double(node.planes[a][s]) * step;
        box.upper[axis] = double(node.origin[a]) + double(node.planes[a][s + 8]) * step;
    }
    return box;
}

Bvh buildBvh(std::span<const glm::vec3> positions, const BvhOptions& options) {
    assert(positions.size() % 3 == 0);
    assert(options.bins >= 2 && options.bins <= kMaxBins);
    Bvh result;
    if (positions.empty()) return result;
    const Builder builder(positions, options);
    const std::vector<BinaryNode>& binary = builder.nodes();
    const double rootArea = binary[0].box.halfArea();

    result.order.reserve(positions.size() / 3);
    result.nodes.emplace_back();
    std::vector<Pending> queue = {{0, 0, 1}};
    for (std::size_t next = 0; next < queue.size(); ++next) {
        const Pending item = queue[next];
        const Box& box = binary[item.binary].box;
        const std::vector<std::uint32_t> children = childrenOf(binary, item.binary);
        const std::array<int, 8> slots = assignSlots(binary, box, children);
        ++result.usedNodes;
        result.depth = std::max(result.depth, item.level);

        BvhNode node{};
        for (int axis = 0; axis < 3; ++axis) {
            node.origin[std::size_t(axis)] = box.lower[axis];
            node.exponent[std::size_t(axis)] = exponentFor(box.lower[axis], box.upper[axis]);
        }
        const bool anyInner =
            std::ranges::any_of(children, [&](std::uint32_t child) { return !binary[child].isLeaf(); });
        if (anyInner) {
            node.firstChild = std::uint32_t(result.nodes.size());
            result.nodes.resize(result.nodes.size() + 8);
        }
        node.firstTriangle = std::uint32_t(result.order.size());
        for (auto& planes : node.planes) std::fill_n(planes.begin(), 8, std::uint8_t(255));
        for (int s = 0; s < 8; ++s) {
            if (slots[std::size_t(s)] < 0) continue;
            const std::uint32_t index = children[std::size_t(slots[std::size_t(s)])];
            const BinaryNode& child = binary[index];
            quantise(child.box, s, node);
            if (child.isLeaf()) {
                node.slots |= ((1u << child.count) - 1u) << (8 + 3 * s);
                for (std::uint32_t i = 0; i < child.count; ++i)
                    result.order.push_back(builder.order()[child.first + i]);
                if (rootArea > 0) result.cost += child.box.halfArea() / rootArea * double(child.count);
            } else {
                node.slots |= 1u << s;
                queue.push_back({index, node.firstChild + std::uint32_t(s), item.level + 1});
            }
        }
        if (rootArea > 0) result.cost += box.halfArea() / rootArea * options.traversalCost;
        result.nodes[item.wide] = node;
    }
    return result;
}

}  // namespace helio
