// Closed rooms whose radiance is known exactly: truths 1.2.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace helio::test {
namespace {

constexpr float kFov = 1.2f;

Scene furnace(float albedo, float emission) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(albedo), glm::vec3(emission));
    b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
    b.camera({0.1f, 0.2f, 0.3f}, {0.4f, 0.1f, -1}, kFov);
    return b.scene;
}

/** |z| < 4 at a standard error below 0.2 % of the truth. A furnace without noise passes where it is exact. */
void expectRadiance(
    const Traced& image, double truth, const std::string& what,
    const std::function<bool(std::size_t)>& wanted = [](std::size_t) { return true; }) {
    for (int c = 0; c < 3; ++c) {
        const Estimate e = estimate(image, c, wanted);
        const double z = (e.mean - truth) / std::max(e.error, 1e-6 * truth);
        if (c == 0)
            fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}, {} pixels\n", what, e.mean, e.error,
                       truth, z, e.pixels);
        EXPECT_LT(std::abs(z), 4.0) << what;
        EXPECT_LT(e.error, 0.002 * truth) << what;
    }
    EXPECT_EQ(image.rejected, 0u);
    EXPECT_EQ(image.counters.abandonedRays, 0u);
    EXPECT_EQ(image.counters.truncatedPaths, 0u);
}

PathTraceOptions options(std::uint32_t size, bool nextEvent = true) {
    PathTraceOptions o;
    o.size = {size, size};
    o.sampler = SamplerKind::Independent;
    o.nextEventEstimation = nextEvent;
    return o;
}

TEST(PathEnclosure, FurnaceHoldsTheGeometricSeries) {
    for (float albedo : {0.2f, 0.5f, 0.8f, 0.9f})
        for (bool nextEvent : {true, false}) {
            const double truth = verify::furnaceRadiance(1.0, double(albedo));
            expectRadiance(trace(furnace(albedo, 1.0f), options(32, nextEvent), albedo > 0.7f ? 256 : 64),
                           truth, fmt::format("furnace albedo {} next event {}", albedo, nextEvent));
        }
}

TEST(PathEnclosure, DepthCutsTheSeries) {
    for (std::uint32_t depth : {0u, 1u, 2u, 5u}) {
        PathTraceOptions o = options(32);
        o.maxDepth = depth;
        expectRadiance(trace(furnace(0.8f, 1.0f), o, 128),
                       verify::furnaceRadiance(1.0, double(0.8f), int(depth)),
                       fmt::format("depth {}", depth));
    }
}

/** A sphere seen from inside whose cap above `height` emits; the radiance off the cap is known for a true
 * sphere, and the fraction of area that emits is counted from its triangles. */
TEST(PathEnclosure, IntegratingSphere) {
    struct Case {
        float albedo;
        double fraction;
    };
    for (const Case& c : {Case{0.8f, 0.1}, Case{0.5f, 0.5}}) {
        SceneBuilder b;
        std::vector<glm::vec3> cap, rest;
        double capArea = 0, restArea = 0;
        const std::vector<glm::vec3> corners = unitSphere(5);
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const glm::vec3 middle = (corners[i] + corners[i + 1] + corners[i + 2]) / 3.0f;
            const bool emits = middle.z > 1.0 - 2.0 * c.fraction;
            const double area = 0.5 * glm::length(glm::cross(glm::dvec3(corners[i + 1] - corners[i]),
                                                             glm::dvec3(corners[i + 2] - corners[i])));
            (emits ? capArea : restArea) += area;
            for (std::size_t k : {i, i + 2, i + 1}) (emits ? cap : rest).push_back(corners[k]);
        }
        b.triangles(cap, b.material(glm::vec3(c.albedo), glm::vec3(1.0f)));
        b.triangles(rest, b.material(glm::vec3(c.albedo)));
        b.camera({0.1f, 0.2f, 0.1f}, {0.3f, 0.1f, -1}, 0.8f);  // away from the cap
        const double fraction = capArea / (capArea + restArea);
        const Traced image = trace(b.scene, options(24), 512);
        expectRadiance(image, verify::sphereCavityRadiance(1.0, double(c.albedo), fraction),
                       fmt::format("sphere albedo {} fraction {:.4f}", c.albedo, fraction));
    }
}

TEST(PathEnclosure, PointLightsInASphere) {
    for (int lights : {1, 4}) {
        SceneBuilder b;
        b.sphere({0, 0, 0}, 1.0f, 5, true, b.material(glm::vec3(0.5f)));
        for (int i = 0; i < lights; ++i) b.pointLight({0, 0, 0}, glm::vec3(float(3.14159265358979 / lights)));
        b.camera({0.3f, 0.2f, 0.1f}, {-0.3f, 0.1f, -1}, 0.8f);
        expectRadiance(trace(b.scene, options(24), 256), 1.0, fmt::format("{} point lights", lights));
    }
}

/** Every corner of the room lies far from the origin: offsets must not leak light nor shadow it. */
TEST(PathEnclosure, FurnaceFarFromTheOrigin) {
    for (float distance : {1e2f, 1e4f, 1e5f}) {
        SceneBuilder b;
        const int wall = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
        const glm::vec3 at(distance, -distance, 0.5f * distance);
        b.room(at + glm::vec3(-1, -1, -1), at + glm::vec3(1, 1.5f, 2), {wall, wall, wall, wall, wall, wall});
        b.camera(at + glm::vec3(0.125f, 0.25f, 0.25f), at + glm::vec3(0.375f, 0.125f, -1), kFov);
        expectRadiance(trace(b.scene, options(32), 64), 2.0, fmt::format("furnace at {}", distance));
    }
}

/** Black closed surfaces under a white sky, seen from inside: any light is a leak. */
TEST(PathEnclosure, NoLeaks) {
    const auto leak = [](SceneBuilder& b, std::uint32_t size, std::uint32_t samples) {
        b.scene.environment = Environment{glm::vec3(1.0f), -1};
        PathTraceOptions o = options(size);
        const Traced image = trace(b.scene, o, samples);
        double light = 0;
        for (const glm::dvec3& value : image.mean) light += value.x;
        return light;
    };
    SceneBuilder ball;
    ball.sphere({0, 0, 0}, 1.0f, 4, false, ball.material(glm::vec3(0.0f)));
    ball.camera({0.1f, 0.2f, 0.05f}, {0, 0, -1}, 2.6f);
    EXPECT_EQ(leak(ball, 256, 64), 0.0);
    // A ball whose vertices the camera's rays hit: from its middle towards vertices along the axes.
    SceneBuilder box;
    const int black = box.material(glm::vec3(0.0f));
    box.room({-1, -1, -1}, {1, 1, 1}, {black, black, black, black, black, black});
    box.camera({0, 0, 0}, {0, 0, -1}, 1.5707964f);
    EXPECT_EQ(leak(box, 256, 64), 0.0);
    // A sheet of squares with corners at pixel centres and edges along rows and columns, seen from straight
    // above in parallel: every ray through a pixel centre meets an edge or a corner.
    SceneBuilder sheet;
    std::vector<glm::vec3> corners;
    constexpr int n = 33;
    for (int y = -1; y < n; ++y)
        for (int x = -1; x < n; ++x) {
            const auto p = [&](int i, int j) {
                return glm::vec3(float(i) + 0.5f, float(j) + 0.5f, 0.25f * float((i * 7 + j * 3) % 5));
            };
            for (const glm::vec3& c :
                 {p(x, y), p(x + 1, y), p(x + 1, y + 1), p(x, y), p(x + 1, y + 1), p(x, y + 1)})
                corners.push_back(c);
        }
    sheet.triangles(corners, sheet.material(glm::vec3(0.0f)));
    sheet.camera({16, 16, 10}, {16, 16, 0}, 1);
    sheet.scene.cameras[0].perspective = false;
    sheet.scene.cameras[0].ymag = 16;
    const Traced image = trace(sheet.scene, options(32), 1);
    EXPECT_EQ(std::ranges::count(image.hits.triangle, -1), 0);
    EXPECT_EQ(leak(sheet, 32, 256), 0.0);
}

}  // namespace
}  // namespace helio::test
