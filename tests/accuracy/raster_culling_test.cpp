/** @file Culling of clusters outside the view or hidden: pictures stay the same to the bit, and work falls.
 */
#include "tests/accuracy/raster_runner.hpp"

#include <cstdio>

namespace helio::test {
namespace {

/** Draws the same list with and without clusters. */
class CullingRunner {
public:
    CullingRunner(const std::vector<RasterTriangle>& triangles, const RasterView& view,
                  const RasterOptions& options = {})
        : view_(std::make_shared<RasterView>(view)),
          buffer_(device(), "triangles", triangles.size() * sizeof(RasterTriangle)) {
        buffer_.upload(triangles.data(), triangles.size() * sizeof(RasterTriangle));
        const auto all = [&](Graph& graph) {
            return RasterTriangles{graph.import(buffer_), std::uint32_t(triangles.size())};
        };
        clusters_ = std::make_unique<RasterClusters>(device(), all);
        const RasterPipeline pipeline(device(), options);
        for (Way* way : {&plain_, &culled_}) {
            Graph graph(device());
            const RasterOutput output =
                pipeline.declare(graph, all(graph), view_, way == &culled_ ? clusters_.get() : nullptr);
            way->keys = graph.readback<std::uint64_t>(output.visibility);
            way->counters = graph.readback<RasterCounters>(output.counters);
            way->plan = graph.compile({.poison = true});
        }
    }

    /** Counters with culling; adds to `different` and `covered`. */
    RasterCounters run(const RasterView& view, std::uint64_t& different, std::uint64_t& covered) {
        *view_ = view;
        const Execution a = plain_.plan.execute(), b = culled_.plan.execute();
        const std::vector<std::uint64_t> expected = plain_.keys.wait(a), keys = culled_.keys.wait(b);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            different += keys[i] != expected[i];
            covered += keys[i] != 0;
        }
        plainCounters = plain_.counters.wait(a).at(0);
        return culled_.counters.wait(b).at(0);
    }
    RasterCounters plainCounters;

private:
    struct Way {
        Plan plan;
        Readback<std::uint64_t> keys;
        Readback<RasterCounters> counters;
    };
    std::shared_ptr<RasterView> view_;
    DeviceBuffer buffer_;
    std::unique_ptr<RasterClusters> clusters_;
    Way plain_, culled_;
};

void add(std::vector<RasterTriangle>& list, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    RasterTriangle t;
    t.v0 = a;
    t.v1 = b;
    t.v2 = c;
    t.id = std::uint32_t(list.size());
    list.push_back(t);
}

/** Lumps of triangles all about the eye, near and far, small and large. */
std::vector<RasterTriangle> lumps(Random& random, int count) {
    std::vector<RasterTriangle> list;
    const auto cube = [&] {
        return glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    for (int i = 0; i < count; ++i) {
        const double distance = std::pow(10.0, random.uniform(-0.5, 1.5));
        const glm::dvec3 centre = distance * glm::normalize(cube() + 1e-9);
        const double size = distance * std::pow(10.0, random.uniform(-2, 0)),
                     grain = size * std::pow(10.0, random.uniform(-1.5, 0));
        // Lumps end anywhere within clusters.
        for (std::uint32_t k = 10 + random.below(200); k > 0; --k) {
            const glm::dvec3 at = centre + size * cube();
            add(list, at + grain * cube(), at + grain * cube(), at + grain * cube());
        }
    }
    return list;
}

/** A camera at `eye` turned about +y, of `focal` pixels; orthographic: of `focal` pixels a unit. */
RasterView turned(std::uint32_t width, std::uint32_t height, const glm::dvec3& eye, double angle,
                  double focal, bool orthographic) {
    RasterView view;
    view.width = width;
    view.height = height;
    view.eye = eye;
    const glm::dvec3 right(std::cos(angle), 0, std::sin(angle)), down(0, -1, 0),
        forward(std::sin(angle), 0, -std::cos(angle));
    view.rowW = forward;
    view.orthographic = orthographic;
    view.rowX = focal * right;
    view.rowY = focal * down;
    if (orthographic) {
        view.depthOffset = 1.0;
        view.depthSlope = -1.0 / 40;
    } else {
        view.rowX += 0.5 * width * forward;
        view.rowY += 0.5 * height * forward;
        view.depthOffset = 0.01;
    }
    return view;
}

std::uint64_t sum(const RasterCounters& c) {
    return c.outside + c.backFacing + c.empty + c.small + c.large + c.clipped + c.hidden;
}

TEST(RasterCulling, PicturesAreTheSameToTheBitWhereverTheCameraGoes) {
    struct Case {
        std::uint32_t width, height;
        bool orthographic;
        RasterOptions options;
    };
    const Case cases[] = {{200, 120, false, {}},
                          {97, 61, false, {.batch = 700}},
                          {160, 100, true, {.cullBackFaces = true}},
                          {128, 300, false, {.batch = 64, .depth = DepthFormat::Unorm16}}};
    std::uint64_t different = 0, covered = 0, hidden = 0, outside = 0, images = 0;
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const Case& c = cases[seed];
        Random random(seed);
        const std::vector<RasterTriangle> list = lumps(random, seed == 3 ? 15 : 150);
        const auto viewAt = [&](const glm::dvec3& eye, double angle) {
            RasterView view =
                turned(c.width, c.height, eye, angle, c.orthographic ? 4.0 : 90.0, c.orthographic);
            if (c.options.depth != DepthFormat::Reversed) conventionalDepth(view, 100);
            return view;
        };
        CullingRunner runner(list, viewAt({0, 0, 0}, 0), c.options);
        for (int k = 0; k < 24; ++k) {
            // Now and then a step so small that most stays, else a leap.
            const bool leap = k % 4 == 0;
            static glm::dvec3 eye(0.0);
            static double angle = 0;
            eye = leap ? glm::dvec3(random.uniform(-3, 3), random.uniform(-1, 1), random.uniform(-3, 3))
                       : eye + glm::dvec3(random.uniform(-0.02, 0.02));
            angle = leap ? random.uniform(-4, 4) : angle + random.uniform(-0.02, 0.02);
            const RasterCounters counters = runner.run(viewAt(eye, angle), different, covered);
            EXPECT_EQ(counters.triangles, list.size());
            EXPECT_EQ(sum(counters), list.size());
            hidden += counters.hidden;
            outside += counters.clustersOutside;
            ++images;
        }
    }
    std::printf(
        "%llu images: %llu pixels covered, %llu different; %llu triangles hidden, %llu clusters "
        "outside\n",
        (unsigned long long)images, (unsigned long long)covered, (unsigned long long)different,
        (unsigned long long)hidden, (unsigned long long)outside);
    EXPECT_EQ(different, 0u);
    EXPECT_GT(covered, 100000u);
    EXPECT_GT(hidden, 10000u);
    EXPECT_GT(outside, 1000u);
}

/** A wall of two triangles, last in the list, before a box of lumps. */
std::vector<RasterTriangle> behindAWall(double wallHalf) {
    Random random(7);
    std::vector<RasterTriangle> list;
    for (int i = 0; i < 64 * 400; ++i) {
        // Each cluster keeps to a place of its own.
        const int cluster = i / 64;
        const glm::dvec3 at(-10 + cluster % 20, -10 + cluster / 20, -30 + random.uniform(-5, 5));
        const auto corner = [&] {
            return at + glm::dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(-0.1, 0.1));
        };
        add(list, corner(), corner(), corner());
    }
    const double z = -20;
    add(list, {-wallHalf, -wallHalf, z}, {wallHalf, -wallHalf, z}, {wallHalf, wallHalf, z});
    add(list, {-wallHalf, -wallHalf, z}, {wallHalf, wallHalf, z}, {-wallHalf, wallHalf, z});
    return list;
}

TEST(RasterCulling, WhatAWallHidesIsNotSetUpFromTheSecondImageOn) {
    const RasterView view = turned(320, 320, {0, 0, 0}, 0, 300, false);
    std::uint64_t different = 0, covered = 0;
    const std::vector<RasterTriangle> list = behindAWall(12);
    CullingRunner runner(list, view);
    const RasterCounters first = runner.run(view, different, covered);
    EXPECT_EQ(first.hidden, 0u);  // nothing is known yet
    EXPECT_EQ(first.clusters, 401u);
    for (int k = 0; k < 3; ++k) {
        const RasterCounters later = runner.run(view, different, covered);
        EXPECT_EQ(later.hidden, 64u * 400u);
        EXPECT_EQ(later.clustersHidden, 400u);
        EXPECT_EQ(later.clustersOutside, 0u);
        EXPECT_EQ(later.large + later.small + later.clipped, 2u);
        EXPECT_EQ(later.smallVisited, 0u);
        EXPECT_GT(runner.plainCounters.smallVisited + runner.plainCounters.tileVisited, 25000u);
    }
    EXPECT_EQ(different, 0u);
}

TEST(RasterCulling, WhereLittleIsHiddenNoDepthIsLookedAt) {
    // No wall before the view: all but the odd cluster shows, and what did not is drawn along.
    const RasterView view = turned(640, 640, {0, 0, 0}, 0, 900, false);
    std::uint64_t different = 0, covered = 0;
    const std::vector<RasterTriangle> list = behindAWall(1e-3);
    CullingRunner runner(list, view);
    for (int k = 0; k < 3; ++k) {
        const RasterCounters counters = runner.run(view, different, covered);
        EXPECT_EQ(counters.hidden, 0u);
        EXPECT_EQ(counters.clustersHidden, 0u);
        EXPECT_EQ(sum(counters), list.size());
    }
    EXPECT_EQ(different, 0u);
    EXPECT_GT(covered, 100000u);
}

}  // namespace
}  // namespace helio::test
