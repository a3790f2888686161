// Closed rooms whose radiance is known exactly: truths 1.2.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

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
        expectRadiance(trace(furnace(0.8f, 1.0f), o, 128), verify::furnaceRadiance(1.0, double(0.8f), int(depth)),
                       fmt::format("depth {}", depth));
    }
}

}  // namespace
}  // namespace helio::test
