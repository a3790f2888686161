// The tree: structure, conservative boxes, agreement with brute force, extremes of scale, degenerate input.
#include "engine/scene/bvh.hpp"

#include "tests/support/sanitized.hpp"
#include "tests/unit/bvh_support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace helio {
namespace {

using test::expectSound;
using test::Positions;
using test::randomTriangles;

double hitDistance(const glm::dvec3& o, const glm::dvec3& d, const glm::vec3* corners) {
    const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
    const glm::dvec3 p = glm::cross(d, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) return std::numeric_limits<double>::infinity();
    const glm::dvec3 s = o - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(d, q) / determinant,
                 t = glm::dot(e2, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : std::numeric_limits<double>::infinity();
}

double closest(const Bvh& tree, const Positions& positions, std::uint32_t index, const glm::dvec3& o,
               const glm::dvec3& d, double nearest) {
    const BvhNode& node = tree.nodes[index];
    for (int s = 0; s < 8; ++s) {
        if (!node.isInner(s) && node.triangleCount(s) == 0) continue;
        const BvhBox box = childBox(node, s);
        double enter = 0, leave = nearest;
        for (int axis = 0; axis < 3; ++axis) {
            if (d[axis] == 0) {
                if (o[axis] < box.lower[axis] || o[axis] > box.upper[axis]) leave = -1;
                continue;
            }
            const double t0 = (box.lower[axis] - o[axis]) / d[axis],
                         t1 = (box.upper[axis] - o[axis]) / d[axis];
            enter = std::max(enter, std::min(t0, t1));
            leave = std::min(leave, std::max(t0, t1));
        }
        if (enter > leave * (1 + 1e-12)) continue;
        if (node.isInner(s)) {
            nearest = closest(tree, positions, node.firstChild + std::uint32_t(s), o, d, nearest);
            continue;
        }
        for (std::uint32_t k = 0; k < node.triangleCount(s); ++k) {
            const std::uint32_t triangle = tree.order[node.triangleBegin(s) + k];
            nearest = std::min(nearest, hitDistance(o, d, &positions[triangle * 3]));
        }
    }
    return nearest;
}

TEST(Bvh, EveryTriangleIsInOneLeafAndEveryBoxHoldsItsTriangles) {
    for (std::size_t count : {0u, 1u, 2u, 3u, 4u, 7u, 50u, 5000u, 40000u}) {
        const Positions positions = randomTriangles(count, 0.1f, std::uint32_t(count));
        expectSound(positions, buildBvh(positions), fmt::format("{} triangles", count).c_str());
    }
}

TEST(Bvh, ResultDoesNotDependOnThreads) {
    const Positions positions = randomTriangles(60000, 0.02f, 1);
    const Bvh serial = buildBvh(positions, {.parallel = false}), parallel = buildBvh(positions);
    EXPECT_EQ(serial.order, parallel.order);
    ASSERT_EQ(serial.nodes.size(), parallel.nodes.size());
    EXPECT_EQ(0,
              std::memcmp(serial.nodes.data(), parallel.nodes.data(), serial.nodes.size() * sizeof(BvhNode)));
}

TEST(Bvh, DegenerateInputIsKept) {
    expectSound(Positions(300, glm::vec3(1, 2, 3)), buildBvh(Positions(300, glm::vec3(1, 2, 3))),
                "one point");
    Positions same = randomTriangles(1, 1.0f, 3);
    for (int i = 0; i < 8; ++i) same.insert(same.end(), same.begin(), same.end());
    expectSound(same, buildBvh(same), "coincident");
    Positions flat = randomTriangles(2000, 0.1f, 4);
    for (glm::vec3& p : flat) p.y = 7.0f;
    expectSound(flat, buildBvh(flat), "flat");
    Positions line = randomTriangles(2000, 0.1f, 5);
    for (glm::vec3& p : line) p = glm::vec3(p.x, 0, 0);
    expectSound(line, buildBvh(line), "line");
    Positions zero(30, glm::vec3(0));
    expectSound(zero, buildBvh(zero), "origin");
    // Sizes and distances spread over all magnitudes: no split halves this by count.
    Positions geometric;
    for (int i = -120; i < 120; ++i)
        for (const glm::vec3& p : randomTriangles(1, 0.1f, std::uint32_t(i + 500)))
            geometric.push_back(p * std::ldexp(1.0f, i));
    expectSound(geometric, buildBvh(geometric), "geometric");
}

TEST(Bvh, EveryScaleGivesTheSameHitsAsBruteForce) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (double scale : {1e-30, 1e-6, 1.0, 1e6, 1e30})
        for (double distance : {0.0, 100.0}) {
            Positions positions = randomTriangles(700, 0.2f, 6);
            for (glm::vec3& p : positions) p = glm::vec3((glm::dvec3(p) + distance) * scale);
            const Bvh tree = buildBvh(positions);
            expectSound(positions, tree, fmt::format("scale {}", scale).c_str());
            int hits = 0;
            for (int i = 0; i < 400; ++i) {
                const glm::dvec3 o =
                    (glm::dvec3(uniform(random), uniform(random), uniform(random)) * 2.0 + distance) * scale;
                glm::dvec3 d(uniform(random), uniform(random), uniform(random));
                if (i % 4 == 0) d[i / 4 % 3] = 0;
                d = glm::normalize(d);
                double expected = std::numeric_limits<double>::infinity();
                for (std::size_t t = 0; t < positions.size(); t += 3)
                    expected = std::min(expected, hitDistance(o, d, &positions[t]));
                const double found =
                    closest(tree, positions, 0, o, d, std::numeric_limits<double>::infinity());
                EXPECT_EQ(found, expected) << "scale " << scale << " ray " << i;
                hits += std::isfinite(expected) ? 1 : 0;
            }
            EXPECT_GT(hits, 20);
        }
}

TEST(Bvh, MillionTriangles) {
    const Positions positions = randomTriangles(test::series(1000000), 0.005f, 8);
    const auto start = std::chrono::steady_clock::now();
    const Bvh tree = buildBvh(positions);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} triangles: {:.2f} s, {} nodes used of {}, depth {}, cost {:.1f}\n", positions.size() / 3,
               seconds, tree.usedNodes, tree.nodes.size(), tree.depth, tree.cost);
    expectSound(positions, tree, "million");
}

}  // namespace
}  // namespace helio
