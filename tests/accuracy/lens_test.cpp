// Thin lenses and exposure: rows C1, C2, C5, C6 and C7, on the device and in double, against published
// figures and definitions.
#include "engine/core/shared.hpp"
#include "tests/support/shader_harness.hpp"

#include <heliograph/camera.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace helio::test {
namespace {

constexpr const char* kLens = "shaders/shared/lens.glsl";

/** One value of an expression on the device. */
float onDevice(const std::string& expression) {
    return runOnDevice<float>(
        {"#include \"shaders/shared/lens.glsl\"", "#include \"shaders/shared/projection.glsl\""}, expression,
        std::vector<float>{0})[0];
}

TEST(Lens, FieldsOfView) {
    const double degrees = 57.29577951308232L;
    EXPECT_NEAR(shared64::fieldOfView(36, 50) * degrees, 39.59775271L, 1e-7L);
    EXPECT_NEAR(shared64::fieldOfView(24, 50) * degrees, 26.99146656L, 1e-7L);
    EXPECT_NEAR(shared64::fieldOfView(std::hypot(36.L, 24.L), 50) * degrees, 46.79300334L, 1e-7L);
    EXPECT_NEAR(double(onDevice("degrees(fieldOfView(36.0, 50.0))")), 39.59775271L, 4e-5L);
    EXPECT_NEAR(double(onDevice("degrees(fieldOfView(24.0, 50.0))")), 26.99146656L, 3e-5L);
}

TEST(Lens, ImagesAndMagnification) {
    // 1/f = 1/zi + 1/zo; an object at 2 f is imaged at its own size.
    for (const double f : {0.001, 0.05, 50.0, 1e6})
        for (const double ratio : {1.001, 1.5, 2.0, 20.0, 1e9}) {
            const double object = f * ratio, image = shared64::imageDistance(f, object);
            EXPECT_NEAR(f / image + f / object, 1.0L, 1e-12L);
            EXPECT_NEAR(shared64::lensMagnification(f, object) * object / image, -1.0L, 1e-9L);
            EXPECT_NEAR(shared64::focalLengthFor(image, object) / f, 1.0L, 1e-12L);
        }
    EXPECT_NEAR(shared64::lensMagnification(50, 100), -1.0L, 1e-15L);
    const UlpReport report = compareOnDevice<float>(
        kLens, "imageDistance(a, b)", [](double f, double z) { return f * z / (z - f); },
        std::vector<float>{50, 50, 35, 85}, std::vector<float>{1000, 2000, 700, 1e7f});
    EXPECT_LE(report.worst, 3) << report;
}

TEST(Lens, CirclesOfConfusion) {
    // 50 mm at f/2 focused at 1 m, object at 2 m.
    const double published = 0.6578947368L;
    EXPECT_NEAR(shared64::circleOfConfusion(25, 50, 1000, 2000), published, 1e-10L);
    EXPECT_NEAR(double(onDevice("circleOfConfusion(25.0, 50.0, 1000.0, 2000.0)")), published, 2e-7L);
    EXPECT_EQ(shared64::circleOfConfusion(25, 50, 1000, 1000), 0);  // sharp
    // By its definition, and zero at the focus to the last bit for any focus.
    for (const double focus : {60.0, 999.0, 12345.6})
        for (const double object : {55.0, 100.0, 1e4, 1e8}) {
            const double zs = shared64::imageDistance(50, focus), zi = shared64::imageDistance(50, object);
            EXPECT_NEAR(shared64::circleOfConfusion(25, 50, focus, object) / (25 * std::abs(zs - zi) / zi),
                        1.0L, 1e-6L);
            EXPECT_EQ(shared64::circleOfConfusion(25, 50, focus, focus), 0);
        }
}

TEST(Lens, DepthOfField) {
    const double h = shared64::hyperfocalDistance(50, 8, 0.03L);
    EXPECT_NEAR(h, 10466.6666667L, 1e-6L);
    EXPECT_NEAR(shared64::depthOfFieldNear(50, h, 5000), 3389.3709L, 1e-4L);
    EXPECT_NEAR(shared64::depthOfFieldFar(50, h, 5000), 9527.4390L, 1e-4L);
    EXPECT_NEAR(double(onDevice("hyperfocalDistance(50.0, 8.0, 0.03)")), 10466.6667L, 1e-2L);
    EXPECT_NEAR(double(onDevice("depthOfFieldNear(50.0, hyperfocalDistance(50.0, 8.0, 0.03), 5000.0)")),
                3389.3709L, 3e-3L);
    EXPECT_NEAR(double(onDevice("depthOfFieldFar(50.0, hyperfocalDistance(50.0, 8.0, 0.03), 5000.0)")),
                9527.4390L, 1e-2L);
    // At both ends the blur is the circle that was asked for; from the hyperfocal distance on there is no far
    // end.
    for (const double at : {shared64::depthOfFieldNear(50, h, 5000), shared64::depthOfFieldFar(50, h, 5000)})
        EXPECT_NEAR(shared64::circleOfConfusion(50.0 / 8, 50, 5000, at), 0.03L, 1e-9L);
    EXPECT_TRUE(std::isinf(shared64::depthOfFieldFar(50, h, h)));
    EXPECT_NEAR(shared64::depthOfFieldNear(50, h, h), h / 2, 1e-9L);
}

TEST(Lens, Exposure) {
    EXPECT_NEAR(shared64::exposureValue100(16, 0.01L, 100), 14.64385619L, 1e-8L);
    EXPECT_NEAR(exposureValue({16, 0.01L, 100}), 14.64385619L, 1e-6L);
    EXPECT_NEAR(double(onDevice("exposureValue100(16.0, 0.01, 100.0)")), 14.64385619L, 2e-6L);
    // H = E t: double the time, double the exposure; sqrt(2) in the f-number halves it.
    const auto exposure = [](double n, double t) {
        return shared64::photographicExposure(shared64::imageIrradiance(1, n), t);
    };
    EXPECT_NEAR(exposure(8, 0.02L) / exposure(8, 0.01L), 2.0L, 1e-12L);
    EXPECT_NEAR(exposure(8 * std::sqrt(2.0L), 0.01L) / exposure(8, 0.01L), 0.5L, 1e-12L);
    EXPECT_NEAR(exposure(1, 1), 0.785398163397448L, 1e-15L);
    // Reciprocity: along a line of equal EV the exposure is the same, and so is what is displayed.
    for (int stop = 0; stop < 10; ++stop) {
        const double n = std::exp2(0.5L * stop), t = 0.001L * std::exp2(double(stop));
        EXPECT_NEAR(exposure(n, t) / exposure(1, 0.001L), 1.0L, 1e-12L);
        EXPECT_NEAR(exposureStops({float(n), float(t), 100}), exposureStops({1, 0.001L, 100}), 1e-6L);
    }
    // Twice the speed is one stop; EV 0 shows 1.2 cd/m^2 as white.
    EXPECT_NEAR(exposureStops({8, 0.01L, 200}) - exposureStops({8, 0.01L, 100}), 1.0L, 1e-9L);
    EXPECT_NEAR(std::exp2(-exposureStops({1, 1, 100})), 1.2L, 1e-9L);
}

TEST(Lens, AperturesAreFilledEvenly) {
    // Moments of uniform points: per axis 1/4 R^2 for a disc and R^2 (2 + cos(2 pi / n)) / 12 for a polygon.
    const int side = 512;
    std::vector<glm::vec2> u;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            u.emplace_back((float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side));
    for (const int blades : {0, 3, 5, 6, 9}) {
        const float rotation = 0.3f;
        const auto points =
            runOnDevice<glm::vec2>(kLens, fmt::format("apertureSample(a, {}, {})", blades, rotation), u);
        glm::dvec2 mean(0.0), squares(0.0);
        double cross = 0, farthest = 0;
        for (const glm::dvec2 p : points) {
            mean += p;
            squares += p * p;
            cross += p.x * p.y;
            farthest = std::max(farthest, glm::length(p));
        }
        const double n = double(points.size()), turn = 6.283185307179586L / double(blades);
        const double wanted = blades == 0 ? 0.25L : (2 + std::cos(turn)) / 12;
        fmt::print("{} blades: second moments {:.6f} {:.6f}, truth {:.6f}\n", blades, squares.x / n,
                   squares.y / n, wanted);
        EXPECT_NEAR(squares.x / n, wanted, 2e-5L);
        EXPECT_NEAR(squares.y / n, wanted, 2e-5L);
        EXPECT_NEAR(cross / n, 0, 2e-5L);
        EXPECT_NEAR(glm::length(mean) / n, 0, 2e-5L);
        EXPECT_LE(farthest, 1 + 1e-6L);
        if (blades == 0) continue;
        // Within all sides, and near one corner that lies at `rotation`.
        double nearest = 2;
        for (const glm::dvec2 p : points) {
            for (int k = 0; k < blades; ++k) {
                const double a = rotation + turn * (k + 0.5L);
                ASSERT_LE(p.x * std::cos(a) + p.y * std::sin(a), std::cos(turn / 2) + 1e-6L);
            }
            nearest = std::min(nearest, glm::length(p - glm::dvec2(std::cos(rotation), std::sin(rotation))));
        }
        EXPECT_LT(nearest, 0.01L);
    }
}

}  // namespace
}  // namespace helio::test
