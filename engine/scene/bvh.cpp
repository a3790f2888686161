#include "engine/scene/bvh.hpp"

#include "engine/scene/bvh_binary.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio {
namespace {

struct Bounds {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void grow(const Bounds& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    double halfArea() const {
        const glm::dvec3 e = glm::dvec3(upper) - glm::dvec3(lower);
        return e.x >= 0 ? e.x * e.y + e.y * e.z + e.z * e.x : 0.0;
    }
};

/** A wide node before it is written: its children in no order yet. */
struct WideNode {
    std::uint32_t binary = 0;         ///< node of the binary tree
    std::uint32_t first = 0;          ///< place of its first triangle in the binary tree's order
    std::uint32_t place = 0;          ///< in Bvh::nodes
    std::uint32_t firstChild = 0;     ///< block of its inner children
    std::uint32_t firstTriangle = 0;  ///< in Bvh::order
    std::uint32_t innerIndex = 0;  ///< among the wide nodes, of its first inner child; more follow in order
    std::uint32_t children = 0;
    std::uint32_t innerChildren = 0;
    std::uint32_t leafTriangles = 0;            ///< of the other children
    std::array<std::uint32_t, 8> child{};       ///< nodes of the binary tree
    std::array<std::uint32_t, 8> childFirst{};  ///< their first triangles
};

Bounds boundsOf(const bvh::BinaryNode& node) {
    return {node.lower, node.upper};
}

/** Appends the subtree's boxes, at most `slots` of them. */
void gather(const bvh::BinaryTree& tree, std::uint32_t index, std::uint32_t first, std::size_t slots,
            WideNode& wide) {
    while (slots > 1 && tree.cuts(index)[slots] == 0) --slots;
    if (slots == 1) {
        wide.child[wide.children] = index;
        wide.childFirst[wide.children++] = first;
        return;
    }
    const std::size_t forLeft = tree.cuts(index)[slots];
    const std::uint32_t left = tree.left(index), right = tree.node(index).right;
    gather(tree, left, first, forLeft, wide);
    gather(tree, right, tree.rightFirst(index, first), slots - forLeft, wide);
}

/** Gives every child the free slot whose octant it lies towards most, best pair first. */
std::array<std::uint8_t, 8> slotsOf(const Bounds& parent, std::span<const Bounds> children) {
    std::array<std::array<float, 8>, 8> towards;
    std::array<std::uint8_t, 8> slots{};
    // Halved first: sums near the largest float stay finite.
    const glm::vec3 middle = 0.5f * parent.lower + 0.5f * parent.upper;
    for (std::size_t k = 0; k < children.size(); ++k) {
        const glm::vec3 d = 0.25f * (0.5f * children[k].lower + 0.5f * children[k].upper - middle);
        const std::array<float, 4> xy = {-d.x - d.y, d.x - d.y, -d.x + d.y, d.x + d.y};
        for (std::size_t s = 0; s < 4; ++s) {
            towards[k][s] = xy[s] - d.z;
            towards[k][s + 4] = xy[s] + d.z;
        }
        slots[k] = std::uint8_t((d.x > 0 ? 1 : 0) | (d.y > 0 ? 2 : 0) | (d.z > 0 ? 4 : 0));
    }
    // `slots` are the best free ones; looked for again only where another child has taken one.
    std::uint32_t freeSlots = 0xff;
    const auto findBest = [&](std::size_t k) {
        float best = -std::numeric_limits<float>::infinity();
        for (std::uint32_t f = freeSlots; f != 0; f &= f - 1) {
            const std::size_t s = std::size_t(std::countr_zero(f));
            if (towards[k][s] <= best) continue;
            best = towards[k][s];
            slots[k] = std::uint8_t(s);
        }
    };
    for (std::uint32_t open = (1u << children.size()) - 1u; open != 0;) {
        std::size_t best = std::size_t(std::countr_zero(open));
        for (std::uint32_t c = open & (open - 1); c != 0; c &= c - 1) {
            const std::size_t k = std::size_t(std::countr_zero(c));
            if (towards[k][slots[k]] > towards[best][slots[best]]) best = k;
        }
        open &= ~(1u << best);
        freeSlots &= ~(1u << slots[best]);
        for (std::uint32_t c = open; c != 0; c &= c - 1) {
            const std::size_t k = std::size_t(std::countr_zero(c));
            if (slots[k] == slots[best]) findBest(k);
        }
    }
    return slots;
}

/** Of a biased exponent, 1 to 254. */
double powerOfTwo(std::uint8_t exponent) {
    return double(std::bit_cast<float>(std::uint32_t(exponent) << 23));
}

/** Least biased exponent with which 255 steps from `lower` reach `upper`. */
std::uint8_t exponentFor(float lower, float upper) {
    const double extent = double(upper) - double(lower);
    int exponent = -126;
    if (extent > 0) {
        std::frexp(extent / 255.0, &exponent);  // extent / 255 lies in [2^(e - 1), 2^e)
        exponent = std::clamp(exponent - 1, -126, 127);
    }
    std::uint8_t biased = std::uint8_t(exponent + 127);
    while (biased < 254 && double(lower) + 255.0 * powerOfTwo(biased) < double(upper)) ++biased;
    return biased;
}

void setFrame(const Bounds& bounds, BvhNode& node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.origin[axis] = bounds.lower[int(axis)];
        node.exponent[axis] = exponentFor(bounds.lower[int(axis)], bounds.upper[int(axis)]);
    }
}

/** Quantises a child's box so that the decoded box holds it: checked in double, not hoped for. */
void quantise(const Bounds& child, std::size_t slot, BvhNode& node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double origin = double(node.origin[axis]);
        const double step = powerOfTwo(node.exponent[axis]), perUnit = 1.0 / step;
        const double lower = double(child.lower[int(axis)]), upper = double(child.upper[int(axis)]);
        // By conversion, not std::floor(): a call each where the processor is not known to have more than
        // SSE2.
        double low = double(int(std::clamp((lower - origin) * perUnit, 0.0, 255.0)));
        const double above = std::clamp((upper - origin) * perUnit, 0.0, 255.0);
        double high = double(int(above));
        if (high < above) high += 1.0;
        while (low > 0.0 && origin + low * step > lower) low -= 1.0;
        while (high < 255.0 && origin + high * step < upper) high += 1.0;
        assert(origin + low * step <= lower && origin + high * step >= upper);
        node.planes[axis][slot] = std::uint8_t(low);
        node.planes[axis][slot + 8] = std::uint8_t(high);
    }
}

/** Children of all wide nodes, level by level, with the places of blocks and triangles. */
class Collapse {
public:
    Collapse(const bvh::BinaryTree& tree, const BvhOptions& options) : tree_(tree), options_(options) {
        wide_.push_back({.binary = 0, .first = 0, .place = 0});
        std::uint32_t places = 1, triangles = 0;
        for (std::size_t begin = 0; begin < wide_.size();) {
            const std::size_t end = wide_.size();
            forRange(begin, end, [&](std::size_t w) {
                WideNode& wide = wide_[w];
                gather(tree_, wide.binary, wide.first, tree_.isLeaf(wide.binary) ? 1 : 8, wide);
                for (std::uint32_t k = 0; k < wide.children; ++k) {
                    if (tree_.isLeaf(wide.child[k]))
                        wide.leafTriangles += tree_.node(wide.child[k]).count;
                    else
                        ++wide.innerChildren;
                }
            });
            std::uint32_t next = std::uint32_t(end);
            for (std::size_t w = begin; w < end; ++w) {
                WideNode& wide = wide_[w];
                wide.firstTriangle = triangles;
                wide.innerIndex = next;
                wide.firstChild = places;
                triangles += wide.leafTriangles;
                next += wide.innerChildren;
                if (wide.innerChildren > 0) places += 8;
            }
            wide_.resize(next);
            forRange(begin, end, [&](std::size_t w) {
                const WideNode& wide = wide_[w];
                std::uint32_t inner = wide.innerIndex;
                for (std::uint32_t k = 0; k < wide.children; ++k) {
                    if (tree_.isLeaf(wide.child[k])) continue;
                    wide_[inner].binary = wide.child[k];
                    wide_[inner++].first = wide.childFirst[k];
                }
            });
            levels_.push_back(end);
            begin = end;
            ++depth_;
        }
        places_ = places;
    }

    Bvh write() {
        Bvh result;
        result.nodes.resize(places_);
        result.order.resize(tree_.node(0).count);
        result.depth = depth_;
        result.usedNodes = std::uint32_t(wide_.size());
        std::vector<double> costs(wide_.size());
        for (std::size_t level = 0; level + 1 < levels_.size(); ++level)  // parents place their children
            forRange(levels_[level], levels_[level + 1], [&](std::size_t w) {
                const WideNode& wide = wide_[w];
                std::array<Bounds, 8> boxes;
                for (std::uint32_t k = 0; k < wide.children; ++k)
                    boxes[k] = boundsOf(tree_.node(wide.child[k]));
                const auto slots =
                    slotsOf(boundsOf(tree_.node(wide.binary)), std::span(boxes).first(wide.children));
                std::uint32_t inner = wide.innerIndex;
                for (std::uint32_t k = 0; k < wide.children; ++k)
                    if (!tree_.isLeaf(wide.child[k])) wide_[inner++].place = wide.firstChild + slots[k];
                costs[w] = writeNode(wide, slots, result);
            });
        const double rootArea = boundsOf(tree_.node(0)).halfArea();
        // In order: the same sum however many threads there are.
        if (rootArea > 0) result.cost = std::accumulate(costs.begin(), costs.end(), 0.0) / rootArea;
        return result;
    }

private:
    /** Returns the node's share of the tree's cost, in surface. */
    double writeNode(const WideNode& wide, const std::array<std::uint8_t, 8>& slots, Bvh& result) const {
        BvhNode node{};
        const Bounds bounds = boundsOf(tree_.node(wide.binary));
        double cost = bounds.halfArea();
        setFrame(bounds, node);
        node.firstChild = wide.firstChild;
        node.firstTriangle = wide.firstTriangle;
        for (auto& planes : node.planes) std::fill_n(planes.begin(), 8, std::uint8_t(255));
        std::array<int, 8> childAt;
        childAt.fill(-1);
        for (std::uint32_t k = 0; k < wide.children; ++k) childAt[slots[k]] = int(k);
        std::uint32_t triangle = wide.firstTriangle;
        for (std::size_t s = 0; s < 8; ++s) {
            if (childAt[s] < 0) continue;
            const std::size_t k = std::size_t(childAt[s]);
            const bvh::BinaryNode& child = tree_.node(wide.child[k]);
            quantise(boundsOf(child), s, node);
            if (!tree_.isLeaf(wide.child[k])) {
                node.slots |= 1u << s;
                continue;
            }
            node.slots |= ((1u << child.count) - 1u) << (8 + 3 * s);
            cost += boundsOf(child).halfArea() * child.count * options_.triangleCost;
            for (std::uint32_t i = 0; i < child.count; ++i)
                result.order[triangle++] = tree_.triangle(wide.childFirst[k] + i);
        }
        result.nodes[wide.place] = node;
        return cost;
    }

    void forRange(std::size_t begin, std::size_t end, const auto& body) const {
        if (!options_.parallel) {
            for (std::size_t i = begin; i < end; ++i) body(i);
            return;
        }
        tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 256), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
        });
    }

    const bvh::BinaryTree& tree_;
    BvhOptions options_;
    std::vector<WideNode> wide_;
    std::vector<std::size_t> levels_{0};  ///< where each begins in `wide_`, and the end
    std::uint32_t places_ = 0, depth_ = 0;
};

/** Box of a node whose descendants have theirs; sets the node's frame and its children's planes. */
Bounds refitNode(Bvh& tree, std::uint32_t index, std::span<const glm::vec3> positions,
                 const BvhOptions& options, double& area) {
    BvhNode& node = tree.nodes[index];
    std::array<Bounds, 8> children;
    Bounds all;
    for (int s = 0; s < 8; ++s) {
        Bounds& child = children[std::size_t(s)];
        const std::uint32_t count = node.triangleCount(s);
        if (node.isInner(s)) {
            child = refitNode(tree, node.firstChild + std::uint32_t(s), positions, options, area);
        } else if (count > 0) {
            for (std::uint32_t k = 0; k < count; ++k)
                for (std::size_t c = 0; c < 3; ++c) {
                    const glm::vec3& p =
                        positions[std::size_t(tree.order[node.triangleBegin(s) + k]) * 3 + c];
                    child.grow({p, p});
                }
            area += child.halfArea() * count * options.triangleCost;
        }
        all.grow(child);
    }
    setFrame(all, node);
    for (int s = 0; s < 8; ++s)
        if (node.isInner(s) || node.triangleCount(s) > 0)
            quantise(children[std::size_t(s)], std::size_t(s), node);
    area += all.halfArea();
    return all;
}

}  // namespace

BvhBox childBox(const BvhNode& node, int slot) {
    BvhBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t a = std::size_t(axis), s = std::size_t(slot);
        const double step = powerOfTwo(node.exponent[a]);
        box.lower[axis] = double(node.origin[a]) + double(node.planes[a][s]) * step;
        box.upper[axis] = double(node.origin[a]) + double(node.planes[a][s + 8]) * step;
    }
    return box;
}

Bvh buildBvh(std::span<const glm::vec3> positions, const BvhOptions& options) {
    assert(positions.size() % 3 == 0);
    assert(options.bins >= 8 && options.bins <= BvhOptions::kMaxBins);
    if (positions.empty()) return {};
    const bvh::BinaryTree tree(positions, options);
    return Collapse(tree, options).write();
}

void refitBvh(Bvh& tree, std::span<const glm::vec3> positions, const BvhOptions& options) {
    assert(positions.size() == tree.order.size() * 3);
    if (tree.nodes.empty()) return;
    double area = 0;
    const double rootArea = refitNode(tree, 0, positions, options, area).halfArea();
    tree.cost = rootArea > 0 ? area / rootArea : 0;
}

}  // namespace helio
