// The same input gives the same bits: whatever the loop budget, the sizes of steps' dispatches, and the
// driver's threads.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/tree_access.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>

namespace helio::test {
namespace {

PathTraceOptions options(std::uint32_t budget) {
    PathTraceOptions o;
    o.size = {45, 37};  // no multiple of a tile
    o.turnBudget = budget;
    o.seed = 5;
    return o;
}

/** A room with a ball: enough triangles for a tree. */
Scene ballInRoom() {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.7f, 0.6f, 0.5f)),
              light = b.material(glm::vec3(0.2f), glm::vec3(3, 2, 1));
    b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, light, wall, wall});
    b.sphere({0.2f, -0.4f, -0.2f}, 0.5f, 3, false, wall);
    b.camera({0, 0, 0.9f}, {0, -0.1f, -1}, 1.0f);
    return b.scene;
}

/** FNV-1a over the bits of the means. */
std::uint64_t hashOf(const Traced& image) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const glm::dvec3& value : image.mean)
        for (int c = 0; c < 3; ++c) {
            std::uint64_t bits;
            const double v = value[c];
            std::memcpy(&bits, &v, sizeof bits);
            hash = (hash ^ bits) * 1099511628211ull;
        }
    return hash;
}

TEST(PathDeterminism, BudgetsDoNotMatter) {
    for (const Scene& scene : {load("sample:cornell"), ballInRoom()}) {
        const Traced whole = trace(scene, options(30000), 24, 8);
        for (std::uint32_t budget : {1u, 7u, 100u}) {
            const Traced parts = trace(scene, options(budget), 24, 8);
            EXPECT_EQ(hashOf(parts), hashOf(whole)) << "budget " << budget;
            EXPECT_EQ(parts.counters.bounceRays, whole.counters.bounceRays);
            EXPECT_EQ(parts.counters.shadowRays, whole.counters.shadowRays);
            EXPECT_EQ(parts.counters.cameraRays, whole.counters.cameraRays);
        }
        EXPECT_EQ(whole.counters.cameraRays, 45u * 37u * 24u);
    }
}

/** Every sampler converges to one picture. */
TEST(PathDeterminism, SamplersAgree) {
    PathTraceOptions o = options(30000);
    o.sampler = SamplerKind::Independent;
    o.samples = 256;
    const auto mean = [&](const Traced& image) {
        return estimate(image, 1, [](std::size_t) { return true; });
    };
    const Scene scene = load("sample:cornell");
    const Estimate truth = mean(trace(scene, o, 256));
    for (SamplerKind kind :
         {SamplerKind::Sobol, SamplerKind::Halton, SamplerKind::Stratified, SamplerKind::SobolBlue}) {
        o.sampler = kind;
        const Estimate e = mean(trace(scene, o, 256));
        // Stratified samples err less than their variance says: the interval is wider than need be.
        const double z = (e.mean - truth.mean) / std::hypot(e.error, truth.error);
        fmt::print("sampler {}: {:.5f} +- {:.5f}, z {:+.2f}\n", int(kind), e.mean, e.error, z);
        EXPECT_LT(std::abs(z), 4.0) << int(kind);
        EXPECT_LT(e.error, 0.01 * e.mean);
    }
}

TEST(PathDeterminism, AcceleratorsDoNotMatter) {
    const auto image = [](AcceleratorKind kind) {
        PathTraceOptions o = options(30000);
        o.accelerator = kind;
        return trace(ballInRoom(), o, 16);
    };
    const Traced tree = image(AcceleratorKind::Bvh);
    for (AcceleratorKind kind : {AcceleratorKind::BruteForce, AcceleratorKind::Grid, AcceleratorKind::Octree,
                                 AcceleratorKind::KdTree, AcceleratorKind::Bsp, AcceleratorKind::SplitBvh,
                                 AcceleratorKind::DeviceBvh})
        EXPECT_EQ(hashOf(image(kind)), hashOf(tree)) << int(kind);

    // By default the walls are written out beside the tree, two triangles as one quadrilateral, whose
    // distance rounds otherwise than those of both.
    const Traced beside = image(AcceleratorKind::Auto);
    EXPECT_EQ(beside.hits.triangle, tree.hits.triangle);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < tree.mean.size(); ++i)
        differ += glm::length(beside.mean[i] - tree.mean[i]) > 1e-4 * glm::length(tree.mean[i]) ? 1 : 0;
    EXPECT_LE(differ, tree.mean.size() / 200);
}

/** The way that is kept for the device is taken by both schedulers. */
TEST(PathDeterminism, WaysToReadTheTreeDoNotMatter) {
    const auto image = [](Scheduler scheduler) {
        PathTraceOptions o = options(30000);
        o.accelerator = AcceleratorKind::Bvh;
        o.scheduler = scheduler;
        return hashOf(trace(ballInRoom(), o, 2));
    };
    const auto usual = image(Scheduler::Megakernel);
    const auto folder =
        std::filesystem::temp_directory_path() / fmt::format("helio-ways-{}", std::random_device{}());
    const char* before = std::getenv("XDG_CACHE_HOME");
    const std::string kept = before != nullptr ? before : "";
    ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);
    const TreeAccess access{.nodesInStorage = true, .addressedStack = true};
    ASSERT_TRUE(keepTreeAccess(device(), access));
    ASSERT_EQ(keptTreeAccess(device()), access);
    for (Scheduler scheduler : {Scheduler::Megakernel, Scheduler::Wavefront})
        EXPECT_EQ(image(scheduler), usual) << int(scheduler);
    if (before != nullptr)
        ::setenv("XDG_CACHE_HOME", kept.c_str(), 1);
    else
        ::unsetenv("XDG_CACHE_HOME");
    std::filesystem::remove_all(folder);
}

/** Not a test of its own: what RunsWithOneAndTwoThreads starts. */
TEST(PathDeterminism, PrintHash) {
    std::uint64_t hash = 0;
    for (const Scene& scene : {load("sample:cornell"), ballInRoom()})
        hash = hash * 31 + hashOf(trace(scene, options(30000), 16));
    fmt::print("hash={:016x}\n", hash);
}

TEST(PathDeterminism, DriverThreadsDoNotMatter) {
    const auto run = [](const char* threads) {
        char self[4096] = {};
        EXPECT_GT(readlink("/proc/self/exe", self, sizeof self - 1), 0);
        const std::string command =
            fmt::format("LP_NUM_THREADS={} '{}' --gtest_filter=PathDeterminism.PrintHash", threads, self);
        FILE* pipe = popen(command.c_str(), "r");
        std::string text;
        std::array<char, 256> part;
        while (pipe != nullptr && std::fgets(part.data(), int(part.size()), pipe) != nullptr)
            text += part.data();
        EXPECT_NE(pipe, nullptr);
        EXPECT_EQ(pclose(pipe), 0) << text;
        const std::size_t at = text.find("hash=");
        return at == std::string::npos ? text : text.substr(at, 21);
    };
    const std::string one = run("1");
    EXPECT_EQ(one.size(), 21u);
    EXPECT_EQ(one, run("2"));
    EXPECT_EQ(one, run("2")) << "a second run";
    EXPECT_EQ(one, run("3"));
}

}  // namespace
}  // namespace helio::test
