#include "engine/scene/bvh_splits.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace helio::bvh {
namespace {

/** Planes tried per axis, and 1. */
constexpr int kSpaceBins = 16;
/** References of a task. */
constexpr std::size_t kSpaceGrain = 2048;

/** Floats below and above x, by a rounding or two. */
float roundedBelow(double x) {
    const float f = float(x);
    return f - (std::abs(f) * 1.2e-7f + std::numeric_limits<float>::min());
}
float roundedAbove(double x) {
    return -roundedBelow(-x);
}

/** Planes of an axis. */
struct Slices {
    float lower = 0, step = 0;  ///< step 0: the axis is not cut

    Slices(const Box& box, int axis) : lower(box.lower[axis]) {
        const float extent = box.upper[axis] - box.lower[axis];
        const float width = extent / float(kSpaceBins);
        // Planes must part: a slice is wider than the rounding of its place.
        const float size = std::max(std::abs(box.lower[axis]), std::abs(box.upper[axis]));
        if (std::isfinite(extent) && width > size * 1e-6f && width > 1e-37f) step = width;
    }
    float plane(int bin) const { return lower + float(bin) * step; }
    /** The slice that a reference's part lies in which starts or ends at x. */
    int startOf(float x) const {
        int bin = std::clamp(int((x - lower) / step), 0, kSpaceBins - 1);
        while (bin > 0 && x < plane(bin)) --bin;
        while (bin + 1 < kSpaceBins && x >= plane(bin + 1)) ++bin;
        return bin;
    }
    int endOf(float x) const {
        int bin = std::clamp(int((x - lower) / step), 0, kSpaceBins - 1);
        while (bin > 0 && x <= plane(bin)) --bin;
        while (bin + 1 < kSpaceBins && x > plane(bin + 1)) ++bin;
        return bin;
    }
};

struct SpaceBins {
    std::array<std::array<Box, kSpaceBins>, 3> box;
    std::array<std::array<std::uint32_t, kSpaceBins>, 3> starts{}, ends{};

    SpaceBins() {
        for (auto& axis : box) axis.fill(Box::empty());
    }
    void merge(const SpaceBins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t b = 0; b < std::size_t(kSpaceBins); ++b) {
                box[axis][b].grow(other.box[axis][b]);
                starts[axis][b] += other.starts[axis][b];
                ends[axis][b] += other.ends[axis][b];
            }
    }
    void add(const Reference& reference, std::span<const glm::vec3> positions,
             const std::array<Slices, 3>& slices) {
        for (int axis = 0; axis < 3; ++axis) {
            const Slices& along = slices[std::size_t(axis)];
            if (along.step == 0.0f) continue;
            auto& boxes = box[std::size_t(axis)];
            const int end = along.endOf(reference.box.upper[axis]);
            const int start = std::min(along.startOf(reference.box.lower[axis]), end);
            ++starts[std::size_t(axis)][std::size_t(start)];
            ++ends[std::size_t(axis)][std::size_t(end)];
            Reference rest = reference;
            for (int b = start; b < end; ++b) {
                const Parts parts = cut(rest, positions, axis, along.plane(b + 1));
                if (!isEmpty(parts.below.box)) boxes[std::size_t(b)].grow(parts.below.box);
                rest = parts.above;
                if (isEmpty(rest.box)) break;
            }
            if (!isEmpty(rest.box)) boxes[std::size_t(end)].grow(rest.box);
        }
    }
};

}  // namespace

bool isEmpty(const Box& box) {
    return box.lower[0] > box.upper[0] || box.lower[1] > box.upper[1] || box.lower[2] > box.upper[2];
}

Parts cut(const Reference& reference, std::span<const glm::vec3> positions, int axis, float plane) {
    const glm::vec3* corner = &positions[std::size_t(reference.triangle()) * 3];
    Box below = Box::empty(), above = Box::empty();
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 &a = corner[k], &b = corner[k == 2 ? 0 : k + 1];
        const Vec4 at{a.x, a.y, a.z, 0};
        if (a[axis] <= plane) below.grow({at, at});
        if (a[axis] >= plane) above.grow({at, at});
        if ((a[axis] < plane) == (b[axis] < plane) || a[axis] == plane || b[axis] == plane) continue;
        const glm::dvec3 from(a), edge = glm::dvec3(b) - from;
        const double part = (double(plane) - from[axis]) / edge[axis];
        Vec4 low{}, high{};
        for (int i = 0; i < 3; ++i) {
            // Each sum and product in double errs by 1.1e-16 of itself.
            const double x = from[i] + part * edge[i],
                         slack = 1e-15 * (std::abs(edge[i]) + std::abs(from[i]));
            low[i] = roundedBelow(x - slack);
            high[i] = roundedAbove(x + slack);
        }
        below.grow({low, high});
        above.grow({low, high});
    }
    Parts parts{reference, reference};
    const auto narrow = [](Box& box, const Box& to) {
        for (int i = 0; i < 3; ++i) {
            box.lower[i] = std::max(float(box.lower[i]), float(to.lower[i]));
            box.upper[i] = std::min(float(box.upper[i]), float(to.upper[i]));
        }
    };
    narrow(parts.below.box, below);
    narrow(parts.above.box, above);
    parts.below.box.upper[axis] = std::min(float(parts.below.box.upper[axis]), plane);
    parts.above.box.lower[axis] = std::max(float(parts.above.box.lower[axis]), plane);
    return parts;
}

SpatialSplit bestSpatialSplit(std::span<const Reference> references, std::span<const glm::vec3> positions,
                              const Box& box, double lengthWeight, bool parallel) {
    const std::array<Slices, 3> slices = {Slices(box, 0), Slices(box, 1), Slices(box, 2)};
    const auto fill = [&](const tbb::blocked_range<std::size_t>& part, SpaceBins sum) {
        for (std::size_t i = part.begin(); i < part.end(); ++i) sum.add(references[i], positions, slices);
        return sum;
    };
    const tbb::blocked_range<std::size_t> all(0, references.size(), kSpaceGrain);
    const SpaceBins bins = parallel && references.size() > 4 * kSpaceGrain
                               ? tbb::parallel_reduce(all, SpaceBins(), fill,
                                                      [](SpaceBins a, const SpaceBins& b) {
                                                          a.merge(b);
                                                          return a;
                                                      })
                               : fill(all, SpaceBins());
    SpatialSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        const Slices& along = slices[std::size_t(axis)];
        if (along.step == 0.0f) continue;
        const auto& boxes = bins.box[std::size_t(axis)];
        std::array<Box, kSpaceBins> right;
        std::array<std::uint32_t, kSpaceBins> rightCount{};
        Box sum = Box::empty();
        std::uint32_t n = 0;
        for (std::size_t b = kSpaceBins - 1; b > 0; --b) {
            sum.grow(boxes[b]);
            n += bins.ends[std::size_t(axis)][b];
            right[b] = sum;
            rightCount[b] = n;
        }
        sum = Box::empty();
        n = 0;
        for (std::size_t b = 1; b < std::size_t(kSpaceBins); ++b) {
            sum.grow(boxes[b - 1]);
            n += bins.starts[std::size_t(axis)][b - 1];
            if (n == 0 || rightCount[b] == 0) continue;
            const double cost = sum.size(lengthWeight) * n + right[b].size(lengthWeight) * rightCount[b];
            if (cost < best.cost) best = {axis, along.plane(int(b)), cost, n, rightCount[b], sum, right[b]};
        }
    }
    return best;
}

}  // namespace helio::bvh
