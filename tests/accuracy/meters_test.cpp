// Meters of radiance, irradiance, intensity and flux, by closed forms.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/photometry.hpp>
#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

using Quantity = Meter::Quantity;

/** Adds a meter at `place` that faces along `direction`. */
void addMeter(Scene& scene, Quantity quantity, const glm::dvec3& place, const glm::dvec3& direction,
              float width = 1, float height = 1) {
    const glm::dvec3 back = -glm::normalize(direction);
    const glm::dvec3 right =
        glm::normalize(glm::cross(std::abs(back.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), back));
    Node node;
    // The node's scale does not count.
    node.matrix =
        glm::mat4(glm::dmat4(glm::dvec4(3.0 * right, 0), glm::dvec4(3.0 * glm::cross(back, right), 0),
                             glm::dvec4(3.0 * back, 0), glm::dvec4(place, 1)));
    node.meter = int(scene.meters.size());
    scene.meters.push_back({fmt::format("meter {}", node.meter), quantity, width, height});
    scene.roots.push_back(int(scene.nodes.size()));
    scene.nodes.push_back(node);
}

std::vector<MeterReading> read(
    Scene scene, std::uint32_t samples = 64,
    const std::function<void(RenderOptions&)>& set = [](RenderOptions&) {}) {
    if (scene.cameras.empty()) {
        scene.cameras.emplace_back();
        scene.roots.push_back(int(scene.nodes.size()));
        scene.nodes.emplace_back().camera = 0;
    }
    RenderOptions o;
    o.size = {8, 8};
    o.samples = samples;
    set(o);
    RenderResult result = renderer().render(scene, o);
    EXPECT_EQ(result.meters.size(), scene.meters.size());
    return std::move(result.meters);
}

void expectReading(const MeterReading& reading, double truth, double tolerance) {
    const double error = std::max(reading.error[0], 1e-6 * truth), z = (reading.value[0] - truth) / error;
    fmt::print("{} {}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", reading.name, reading.quantityName(),
               reading.value[0], reading.error[0], truth, z);
    EXPECT_LT(std::abs(z), 4.0) << reading.name;
    EXPECT_LE(reading.error[0], tolerance * truth) << reading.name;
}

/** A square light of side a about (0, 0, h) that faces down and gives off radiance 1. */
SceneBuilder squareLight(float a, float h) {
    SceneBuilder b;
    const float s = 0.5f * a;
    b.quad({-s, -s, h}, {-s, s, h}, {s, s, h}, {s, -s, h}, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    return b;
}

TEST(Meters, IrradianceOfASquareLightWithAndWithoutLightSampling) {
    for (const auto& [side, truth] : {std::pair{1.0f, 0.752274688454}, {2.0f, 1.740839502730}})
        for (const bool nextEvent : {true, false}) {
            SceneBuilder b = squareLight(side, 1);
            addMeter(b.scene, Quantity::Irradiance, {0, 0, 0}, {0, 0, 1});
            // Tilted away by 120 degrees nothing is before it; by 60 half of that on the axis comes from far
            // away.
            addMeter(b.scene, Quantity::Irradiance, {0, 0, 0}, {0, 0, -1});
            const auto readings =
                read(b.scene, 256, [&](RenderOptions& o) { o.nextEventEstimation = nextEvent; });
            expectReading(readings[0], truth, 0.003);
            EXPECT_EQ(readings[1].value[0], 0.0);
        }
}

TEST(Meters, IrradianceOfPointLightsAndTheSky) {
    SceneBuilder b;
    b.pointLight({0, 0, 2}, glm::vec3(5.0f));
    // I cos / r^2: straight below, and aside at 45 degrees.
    addMeter(b.scene, Quantity::Irradiance, {0, 0, 0}, {0, 0, 1});
    addMeter(b.scene, Quantity::Irradiance, {2, 0, 0}, {0, 0, 1});
    const auto readings = read(b.scene, 4);
    expectReading(readings[0], 5.0 / 4, 1e-9);
    expectReading(readings[1], 5.0 / 8 * std::sqrt(0.5), 1e-9);
    SceneBuilder sky;
    sky.scene.environment = Environment{glm::vec3(1.0f, 2.0f, 3.0f), -1};
    addMeter(sky.scene, Quantity::Irradiance, {0, 0, 0}, {1, 2, 3});
    const auto under = read(sky.scene, 4);
    expectReading(under[0], std::numbers::pi, 1e-7);
    EXPECT_NEAR(under[0].value[2], 3 * std::numbers::pi, 1e-5);
    // Photometry: 683 lm/W and the luminance of the three.
    EXPECT_NEAR(under[0].photometric, 683 * std::numbers::pi * (0.212639 + 2 * 0.715169 + 3 * 0.072192),
                1e-4 * 683 * 6);
    EXPECT_EQ(under[0].photometricUnit(), "lx");
}

/** All that a light gives off arrives on the faces of a box around it: 4 pi I of a point, pi A L of a
 * Lambertian square (whose back is dark). */
TEST(Meters, FluxThroughABoxIsThePower) {
    for (const bool point : {true, false}) {
        SceneBuilder b = point ? SceneBuilder() : squareLight(1, 0);
        if (point) b.pointLight({0.2f, 0.1f, -0.3f}, glm::vec3(2.0f));
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                glm::dvec3 place(0.0);
                place[axis] = side;
                addMeter(b.scene, Quantity::Flux, place, -place, 2, 2);
            }
        const double truth = point ? 4 * std::numbers::pi * 2 : std::numbers::pi;
        double sum = 0, variance = 0;
        for (const MeterReading& reading : read(b.scene, 128)) {
            sum += reading.value[0];
            variance += reading.error[0] * reading.error[0];
        }
        const double z = (sum - truth) / std::sqrt(variance);
        fmt::print("flux {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", sum, std::sqrt(variance), truth, z);
        EXPECT_LT(std::abs(z), 4.0);
        EXPECT_LT(std::sqrt(variance), 0.003 * truth);
    }
}

/** A Lambertian square gives off L A cos(theta) = flux / pi cos(theta); its radiance is L from everywhere
 * before it. */
TEST(Meters, IntensityAndRadianceOfALambertianSquare) {
    for (const double degrees : {0.0, 60.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const glm::dvec3 towards(std::sin(angle), 0, -std::cos(angle));
        SceneBuilder b = squareLight(1, 0);
        addMeter(b.scene, Quantity::Intensity, 3.0 * towards, -towards, 2, 2);
        addMeter(b.scene, Quantity::Radiance, 3.0 * towards, -towards);
        const auto readings = read(b.scene, 256);
        expectReading(readings[0], std::cos(angle), 0.003);
        expectReading(readings[1], 1.0, 1e-9);
        EXPECT_EQ(readings[0].unit(), "W/sr");
    }
}

/** Radiance over the square of the refractive index is what refraction keeps: within lossless glass under a
 * sky of 1, from where every ray comes out in the end, it is n^2. */
TEST(Meters, BasicRadianceInGlass) {
    SceneBuilder b;
    Material glass;
    glass.scattering = Scattering{.model = Scattering::Model::Dielectric};
    b.scene.materials.push_back(glass);
    b.sphere({0, 0, 0}, 1, 2, false, int(b.scene.materials.size()) - 1);
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    addMeter(b.scene, Quantity::Radiance, {0.05, 0.02, 0.03}, {0.3, 0.2, 1});
    addMeter(b.scene, Quantity::Irradiance, {0.05, 0.02, 0.03}, {0.3, 0.2, 1});
    const auto readings = read(b.scene, 64);
    expectReading(readings[0], 2.25, 0.002);
    expectReading(readings[1], 2.25 * std::numbers::pi, 0.002);
}

/** In a furnace all light is alike: a meter on a wall reads pi times the radiance, and depths count as a
 * camera's do. */
TEST(Meters, OnAWallOfAFurnace) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
    b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
    addMeter(b.scene, Quantity::Irradiance, {-1, 0.3, 0.1}, {1, 0, 0});
    addMeter(b.scene, Quantity::Radiance, {-1, 0.3, 0.1}, {1, 0.5, 0.25});
    const auto all = read(b.scene, 256);
    expectReading(all[0], 2 * std::numbers::pi, 0.003);
    expectReading(all[1], 2, 0.005);
    const auto once = read(b.scene, 256, [](RenderOptions& o) { o.maxDepth = 1; });
    expectReading(once[0], 1.5 * std::numbers::pi, 0.003);
    expectReading(once[1], 1.5, 0.003);
    // Integrators that follow no paths of light say that they read none.
    b.scene.cameras.emplace_back();
    b.scene.roots.push_back(int(b.scene.nodes.size()));
    b.scene.nodes.emplace_back().camera = 0;
    RenderOptions o;
    o.size = {8, 8};
    o.integrator = Integrator::Radiosity;
    const RenderResult solved = renderer().render(b.scene, o);
    EXPECT_TRUE(solved.meters.empty());
    EXPECT_EQ(std::ranges::count(solved.skipped, "meters", [](const auto& s) { return s.first; }), 1);
}

}  // namespace
}  // namespace helio::test
