// Direct light against closed forms (truths 1.1), and the cube's table of global illumination (1.4).
#include "passes/scene/packed_scene.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

void expectMean(const Traced& image, double truth, const std::string& what) {
    const Estimate e = estimate(image, 0, [](std::size_t) { return true; });
    const double z = (e.mean - truth) / e.error;
    fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", what, e.mean, e.error, truth, z);
    EXPECT_LT(std::abs(z), 4.0) << what;
    EXPECT_LT(e.error, 0.002 * truth) << what;
}

/** Looks at a small white patch at the origin that faces +z; what it shows is irradiance over pi. */
void addReceiver(SceneBuilder& b, const glm::vec3& eye) {
    constexpr float half = 1e-3f;
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.camera(eye, {0, 0, 0}, 2e-5f, {0, 0, 1});
}

TEST(PathIrradiance, UnderARectangle) {
    for (double side : {1.0, 2.0}) {
        SceneBuilder b;
        addReceiver(b, {3, 0.5f, 0.4f});
        const float h = float(side / 2);
        b.quad({-h, -h, 1}, {-h, h, 1}, {h, h, 1}, {h, -h, 1}, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
        const double truth = side == 1.0 ? 0.752274688454 : 1.740839502730;
        expectMean(trace(b.scene, independentOptions(16, 1), 512), truth / kPi,
                   fmt::format("square {}", side));
    }
}

TEST(PathIrradiance, UnderADisk) {
    SceneBuilder b;
    addReceiver(b, {3, 0.5f, 0.4f});
    // A polygon of 720 corners has 1.3e-5 less area than its circle.
    constexpr int n = 720;
    std::vector<glm::vec3> corners;
    const auto rim = [](int i) {
        return glm::vec3(float(std::cos(2 * kPi * i / n)), float(std::sin(2 * kPi * i / n)), 2.0f);
    };
    for (int i = 0; i < n; ++i)
        for (const glm::vec3& p : {glm::vec3(0, 0, 2), rim(i + 1), rim(i)}) corners.push_back(p);
    b.triangles(corners, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    expectMean(trace(b.scene, independentOptions(16, 1), 512), 0.628318530718 / kPi, "disk");
}

TEST(PathIrradiance, UnderASphere) {
    struct Case {
        double angle, truth, distance;
    };
    // The third sphere's centre lies on the horizon.
    for (const Case& c :
         {Case{0.0, 0.349065850, 3}, Case{kPi / 3, 0.174532925, 3}, Case{kPi / 2, 0.090586073706, 2}}) {
        SceneBuilder b;
        addReceiver(b, {-3, 0.5f, 0.4f});
        const glm::vec3 centre(float(c.distance * std::sin(c.angle)), 0,
                               float(c.distance * std::cos(c.angle)));
        b.sphere(centre, 1.0f, 5, false, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
        expectMean(trace(b.scene, independentOptions(16, 1), c.angle > 1.5 ? 12288 : 4096, 512),
                   c.truth / kPi, fmt::format("sphere at {:.0f} degrees", c.angle * 180 / kPi));
    }
}

/** Lambert's formula: the irradiance at the origin, facing +z, from a polygon above the horizon of
 * radiance 1. */
double lambertIrradiance(const std::vector<glm::vec3>& corners) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(glm::dvec3(corners[i]));
        const glm::dvec3 b = glm::normalize(glm::dvec3(corners[(i + 1) % corners.size()]));
        const glm::dvec3 across = glm::cross(a, b);
        sum += glm::normalize(across) * std::atan2(glm::length(across), glm::dot(a, b));
    }
    return 0.5 * std::abs(sum.z);
}

TEST(PathIrradiance, BesideLargeLampsBySolidAngle) {
    // Fronts face the origin. Quadrangles are rectangles, and none hides another.
    const std::vector<glm::vec3> ceiling = {{-2, -1, 0.25f}, {-2, 3, 0.25f}, {2, 3, 0.25f}, {2, -1, 0.25f}};
    const std::vector<glm::vec3> screen = {
        {-0.25f, -0.75f, 0.0625f}, {-0.25f, 0.5f, 0.0625f}, {-0.25f, 0.5f, 1.0f}, {-0.25f, -0.75f, 1.0f}};
    const std::vector<glm::vec3> strip = {
        {-3, 0.25f, 0.125f}, {2, 0.25f, 0.125f}, {2, 0.25f, 0.25f}, {-3, 0.25f, 0.25f}};
    const std::vector<glm::vec3> bar = {
        {-0.125f, 0.5f, 0.125f}, {0.25f, 0.5f, 0.125f}, {0.25f, 0.5f, 1}, {-0.125f, 0.5f, 1}};
    const std::vector<glm::vec3> sail = {{0.5f, -1, 0.125f}, {0.25f, 0, 1.5f}, {0.75f, 1.25f, 0.0625f}};
    struct Case {
        std::vector<std::vector<glm::vec3>> lamps;
        std::uint32_t solidAngles;
    };
    for (const Case& c : {Case{{ceiling}, 1}, Case{{screen}, 1}, Case{{strip}, 1}, Case{{sail}, 2},
                          Case{{screen, bar}, 1}, Case{{screen, sail, bar}, 3}}) {
        SceneBuilder b;
        addReceiver(b, {-0.05f, -1, 0.2f});
        double truth = 0;
        for (const std::vector<glm::vec3>& lamp : c.lamps) {
            const int glow = b.material(glm::vec3(0), glm::vec3(1), true);
            if (lamp.size() == 4)
                b.quad(lamp[0], lamp[1], lamp[2], lamp[3], glow);
            else
                b.triangles(lamp, glow);
            truth += lambertIrradiance(lamp);
        }
        PathTraceOptions options = independentOptions(16, 1);
        options.lights = LightChoice::Adaptive;
        EXPECT_EQ(packScene(b.scene, PathTracer::packOptions(b.scene, options)).solidAngles, c.solidAngles);
        expectMean(trace(b.scene, options, 1024), truth / kPi, fmt::format("{} large lamps", c.lamps.size()));
    }
}

TEST(PathIrradiance, SmallLampsAreNotSampledBySolidAngle) {
    const Scene scene = load("sample:cornell");
    EXPECT_EQ(packScene(scene, PathTracer::packOptions(scene, {})).solidAngles, 0u);
}

/** The unit cube whose floor (z = 0) emits and reflects nothing; the rest reflects half. */
SceneBuilder cube() {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.5f)), floor = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
    b.room({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, floor, wall});
    return b;
}

TEST(PathIrradiance, CubeTable) {
    struct Case {
        glm::vec3 point;
        double truth;
    };
    // Walls are at x = 0: the table's (y, z).
    const std::array<Case, 7> cases = {{{{0.5f, 0.5f, 0}, 1.0},
                                        {{0.5f, 0.5f, 1}, 0.179144},
                                        {{0.25f, 0.25f, 1}, 0.160907},
                                        {{0.5f, 0.1f, 1}, 0.155695},
                                        {{0, 0.5f, 0.5f}, 0.161214},
                                        {{0, 0.25f, 0.25f}, 0.209193},
                                        {{0, 0.5f, 0.1f}, 0.264785}}};
    for (const Case& c : cases) {
        SceneBuilder b = cube();
        b.camera({0.6f, 0.45f, 0.55f}, c.point, 2e-3f, {0.1f, 0.9f, 0.2f});
        const Traced image = trace(b.scene, independentOptions(16), 2048, 512);
        const std::string what = fmt::format("cube at ({}, {}, {})", c.point.x, c.point.y, c.point.z);
        if (c.truth == 1.0) {
            for (const glm::dvec3& value : image.mean) EXPECT_EQ(value.x, 1.0);
        } else {
            expectMean(image, c.truth, what);
        }
    }
}

TEST(PathIrradiance, CubeMeans) {
    struct Case {
        glm::vec3 eye, target;
        double truth;
    };
    for (const Case& c : {Case{{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 1}, 0.15518},
                          Case{{0.5f, 0.5f, 0.5f}, {0, 0.5f, 0.5f}, 0.16400}}) {
        SceneBuilder b = cube();
        b.camera(c.eye, c.target, 1, {0, 1, 0});
        b.scene.cameras[0].perspective = false;  // parallel rays over the whole face
        b.scene.cameras[0].ymag = 0.5f;
        expectMean(trace(b.scene, independentOptions(32), 512), c.truth, "cube face");
    }
}

}  // namespace
}  // namespace helio::test
