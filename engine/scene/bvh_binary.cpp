#include "engine/scene/bvh_binary.hpp"

#include "engine/scene/bvh_splits.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace helio::bvh {
namespace {

typedef std::int32_t Int4 __attribute__((vector_size(16)));

/** Keeps a triangle's index, as a float's bits, a normal number: arithmetic goes over all four lanes, and is
 * slow with subnormals. */
constexpr std::uint32_t kIndexBias = 0x10000000;
/** From this many triangles on, the two halves of a node are tasks. */
constexpr std::uint32_t kTaskTriangles = 4096;
/** From this many on, a node's own triangles are binned in parallel. */
constexpr std::uint32_t kParallelBinning = 1u << 16;
/** Up to this many triangles every split between two neighbours along an axis is tried. */
constexpr std::uint32_t kFew = 8;
/** From this level on triangles are split into halves by count, which bounds the depth whatever the input. */
constexpr int kMaxSahDepth = 44;

Vec4 same(float x) {
    return Vec4{x, x, x, x};
}
/** Not (lower + upper) / 2: that overflows near the largest float. */
Vec4 centreOf(const Box& box) {
    return box.lower * 0.5f + box.upper * 0.5f;
}

/** Bins of the three axes. */
struct Bins {
    std::array<std::array<Box, BvhOptions::kMaxBins>, 3> box;
    std::array<std::array<std::uint32_t, BvhOptions::kMaxBins>, 3> count;

    explicit Bins(int bins) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t b = 0; b < std::size_t(bins); ++b) {
                box[axis][b] = Box::empty();
                count[axis][b] = 0;
            }
    }
    void merge(const Bins& other, int bins) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t b = 0; b < std::size_t(bins); ++b) {
                box[axis][b].grow(other.box[axis][b]);
                count[axis][b] += other.count[axis][b];
            }
    }
};

/** Maps centroids to bins: monotonic per axis. An axis whose centroids coincide (or lie within what no float
 * can divide by) has scale 0 and is not split. */
struct Binning {
    Vec4 lower, scale;
    int bins;

    Binning(const Box& centroids, int binCount) : lower(centroids.lower), scale(same(0)), bins(binCount) {
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = centroids.upper[axis] - centroids.lower[axis];
            const float perUnit = float(bins) / extent;
            if (extent > 0 && perUnit < std::numeric_limits<float>::max()) scale[axis] = perUnit;
        }
    }
    Int4 of(const Box& box) const {
        const Vec4 place = (centreOf(box) - lower) * scale;
        const Vec4 last = same(float(bins) - 1.0f);
        return __builtin_convertvector(place < last ? place : last, Int4);
    }
};

struct Candidate {
    int axis = -1;
    int bin = 0;  ///< first one on the right
    double cost = std::numeric_limits<double>::infinity();
};

/** The part of the root's surface from which on an overlap of two children makes planes be tried (Stich et
 * al. 2009). */
constexpr double kOverlap = 1e-5;

/** References from which on planes are tried: with fewer, half the time of the build bought nothing. */
constexpr std::uint32_t kPlanesFrom = 128;

/** Boxes of the two sides of an object split. */
std::array<Box, 2> sidesOf(const Bins& bins, int binCount, const Candidate& split) {
    std::array<Box, 2> sides = {Box::empty(), Box::empty()};
    for (int b = 0; b < binCount; ++b)
        sides[b < split.bin ? 0 : 1].grow(bins.box[std::size_t(split.axis)][std::size_t(b)]);
    return sides;
}

Candidate bestOf(const Bins& bins, const Binning& binning, double lengthWeight) {
    Candidate best;
    for (int axis = 0; axis < 3; ++axis) {
        if (binning.scale[axis] == 0.0f) continue;
        const auto& box = bins.box[std::size_t(axis)];
        const auto& count = bins.count[std::size_t(axis)];
        std::array<double, BvhOptions::kMaxBins> rightCost;
        Box sum = Box::empty();
        std::uint32_t n = 0;
        for (int b = binning.bins - 1; b > 0; --b) {
            sum.grow(box[std::size_t(b)]);
            n += count[std::size_t(b)];
            rightCost[std::size_t(b)] = n > 0 ? sum.size(lengthWeight) * n : -1.0;
        }
        sum = Box::empty();
        n = 0;
        for (int b = 1; b < binning.bins; ++b) {
            sum.grow(box[std::size_t(b - 1)]);
            n += count[std::size_t(b - 1)];
            if (n == 0 || rightCost[std::size_t(b)] < 0) continue;
            const double cost = sum.size(lengthWeight) * n + rightCost[std::size_t(b)];
            if (cost < best.cost) best = {axis, b, cost};
        }
    }
    return best;
}

}  // namespace

std::uint32_t Reference::triangle() const {
    return std::bit_cast<std::uint32_t>(float(box.lower[3])) - kIndexBias;
}

BinaryTree::BinaryTree(std::span<const glm::vec3> positions, const BvhOptions& options)
    : options_(options), positions_(positions) {
    const std::uint32_t n = std::uint32_t(positions.size() / 3);
    const std::uint32_t room = std::uint32_t(options.spatialSplits * n);
    references_.resize(n + room);
    nodes_ = std::make_unique_for_overwrite<BinaryNode[]>(references_.size() * 2);
    cuts_ = std::make_unique_for_overwrite<Cuts[]>(references_.size() * 2);
    using Extents = std::array<Box, 2>;  // of the boxes and of their centres
    const auto fill = [&](const tbb::blocked_range<std::uint32_t>& range, Extents sum) {
        for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
            const glm::vec3* p = &positions[std::size_t(i) * 3];
            const glm::vec3 low = glm::min(glm::min(p[0], p[1]), p[2]),
                            high = glm::max(glm::max(p[0], p[1]), p[2]);
            references_[i].box = {Vec4{low.x, low.y, low.z, std::bit_cast<float>(i + kIndexBias)},
                                  Vec4{high.x, high.y, high.z, 0}};
            const Vec4 centre = centreOf(references_[i].box);
            sum[0].grow(references_[i].box);
            sum[1].grow({centre, centre});
        }
        return sum;
    };
    const tbb::blocked_range<std::uint32_t> all(0, n, kTaskTriangles);
    const Extents none = {Box::empty(), Box::empty()};
    const Extents extents = options_.parallel ? tbb::parallel_reduce(all, none, fill,
                                                                     [](Extents a, const Extents& b) {
                                                                         a[0].grow(b[0]);
                                                                         a[1].grow(b[1]);
                                                                         return a;
                                                                     })
                                              : fill(all, none);
    Range range{0, n, extents[0], extents[1]};
    range.room = room;
    leastOverlap_ = kOverlap * range.box.size(0);
    const Vec4 extent = range.box.upper * 0.5f - range.box.lower * 0.5f;
    lengthWeight_ = 2e-6 * (double(extent[0]) + double(extent[1]) + double(extent[2]));
    build(0, range, 0);
}

BinaryTree::Range BinaryTree::measured(std::uint32_t first, std::uint32_t count) const {
    Range range{first, count, Box::empty(), Box::empty()};
    for (std::uint32_t i = first; i < first + count; ++i) {
        range.box.grow(references_[i].box);
        const Vec4 centre = centreOf(references_[i].box);
        range.centroids.grow({centre, centre});
    }
    return range;
}

BinaryTree::Split BinaryTree::halves(const Range& range) const {
    const std::uint32_t half = range.count / 2;
    return {measured(range.first, half), measured(range.first + half, range.count - half)};
}

/** All splits between neighbours along an axis; the cheapest is made. */
BinaryTree::Split BinaryTree::partitionFew(const Range& range) {
    const std::uint32_t n = range.count;
    const auto part = [&](std::uint32_t first,
                          std::uint32_t count) {  // as few again, whose centres nothing asks for
        Range half{first, count, Box::empty(), Box::empty()};
        for (std::uint32_t i = first; i < first + count; ++i) half.box.grow(references_[i].box);
        return half;
    };
    if (n == 2) return {part(range.first, 1), part(range.first + 1, 1)};
    std::array<Reference, kFew> references;
    std::array<Vec4, kFew> centres;
    std::copy_n(&references_[range.first], n, references.begin());
    for (std::uint32_t i = 0; i < n; ++i) centres[i] = centreOf(references[i].box);
    std::array<std::uint8_t, kFew> order, best;
    for (std::uint32_t i = 0; i < n; ++i) order[i] = std::uint8_t(i);
    std::uint32_t bestLeft = 0;
    double bestCost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        for (std::uint32_t i = 1; i < n; ++i)  // by insertion
            for (std::uint32_t k = i; k > 0 && centres[order[k]][axis] < centres[order[k - 1]][axis]; --k)
                std::swap(order[k], order[k - 1]);
        std::array<double, kFew> rightCost;
        Box sum = Box::empty();
        for (std::uint32_t i = n - 1; i > 0; --i) {
            sum.grow(references[order[i]].box);
            rightCost[i] = sum.size(lengthWeight_) * (n - i);
        }
        sum = Box::empty();
        for (std::uint32_t i = 1; i < n; ++i) {
            sum.grow(references[order[i - 1]].box);
            const double cost = sum.size(lengthWeight_) * i + rightCost[i];
            if (cost >= bestCost) continue;
            bestCost = cost;
            bestLeft = i;
            best = order;
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) references_[range.first + i] = references[best[i]];
    return {part(range.first, bestLeft), part(range.first + bestLeft, n - bestLeft)};
}

BinaryTree::Split BinaryTree::partition(const Range& range, int depth) {
    if (range.count <= kFew) return partitionFew(range);
    if (depth >= kMaxSahDepth) return halves(range);
    const int binCount = std::min(options_.bins, 8 + int(std::min(range.count / 8, 1000u)));
    const Binning binning(range.centroids, binCount);
    const auto fill = [&](const tbb::blocked_range<std::uint32_t>& part, Bins& sum) {
        for (std::uint32_t i = part.begin(); i < part.end(); ++i) {
            const Box box = references_[i].box;
            const Int4 bin = binning.of(box);
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t b = std::size_t(bin[axis]);
                sum.box[std::size_t(axis)][b].grow(box);
                ++sum.count[std::size_t(axis)][b];
            }
        }
    };
    Bins bins(binCount);
    const tbb::blocked_range<std::uint32_t> all(range.first, range.first + range.count, kTaskTriangles);
    if (options_.parallel && range.count >= kParallelBinning)
        // Minima, maxima and counts are exact in any order, so that the parallel sum equals the serial one.
        bins = tbb::parallel_reduce(
            all, bins,
            [&](const tbb::blocked_range<std::uint32_t>& part, Bins sum) {
                fill(part, sum);
                return sum;
            },
            [&](Bins a, const Bins& b) {
                a.merge(b, binCount);
                return a;
            });
    else
        fill(all, bins);
    const Candidate best = bestOf(bins, binning, lengthWeight_);
    if (best.axis < 0) return halves(range);
    const std::array<Box, 2> sides = sidesOf(bins, binCount, best);
    if (range.room > 0 && range.count >= kPlanesFrom) {
        const Box both = {sides[0].lower > sides[1].lower ? sides[0].lower : sides[1].lower,
                          sides[0].upper < sides[1].upper ? sides[0].upper : sides[1].upper};
        if (!isEmpty(both) && both.size(0) > leastOverlap_) {
            const SpatialSplit at = bestSpatialSplit(std::span(references_).subspan(range.first, range.count),
                                                     positions_, range.box, lengthWeight_, options_.parallel);
            if (at.cost < best.cost && at.left < range.count && at.right < range.count &&
                at.left + at.right <= range.count + range.room)
                return partitionSpace(range, at);
        }
    }

    Split split{{range.first, 0, Box::empty(), Box::empty()}, {0, 0, Box::empty(), Box::empty()}};
    const auto put = [&](Range& side, const Reference& reference) {
        const Vec4 centre = centreOf(reference.box);
        side.centroids.grow({centre, centre});
    };
    std::uint32_t i = range.first, end = range.first + range.count;
    while (i < end) {
        if (binning.of(references_[i].box)[best.axis] < best.bin) {
            put(split.left, references_[i++]);
            continue;
        }
        while (--end > i && binning.of(references_[end].box)[best.axis] >= best.bin)
            put(split.right, references_[end]);
        put(split.right, references_[i]);
        if (end > i) {
            put(split.left, references_[end]);
            std::swap(references_[i++], references_[end]);
        }
    }
    split.left.box = sides[0];
    split.right.box = sides[1];
    split.left.count = i - range.first;
    split.right.first = i;
    split.right.count = range.count - split.left.count;
    shareRoom(range, split);
    return split;
}

/** Parts a range's room among the halves by their references, and moves the right half behind the left one's.
 */
void BinaryTree::shareRoom(const Range& range, Split& split) {
    const std::uint32_t total = split.left.count + split.right.count,
                        room = range.room - (total - range.count);
    if (room == 0) return;
    split.left.room = std::uint32_t(std::uint64_t(room) * split.left.count / total);
    split.right.room = room - split.left.room;
    const auto from = references_.begin() + split.right.first;
    split.right.first += split.left.room;
    std::copy_backward(from, from + split.right.count,
                       references_.begin() + split.right.first + split.right.count);
}

/** Cuts references by a plane; one whose both parts would cost more than the whole on one side is left whole
 * ("reference unsplitting"). */
BinaryTree::Split BinaryTree::partitionSpace(const Range& range, const SpatialSplit& at) {
    Split split{{range.first, 0, Box::empty(), Box::empty()}, {0, 0, Box::empty(), Box::empty()}};
    std::vector<Reference> right;
    right.reserve(at.right);
    const auto put = [&](Range& side, const Reference& reference) {
        const Vec4 centre = centreOf(reference.box);
        side.centroids.grow({centre, centre});
        side.box.grow(reference.box);
        ++side.count;
    };
    const auto toLeft = [&](const Reference& reference) {
        put(split.left, reference);
        references_[range.first + split.left.count - 1] = reference;  // at most as far as is read
    };
    const auto toRight = [&](const Reference& reference) {
        put(split.right, reference);
        right.push_back(reference);
    };
    Box leftBox = at.leftBox, rightBox = at.rightBox;
    double left = at.left, rights = at.right;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        const Reference reference = references_[i];
        if (reference.box.upper[at.axis] <= at.plane) {
            toLeft(reference);
            continue;
        }
        if (reference.box.lower[at.axis] >= at.plane) {
            toRight(reference);
            continue;
        }
        const Parts parts = cut(reference, positions_, at.axis, at.plane);
        const auto sizeWith = [&](Box box) {
            box.grow(reference.box);
            return box.size(lengthWeight_);
        };
        const double leftSize = leftBox.size(lengthWeight_), rightSize = rightBox.size(lengthWeight_);
        const double both = leftSize * left + rightSize * rights;
        const double asLeft = sizeWith(leftBox) * left + rightSize * (rights - 1);
        const double asRight = leftSize * (left - 1) + sizeWith(rightBox) * rights;
        const bool noLeft = isEmpty(parts.below.box), noRight = isEmpty(parts.above.box);
        if (noRight || (!noLeft && asLeft <= both && asLeft <= asRight)) {
            toLeft(reference);
            leftBox.grow(reference.box);
            rights -= 1;
        } else if (noLeft || asRight <= both) {
            toRight(reference);
            rightBox.grow(reference.box);
            left -= 1;
        } else {
            toLeft(parts.below);
            toRight(parts.above);
        }
    }
    if (split.left.count == 0 || split.right.count == 0) {  // all left whole on one side
        if (split.left.count == 0) std::ranges::copy(right, references_.begin() + range.first);
        return halves(range);
    }
    split.right.first = range.first + split.left.count;
    std::ranges::copy(right, references_.begin() + split.right.first);
    shareRoom(range, split);
    return split;
}

BinaryTree::Costs BinaryTree::build(std::uint32_t index, const Range& range, int depth) {
    BinaryNode& node = nodes_[index];
    node = {range.box.lowerCorner(), 0, range.box.upperCorner(), range.count};
    Cuts& cuts = cuts_[index];
    cuts = {};
    const double area = range.box.size(lengthWeight_);
    Costs costs;
    if (range.count == 1) {
        cuts[1] = 1;
        costs.fill(area * options_.triangleCost);
        return costs;
    }
    const Split split = partition(range, depth);
    node.right = index + 2 * (split.right.first - range.first);
    Costs left, right;
    if (options_.parallel && range.count >= kTaskTriangles)
        tbb::parallel_invoke([&] { left = build(index + 1, split.left, depth + 1); },
                             [&] { right = build(node.right, split.right, depth + 1); });
    else {
        left = build(index + 1, split.left, depth + 1);
        right = build(node.right, split.right, depth + 1);
    }
    node.count = nodes_[index + 1].count + nodes_[node.right].count;
    std::array<double, 9> shared;  // cost as exactly two or more boxes, at most j
    // More boxes than references serve nothing, nor does a half's share beyond its own.
    const std::size_t leftMost = nodes_[index + 1].count, rightMost = nodes_[node.right].count;
    const std::size_t most = std::min<std::size_t>(8, leftMost + rightMost);
    for (std::size_t j = 2; j <= most; ++j) {
        shared[j] = std::numeric_limits<double>::infinity();
        const std::size_t last = std::min(leftMost, j - 1);
        for (std::size_t k = j > rightMost ? j - rightMost : 1; k <= last; ++k) {
            const double cost = left[k] + right[j - k];
            if (cost < shared[j]) {
                shared[j] = cost;
                cuts[j] = std::uint8_t(k);
            }
        }
    }
    for (std::size_t j = most + 1; j <= 8; ++j) shared[j] = shared[most];
    cuts[8] = cuts[most];
    const double asNode = shared[8] + area;
    const double asLeaf = node.count <= std::uint32_t(Bvh::kMaxLeafTriangles)
                              ? area * node.count * options_.triangleCost
                              : std::numeric_limits<double>::infinity();
    cuts[1] = asLeaf <= asNode ? 1 : 0;
    costs[0] = 0;
    costs[1] = std::min(asLeaf, asNode);
    for (std::size_t j = 2; j < 8; ++j) {
        costs[j] = std::min(costs[j - 1], shared[j]);
        if (costs[j - 1] <= shared[j]) cuts[j] = 0;
    }
    return costs;
}

}  // namespace helio::bvh
