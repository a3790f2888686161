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

/** Sticks in all directions, whose boxes are large, among small triangles. */
Positions sticks(std::size_t count, float scale, const glm::vec3& at) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    Positions positions;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 from = point(), along = (i % 6 == 0 ? 0.8f : 0.01f) * point(),
                        across = 0.01f * point();
        for (const glm::vec3& p : {from, from + along, from + across}) positions.push_back(at + scale * p);
    }
    return positions;
}

/** Of every leaf of a tree: its triangles, and the box that rays meet. */
void forLeaves(const Bvh& tree, std::uint32_t index,
               const std::function<void(std::span<const std::uint32_t>, const BvhBox&)>& seen) {
    const BvhNode& node = tree.nodes[index];
    for (int s = 0; s < 8; ++s) {
        if (node.isInner(s))
            forLeaves(tree, node.firstChild + std::uint32_t(s), seen);
        else if (const std::uint32_t count = node.triangleCount(s); count > 0)
            seen(std::span(tree.order).subspan(node.triangleBegin(s), count), childBox(node, s));
    }
}

TEST(BvhSplits, EveryPointOfATriangleIsInALeafOfIt) {
    for (const auto& [name, positions] :
         {std::pair("sticks", sticks(3000, 1.0f, glm::vec3(0.0f))),
          std::pair("far away", sticks(3000, 1.0f, glm::vec3(1000.0f, -3e4f, 0.0f))),
          std::pair("huge", sticks(3000, 1e30f, glm::vec3(0.0f))),
          std::pair("tiny", sticks(3000, 1e-30f, glm::vec3(0.0f)))}) {
        SCOPED_TRACE(name);
        const std::size_t triangles = positions.size() / 3;
        BvhOptions options;
        options.spatialSplits = 0.5;
        const Bvh tree = buildBvh(positions, options);
        EXPECT_GT(tree.order.size(), triangles + triangles / 20);
        EXPECT_LE(double(tree.order.size()), 1.5 * double(triangles));
        options.parallel = false;
        const Bvh serial = buildBvh(positions, options);
        EXPECT_EQ(serial.order, tree.order);
        ASSERT_EQ(serial.nodes.size(), tree.nodes.size());
        EXPECT_EQ(0,
                  std::memcmp(serial.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(BvhNode)));

        std::vector<std::vector<BvhBox>> boxes(triangles);
        std::size_t twice = 0;
        forLeaves(tree, 0, [&](std::span<const std::uint32_t> leaf, const BvhBox& box) {
            for (std::size_t i = 0; i < leaf.size(); ++i) {
                boxes[leaf[i]].push_back(box);
                twice += std::size_t(std::ranges::count(leaf, leaf[i]) - 1);
            }
        });
        EXPECT_EQ(twice, 0u);
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        std::size_t outside = 0;
        for (std::size_t t = 0; t < triangles; ++t)
            for (int k = 0; k < 40; ++k) {
                double u = uniform(random), v = uniform(random);
                if (k % 4 == 0) v = 0.0;  // on an edge
                if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
                const glm::dvec3 a(positions[t * 3]), b(positions[t * 3 + 1]), c(positions[t * 3 + 2]);
                const glm::dvec3 p = a * (1.0 - u - v) + b * u + c * v;
                const double slack = 1e-14 * glm::length(a);  // of p itself
                outside += std::ranges::none_of(boxes[t], [&](const BvhBox& box) {
                    return glm::all(glm::greaterThanEqual(p, box.lower - slack)) &&
                           glm::all(glm::lessThanEqual(p, box.upper + slack));
                });
            }
        EXPECT_EQ(outside, 0u);
        const double plain = buildBvh(positions).cost;
        fmt::print("{}: {} triangles in {} places, cost {:.2f} of {:.2f}\n", name, triangles,
                   tree.order.size(), tree.cost, plain);
        EXPECT_LT(tree.cost, 0.95 * plain);
    }
}

TEST(BvhSplits, TrianglesThatNoPlanePartsAreLeftWhole) {
    BvhOptions options;
    options.spatialSplits = 1.0;
    // All in one place; all in one point; nothing cut where nothing overlaps.
    Positions same, points, apart;
    for (int i = 0; i < 400; ++i) {
        for (const glm::vec3& p : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 1)}) {
            same.push_back(p);
            points.push_back(glm::vec3(5.0f));
            apart.push_back(p * 0.01f + glm::vec3(float(i), 0, 0));
        }
    }
    for (const Positions* positions : {&points, &apart}) {
        const Bvh tree = buildBvh(*positions, options);
        EXPECT_EQ(tree.order.size(), 400u);
        expectSound(*positions, tree, "whole");
    }
    EXPECT_LE(buildBvh(same, options).order.size(), 800u);
    EXPECT_EQ(buildBvh({}, options).nodes.size(), 0u);
    EXPECT_EQ(buildBvh(std::span(apart).first(3), options).order.size(), 1u);
}

}  // namespace
}  // namespace helio
