// Ways to read the tree: the same hits by each, the choice by times, and how it is kept.
#include "passes/intersect/ray_intersector.hpp"
#include "tests/support/device.hpp"
#include "tests/support/meshes.hpp"

#include <heliograph/tree_access.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace helio::test {
namespace {

TEST(TreeAccess, EveryWayGivesTheSameHits) {
    const PackedScene packed = packScene(sceneOf(knot()));
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) rays.push_back({.origin = 4.0f * point(), .direction = point()});
    std::vector<RayHit> wanted;
    for (const bool storage : {false, true})
        for (const bool addressed : {false, true}) {
            const TreeAccess access{storage, addressed};
            RayIntersector intersector(device(), packed, RayQuestion::Closest, rays.size(), access);
            intersector.upload(rays);
            intersector.run();
            const std::vector<RayHit> hits = intersector.hits();
            if (wanted.empty()) wanted = hits;
            std::size_t differ = 0, found = 0;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                differ += hits[i].slot != wanted[i].slot || hits[i].distance != wanted[i].distance ? 1 : 0;
                found += hits[i].slot >= 0 ? 1 : 0;
            }
            fmt::print("{}: {} of {} hit\n", describe(access), found, rays.size());
            EXPECT_EQ(differ, 0u) << describe(access);
            EXPECT_GT(found, 500u);
        }
}

TEST(TreeAccess, IsKeptPerDeviceAndDamageIsNotBelieved) {
    const auto folder =
        std::filesystem::temp_directory_path() / fmt::format("helio-access-{}", std::random_device{}());
    EXPECT_EQ(keptTreeAccess(device(), folder), TreeAccess{});
    for (const TreeAccess access :
         {TreeAccess{true, false}, TreeAccess{false, true}, TreeAccess{true, true}}) {
        EXPECT_TRUE(keepTreeAccess(device(), access, folder));
        EXPECT_EQ(keptTreeAccess(device(), folder), access);
    }
    const auto file = std::filesystem::directory_iterator(folder)->path();
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
    EXPECT_EQ(keptTreeAccess(device(), folder), TreeAccess{});
    std::ofstream(file) << "not a choice at all, nor of the right length";
    EXPECT_EQ(keptTreeAccess(device(), folder), TreeAccess{});
    std::filesystem::remove_all(folder);
}

TEST(TreeAccess, TheFastestIsTakenWhereItIsFasterThanNoise) {
    const TreeAccess usual{}, storage{true, false}, both{true, true};
    EXPECT_EQ(fastestAccess({{usual, 1.0}, {storage, 0.5}, {both, 0.7}}), storage);
    EXPECT_EQ(fastestAccess({{usual, 1.0}, {storage, 0.9}, {both, 0.8}}), both);
    EXPECT_EQ(fastestAccess({{usual, 1.0}, {storage, 0.97}, {both, 1.5}}), usual);
    const std::vector<MeasuredAccess> measured = measureTreeAccess(device(), 1);
    ASSERT_EQ(measured.size(), 4u);
    EXPECT_EQ(measured[0].access, usual);
    for (const MeasuredAccess& way : measured) {
        EXPECT_GT(way.seconds, 0.0);
        fmt::print("{}: {:.3f} s\n", describe(way.access), way.seconds);
    }
}

}  // namespace
}  // namespace helio::test
