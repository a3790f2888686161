// The tree's cost and what it predicts: surface area heuristic by its formula, the chance of a line to meet a
// box by counting lines, and boxes refitted to moved triangles.
#include "engine/scene/bvh.hpp"
#include "tests/unit/bvh_support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace helio {
namespace {

using test::expectSound;
using test::Positions;
using test::randomTriangles;

struct Box {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
    void grow(const Box& b) {
        lower = glm::min(lower, b.lower);
        upper = glm::max(upper, b.upper);
    }
    double surface() const {
        const glm::dvec3 e = upper - lower;
        return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
    }
};

/** Exact boxes, from the triangles up; `seen` is given every node's and every leaf's with its triangle count
 * (0: a node). */
Box walk(const Bvh& tree, const Positions& positions, std::uint32_t index,
         const std::function<void(const Box&, std::uint32_t)>& seen) {
    const BvhNode& node = tree.nodes[index];
    Box all;
    for (int s = 0; s < 8; ++s) {
        Box child;
        if (node.isInner(s)) {
            child = walk(tree, positions, node.firstChild + std::uint32_t(s), seen);
        } else if (const std::uint32_t count = node.triangleCount(s); count > 0) {
            for (std::uint32_t k = 0; k < 3 * count; ++k) {
                const glm::dvec3 p(positions[tree.order[node.triangleBegin(s) + k / 3] * 3 + k % 3]);
                child.grow({p, p});
            }
            seen(child, count);
        }
        all.grow(child);
    }
    seen(all, 0);
    return all;
}

TEST(BvhQuality, CostIsTheSurfaceAreaHeuristics) {
    const Positions positions = randomTriangles(20000, 0.05f, 3);
    const BvhOptions options;
    const Bvh tree = buildBvh(positions, options);
    double sum = 0;
    const Box root = walk(tree, positions, 0, [&](const Box& box, std::uint32_t count) {
        sum += box.surface() * (count > 0 ? count * options.triangleCost : 1.0);
    });
    EXPECT_NEAR(tree.cost, sum / root.surface(), 1e-9 * tree.cost);
    // Splitting space pays: a tree of the same boxes in the order of the input would cost several times as
    // much.
    EXPECT_LT(tree.cost, 0.02 * 20000 * options.triangleCost);
}

/** Cauchy's formula: of the lines that meet a convex body, a convex part of it is met by as many as its share
 * of the surface. Lines through two uniform points of a sphere around all are uniform among lines. */
TEST(BvhQuality, LinesMeetBoxesInProportionToTheirSurface) {
    const Positions positions = randomTriangles(3000, 0.1f, 5);
    const Bvh tree = buildBvh(positions);
    std::vector<Box> boxes;
    const Box root = walk(tree, positions, 0, [&](const Box& box, std::uint32_t) { boxes.push_back(box); });
    std::ranges::sort(boxes, std::greater{}, &Box::surface);
    boxes.resize(40);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const glm::dvec3 middle = 0.5 * (root.lower + root.upper);
    const double radius = glm::length(root.upper - middle);
    const auto onSphere = [&] {
        return middle + radius * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    };
    const auto meets = [](const Box& box, const glm::dvec3& o, const glm::dvec3& d) {
        double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
        for (int axis = 0; axis < 3; ++axis) {
            const double t0 = (box.lower[axis] - o[axis]) / d[axis],
                         t1 = (box.upper[axis] - o[axis]) / d[axis];
            enter = std::max(enter, std::min(t0, t1));
            leave = std::min(leave, std::max(t0, t1));
        }
        return enter <= leave;
    };
    constexpr int lines = 400000;
    int outer = 0;
    std::vector<int> inner(boxes.size(), 0);
    for (int i = 0; i < lines; ++i) {
        const glm::dvec3 a = onSphere(), d = onSphere() - a;
        if (!meets(root, a, d)) continue;
        ++outer;
        for (std::size_t b = 0; b < boxes.size(); ++b) inner[b] += meets(boxes[b], a, d) ? 1 : 0;
    }
    double worst = 0;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        const double p = boxes[b].surface() / root.surface(), n = outer;
        const double z = (inner[b] - n * p) / std::sqrt(std::max(n * p * (1 - p), 1.0));
        worst = std::max(worst, std::abs(z));
        EXPECT_NEAR(inner[b] / n, p, 0.01 * p + 4 * std::sqrt(p * (1 - p) / n)) << "box " << b;
    }
    fmt::print("{} of {} lines meet the root; worst |z| of {} boxes {:.2f}\n", outer, lines, boxes.size(),
               worst);
    EXPECT_LT(worst, 4.5);
}

TEST(BvhQuality, RefittedBoxesHoldMovedTriangles) {
    const Positions positions = randomTriangles(5000, 0.1f, 9);
    const Bvh built = buildBvh(positions);
    Bvh same = built;
    refitBvh(same, positions);
    EXPECT_EQ(0, std::memcmp(same.nodes.data(), built.nodes.data(), built.nodes.size() * sizeof(BvhNode)));
    EXPECT_NEAR(same.cost, built.cost, 1e-9 * built.cost);

    Positions moved = positions;
    for (glm::vec3& p : moved) p = glm::vec3(2.0f * p.x + 0.5f * p.y, p.y + std::sin(3.0f * p.x), 1e3f - p.z);
    Bvh refitted = built;
    refitBvh(refitted, moved);
    expectSound(moved, refitted, "moved");
    EXPECT_EQ(refitted.order, built.order);
    Bvh none;
    refitBvh(none, {});
    EXPECT_TRUE(none.nodes.empty());
}

}  // namespace
}  // namespace helio
