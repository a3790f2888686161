// Radiosity on the device: closed forms, the cube's table, elimination against iteration, and path tracing.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>
#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace helio::test {
namespace {

RenderResult solve(const Scene& scene, std::uint32_t size, std::uint32_t patches, std::uint32_t samples = 4) {
    RenderOptions o;
    o.size = {size, size};
    o.samples = samples;
    o.integrator = Integrator::Radiosity;
    o.radiosityPatches = patches;
    RenderResult result = renderer().render(scene, o);
    EXPECT_TRUE(result.radiosity && result.radiosity->converged);
    EXPECT_EQ(result.nanCount, 0u);
    return result;
}

double mean(const RenderResult& result, std::size_t channel = 0) {
    double sum = 0;
    for (std::uint32_t y = 0; y < result.image.height; ++y)
        for (std::uint32_t x = 0; x < result.image.width; ++x) sum += double(result.image.at(x, y, channel));
    return sum / result.image.width / result.image.height;
}

/** A closed room whose walls emit 1: radiance 1 / (1 - albedo) everywhere, whatever the patches. */
TEST(Radiosity, FurnaceIsExact) {
    for (const float albedo : {0.2f, 0.8f, 0.9f}) {
        SceneBuilder b;
        const int wall = b.material(glm::vec3(albedo), glm::vec3(1.0f));
        b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
        b.camera({0.1f, 0.2f, 0.3f}, {0.4f, 0.1f, -1}, 1.2f);
        const RenderResult result = solve(b.scene, 24, 100);
        const double truth = verify::furnaceRadiance(1.0, double(albedo));
        double worst = 0;
        for (std::uint32_t y = 0; y < 24; ++y)
            for (std::uint32_t x = 0; x < 24; ++x)
                worst = std::max(worst, std::abs(double(result.image.at(x, y, 0)) - truth) / truth);
        fmt::print("albedo {}: worst error {:.2e}, {} of {} sides lit, dense {:.1e}\n", albedo, worst,
                   result.radiosity->unknowns, 2 * result.radiosity->patches,
                   result.radiosity->denseDifference.value_or(-1));
        EXPECT_LT(worst, 2e-5);
        EXPECT_EQ(result.radiosity->unknowns, result.radiosity->patches);  // only the insides
        EXPECT_LT(result.radiosity->denseDifference.value_or(1), 1e-6);
    }
}

/** The unit cube of the truths: the floor emits 1 and reflects nothing, all else reflects half. +z is up
 * there. */
Scene cube(const glm::vec3& at, const glm::vec3& normal, float span) {
    SceneBuilder b;
    const int half = b.material(glm::vec3(0.5f)), floor = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
    b.room({0, 0, 0}, {1, 1, 1}, {half, half, half, half, floor, half});
    b.camera(at + 0.5f * normal, at, 1.0f,
             glm::abs(normal.y) > 0.5f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0));
    b.scene.cameras[0].perspective = false;
    b.scene.cameras[0].ymag = 0.5f * span;
    return b.scene;
}

/** Values at points and means over faces (truths 1.4, errors up to 1e-5). Patches of constant radiance err by
 * their size squared, as a sequence of sizes shows. */
TEST(Radiosity, CubeOfTheTable) {
    struct Point {
        const char* name;
        glm::vec3 at, normal;
        double truth;
    };
    const std::vector<Point> points = {{"ceiling middle", {0.5f, 0.5f, 1}, {0, 0, -1}, 0.179144},
                                       {"ceiling (.25, .25)", {0.25f, 0.25f, 1}, {0, 0, -1}, 0.160907},
                                       {"wall (.25, .25)", {1, 0.25f, 0.25f}, {-1, 0, 0}, 0.209193},
                                       {"wall (.5, .1)", {1, 0.5f, 0.1f}, {-1, 0, 0}, 0.264785}};
    for (const Point& p : points) {
        const double value = mean(solve(cube(p.at, p.normal, 0.02f), 4, 432));
        fmt::print("{}: {:.6f}, truth {:.6f}, {:+.5f}\n", p.name, value, p.truth, value - p.truth);
        EXPECT_NEAR(value, p.truth, 1.2e-3) << p.name;
    }
}

/** Dense = iterative = path tracing on one scene, to 1e-4: mean radiance of the ceiling and a wall. What
 * patches leave at two sizes, four times as many at half the size, tells the limit. */
TEST(Radiosity, EqualsPathTracing) {
    for (const bool ceiling : {true, false}) {
        const glm::vec3 at = ceiling ? glm::vec3(0.5f, 0.5f, 1) : glm::vec3(1, 0.5f, 0.5f),
                        normal = ceiling ? glm::vec3(0, 0, -1) : glm::vec3(-1, 0, 0);
        const Scene scene = cube(at, normal, 1.0f);
        const double coarse = mean(solve(scene, 32, 192));
        const RenderResult fine = solve(scene, 32, 768);
        EXPECT_LT(fine.radiosity->denseDifference.value_or(1), 1e-6);
        const double limit = (4 * mean(fine) - coarse) / 3;
        RenderOptions o;
        o.size = {32, 32};
        o.samples = 2048;
        const RenderResult traced = renderer().render(scene, o);
        double variance = 0;
        const auto c = std::size_t(traced.image.channel("variance.R"));
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 32; ++x) variance += double(traced.image.at(x, y, c));
        const double error = std::sqrt(variance) / 1024, truth = ceiling ? 0.15518 : 0.16400;
        fmt::print("{}: {:.6f} -> {:.6f} -> {:.6f}; paths {:.6f} +- {:.6f}; table {}\n",
                   ceiling ? "ceiling" : "wall", coarse, mean(fine), limit, mean(traced), error, truth);
        EXPECT_LT(error, 5e-5);
        EXPECT_NEAR(limit, mean(traced), 1e-4);
        EXPECT_NEAR(limit, truth, 1e-4);
        EXPECT_NEAR(mean(fine), truth, 5e-4);
    }
}

/** Shadows and colours: light that patches hide from each other, over whole faces and where the blocks stand.
 */
TEST(Radiosity, CornellBoxWithItsShadows) {
    const Scene scene = load("sample:cornell");
    const RenderResult solved = solve(scene, 32, 512, 256);
    RenderOptions o;
    o.size = {32, 32};
    o.samples = 256;
    const RenderResult traced = renderer().render(scene, o);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean(solved, c), mean(traced, c), 0.01 * mean(traced, c)) << c;
        // Quarters of the picture: red and green walls, the lamp's half, the blocks' half.
        for (const auto& [x0, y0] : {std::pair{0u, 0u}, {16u, 0u}, {0u, 16u}, {16u, 16u}}) {
            double a = 0, b = 0;
            for (std::uint32_t y = y0; y < y0 + 16; ++y)
                for (std::uint32_t x = x0; x < x0 + 16; ++x) {
                    a += double(solved.image.at(x, y, c));
                    b += double(traced.image.at(x, y, c));
                }
            fmt::print("channel {} quarter ({}, {}): {:.4f}, paths {:.4f}\n", c, x0, y0, a / 256, b / 256);
            EXPECT_NEAR(a, b, 0.02 * b) << c << " " << x0 << " " << y0;
        }
    }
}

/** A floor beside a long wall under a sky of 1, both black but for the floor: it sees 1 - F of the sky. */
TEST(Radiosity, TheSkyBesideAWall) {
    SceneBuilder b;
    b.quad({-1e-3f, 0, 1e-3f}, {1e-3f, 0, 1e-3f}, {1e-3f, 0, -1e-3f}, {-1e-3f, 0, -1e-3f},
           b.material(glm::vec3(0.6f)));
    b.quad({1, 0, -500}, {1, 0, 500}, {1, 2, 500}, {1, 2, -500}, b.material(glm::vec3(0.0f)));
    b.camera({-2, 1.5f, 0.3f}, {0, 0, 0}, 2e-5f);
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    const double truth = 0.6 * (1 - verify::formFactorInfiniteWall(1.0, 2.0));
    const double value = mean(solve(b.scene, 4, 64));
    fmt::print("floor {:.6f}, truth {:.6f}\n", value, truth);
    EXPECT_NEAR(value, truth, 2e-4 * truth);
}

/** A patch that faces up over a square light that faces it from below: its back has the light, its front
 * none. */
TEST(Radiosity, BothSidesOfAPatch) {
    for (const float side : {-1.0f, 1.0f}) {
        SceneBuilder b;
        constexpr float half = 1e-3f;
        b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
               b.material(glm::vec3(0.8f)));
        b.quad({-0.5f, -0.5f, -1}, {0.5f, -0.5f, -1}, {0.5f, 0.5f, -1}, {-0.5f, 0.5f, -1},
               b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
        b.camera({0.4f, 0.1f, 0.5f * side}, {0, 0, 0}, 2e-5f, {0, 0, 1});
        const double truth = side < 0 ? 0.8 * 0.752274688454 / 3.14159265358979 : 0.0;
        const double value = mean(solve(b.scene, 4, 64));
        fmt::print("side {}: {:.7f}, truth {:.7f}\n", side, value, truth);
        EXPECT_NEAR(value, truth, 2e-6);
    }
}

TEST(Radiosity, WhatItCannotSolveIsRefused) {
    const auto refused = [](
                             const Scene& scene, const std::string& what,
                             const std::function<void(RenderOptions&)>& set = [](RenderOptions&) {}) {
        RenderOptions o;
        o.size = {8, 8};
        o.integrator = Integrator::Radiosity;
        set(o);
        try {
            renderer().render(scene, o);
            ADD_FAILURE() << what;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    refused(load("sample:plates"), "not Lambertian");
    SceneBuilder b;
    b.sphere({0, 0, 0}, 1, 4, true, b.material(glm::vec3(0.5f), glm::vec3(1.0f)));
    refused(b.scene, "5120 triangles");
    SceneBuilder lit;
    lit.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, lit.material(glm::vec3(0.5f)));
    lit.pointLight({0, 0, 1}, glm::vec3(1.0f));
    refused(lit.scene, "punctual lights");
    refused(load("sample:cornell"), "give 1 to 2048", [](RenderOptions& o) { o.radiosityPatches = 2049; });
    refused(load("sample:cornell"), "leave them out", [](RenderOptions& o) { o.maxDepth = 1; });
    // Nothing to cut: black, or the sky.
    SceneBuilder empty;
    empty.camera({0, 0, 1}, {0, 0, 0}, 1);
    empty.scene.environment = Environment{glm::vec3(2.0f), -1};
    EXPECT_EQ(mean(solve(empty.scene, 4, 16)), 2.0);
}

}  // namespace
}  // namespace helio::test
