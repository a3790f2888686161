#pragma once
/** @file What tests of the tree share: random triangles, and a walk that checks a tree's structure. */
#include "engine/scene/bvh.hpp"

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace helio::test {

using Positions = std::vector<glm::vec3>;

inline Positions randomTriangles(std::size_t count, float size, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    Positions positions;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 centre = point();
        for (int k = 0; k < 3; ++k) positions.push_back(centre + size * point());
    }
    return positions;
}

struct Walk {
    std::vector<int> seen;  ///< times each triangle is in a leaf
    std::size_t nodes = 0;
    bool contained = true;
};

/** Visits every node; `bounds` is the box the parent decoded for it, which must hold all it holds. */
inline void visit(const Bvh& tree, const Positions& positions, std::uint32_t index,
                  std::vector<BvhBox> bounds, Walk& walk) {
    const BvhNode& node = tree.nodes[index];
    ++walk.nodes;
    for (int s = 0; s < 8; ++s) {
        const std::uint32_t count = node.triangleCount(s);
        std::vector<BvhBox> inner = bounds;
        inner.push_back(childBox(node, s));
        if (node.isInner(s)) {
            ASSERT_EQ(count, 0);
            visit(tree, positions, node.firstChild + std::uint32_t(s), inner, walk);
        } else {
            ASSERT_EQ((1u << count) - 1u, node.slots >> (8 + 3 * s) & 7u);
            for (std::uint32_t k = 0; k < count; ++k) {
                const std::uint32_t triangle = tree.order[node.triangleBegin(s) + k];
                ++walk.seen[triangle];
                for (std::size_t c = 0; c < 3; ++c)
                    for (const BvhBox& box : inner) {
                        const glm::dvec3 p(positions[triangle * 3 + c]);
                        if (glm::any(glm::lessThan(p, box.lower)) || glm::any(glm::greaterThan(p, box.upper)))
                            walk.contained = false;
                    }
            }
        }
    }
}

inline void expectSound(const Positions& positions, const Bvh& tree, const char* what) {
    SCOPED_TRACE(what);
    Walk walk;
    walk.seen.resize(positions.size() / 3);
    ASSERT_EQ(tree.order.size(), walk.seen.size());
    if (positions.empty()) return;
    visit(tree, positions, 0, {}, walk);
    EXPECT_TRUE(std::ranges::all_of(walk.seen, [](int n) { return n == 1; }));
    EXPECT_TRUE(walk.contained);
    EXPECT_EQ(walk.nodes, tree.usedNodes);
    EXPECT_LE(tree.depth, 24u);
}

}  // namespace helio::test
