// Trees that the device builds: structure, boxes that hold what is in them, any number of triangles, codes
// that are the same, boxes without surface, and what is refused.
#include "passes/tree/tree_builder.hpp"

#include "tests/support/device.hpp"
#include "tests/support/meshes.hpp"
#include "tests/unit/bvh_support.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace helio::test {
namespace {

Positions scaledTo(Positions positions, const glm::vec3& scale, const glm::vec3& at) {
    for (glm::vec3& p : positions) p = scale * p + at;
    return positions;
}

TEST(TreeBuilder, TreesOfAnyCountAreSound) {
    TreeBuilder builder(device(), 40000);
    // From many to few: what is left of the tree before must not show.
    for (std::size_t count : {40000u, 5000u, 257u, 256u, 65u, 50u, 9u, 8u, 7u, 4u, 3u, 2u, 1u, 0u}) {
        const Positions positions = randomTriangles(count, 0.1f, std::uint32_t(count));
        const Bvh tree = builder.build(positions), again = builder.build(positions);
        expectSound(positions, tree, fmt::format("{} triangles", count).c_str());
        ASSERT_EQ(tree.nodes.size(), again.nodes.size());
        EXPECT_EQ(tree.order, again.order);
        EXPECT_EQ(0, std::memcmp(tree.nodes.data(), again.nodes.data(), tree.nodes.size() * sizeof(BvhNode)));
    }
}

TEST(TreeBuilder, PlacesAndScalesAndDegenerateBoxes) {
    const Positions some = randomTriangles(3000, 0.05f, 2);
    Positions same, points;
    for (int i = 0; i < 3000; ++i) {
        same.insert(same.end(), some.begin(), some.begin() + 3);
        points.insert(points.end(), 3, some[std::size_t(i) * 3]);
    }
    Positions clusters = scaledTo(some, glm::vec3(1e-6f), glm::vec3(1.0f));
    clusters.insert(clusters.end(), some.begin(), some.end());
    TreeBuilder builder(device(), 6000);
    const auto expect = [&](const Positions& positions, const char* name) {
        expectSound(positions, builder.build(positions), name);
    };
    expect(same, "all of one code and box");
    expect(scaledTo(same, glm::vec3(0.0f), glm::vec3(3.0f)), "all in one point");
    expect(points, "points");
    expect(scaledTo(some, glm::vec3(1, 0, 0), glm::vec3(0, 5, 0)), "on a line");
    expect(scaledTo(some, glm::vec3(1, 1, 0), glm::vec3(0.0f)), "in a plane");
    expect(clusters, "half of them in one cell");
    expect(scaledTo(some, glm::vec3(1e38f), glm::vec3(0.0f)), "huge");
    expect(scaledTo(some, glm::vec3(1e-30f), glm::vec3(0.0f)), "tiny");
    expect(scaledTo(some, glm::vec3(1e-42f), glm::vec3(0.0f)), "below normal numbers");
    expect(scaledTo(some, glm::vec3(1.0f), glm::vec3(1e5f, -3e4f, 1e3f)), "far away");
    expect(scaledTo(some, glm::vec3(1e-6f), glm::vec3(1.0f)), "small where floats are coarse");
}

TEST(TreeBuilder, AMillionTriangles) {
    const Corners corners = landscape(1000000);
    const Bvh tree = TreeBuilder(device(), corners.size() / 3).build(corners);
    expectSound(corners, tree, "landscape");
    fmt::print("{} triangles: {} nodes in {} levels\n", corners.size() / 3, tree.usedNodes, tree.depth);
}

TEST(TreeBuilder, RefusesWhatNoBoxHolds) {
    TreeBuilder builder(device(), 10);
    Positions positions = randomTriangles(10, 0.1f, 1);
    for (float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e38f}) {
        for (std::size_t corner : {0u, 29u}) {
            Positions broken = positions;
            broken[corner].y = bad;
            EXPECT_THROW(builder.build(broken), InputError) << bad;
        }
    }
    EXPECT_NO_THROW(builder.build(positions));
    EXPECT_THROW(TreeBuilder(device(), TreeBuilder::mostTriangles(device()) + 1), InputError);
}

}  // namespace
}  // namespace helio::test
