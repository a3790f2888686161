// Choice among many lights: whatever the choice, the same picture; chances that add up; few bytes for many
// lights.
#include "passes/scene/light_tables.hpp"
#include "passes/scene/packed_scene.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace helio::test {
namespace {

PathTraceOptions options(LightChoice lights) {
    PathTraceOptions o;
    o.size = {24, 24};
    o.sampler = SamplerKind::Independent;
    o.lights = lights;
    o.maxDepth = 3;
    return o;
}

/** A room with a ball under `count` small emitters of very uneven power, of all kinds. */
Scene manyLights(int count, bool others) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.6f, 0.5f, 0.7f));
    b.room({-2, 0, -2}, {2, 2, 2}, {wall, wall, wall, wall, wall, wall});
    b.sphere({0.3f, 0.6f, 0.0f}, 0.5f, 3, false, wall);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    std::vector<int> glow;
    for (float strength : {0.3f, 1.0f, 3.0f, 10.0f})
        glow.push_back(b.material(glm::vec3(0.2f), glm::vec3(strength, 0.7f * strength, 0.5f * strength) *
                                                       (400.0f / float(count))));
    const int both = b.material(glm::vec3(0.0f), glm::vec3(2.0f * 400.0f / float(count)), true);
    std::vector<std::vector<glm::vec3>> triangles(5);
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at(1.8f * u(random), 1.0f + 0.9f * u(random), 1.8f * u(random));
        const float size = 0.04f + 0.03f * u(random);
        for (int k = 0; k < 3; ++k)
            triangles[std::size_t(i % 5)].push_back(at + size * glm::vec3(u(random), u(random), u(random)));
    }
    for (std::size_t k = 0; k < 5; ++k) b.triangles(triangles[k], k == 4 ? both : glow[k]);
    if (others) {
        b.pointLight({1, 1.5f, 1}, glm::vec3(0.2f, 0.4f, 0.3f));
        Scene& scene = b.scene;
        PunctualLight spot, sun;
        spot.type = PunctualLight::Type::Spot;
        spot.intensity = glm::vec3(1.0f, 0.5f, 0.2f);
        sun.type = PunctualLight::Type::Directional;
        sun.intensity = glm::vec3(0.4f);
        scene.lights.push_back(spot);
        scene.lights.push_back(sun);
        for (int light : {1, 2}) {
            Node node;
            node.light = light;
            node.translation = {-1, 1.7f, 0.5f};
            node.rotation = glm::angleAxis(-1.3f, glm::vec3(1, 0, 0));
            scene.nodes.push_back(node);
            scene.roots.push_back(int(scene.nodes.size()) - 1);
        }
        // The room is closed but for its ceiling: the sky comes in.
        scene.roots.erase(scene.roots.begin() + 3);
        std::vector<float> texels;
        for (int i = 0; i < 8 * 4; ++i)
            for (float v : {0.3f + 0.1f * float(i % 7), 0.5f, i == 9 ? 20.0f : 0.6f, 1.0f})
                texels.push_back(v);
        scene.images.push_back({"sky", 8, 4, texels});
        scene.environment = Environment{glm::vec3(0.3f), 0};
    }
    b.camera({0.5f, 1.1f, 1.9f}, {0, 0.7f, -1}, 1.2f);
    return b.scene;
}

void expectSame(const Traced& a, const Traced& b, const std::string& what) {
    const auto all = [](std::size_t) { return true; };
    for (int c = 0; c < 3; ++c) {
        const Estimate x = estimate(a, c, all), y = estimate(b, c, all);
        const double z = (x.mean - y.mean) / std::hypot(x.error, y.error);
        fmt::print("{} channel {}: {:.5f} +- {:.5f} and {:.5f} +- {:.5f}, z {:+.2f}\n", what, c, x.mean,
                   x.error, y.mean, y.error, z);
        EXPECT_LT(std::abs(z), 4.0) << what;
        EXPECT_LT(x.error, 0.06 * x.mean) << what;
    }
    EXPECT_EQ(a.rejected + b.rejected, 0u);
}

TEST(PathLights, ChoiceDoesNotChangeThePicture) {
    const Scene scene = manyLights(60, true);
    const Traced adaptive = trace(scene, options(LightChoice::Adaptive), 256);
    expectSame(adaptive, trace(scene, options(LightChoice::Power), 512), "power");
    expectSame(adaptive, trace(scene, options(LightChoice::Uniform), 512), "uniform");
}

TEST(PathLights, RaysThatMeetLightsAgree) {
    const Scene scene = manyLights(60, false);
    PathTraceOptions chance = options(LightChoice::Adaptive);
    chance.nextEventEstimation = false;
    expectSame(trace(scene, options(LightChoice::Adaptive), 256), trace(scene, chance, 4096),
               "met by chance");
}

/** A frosted pane or ball with bright lamps on the viewer's side, as many dim ones behind it, which it shows.
 */
Scene frosted(bool ball) {
    SceneBuilder b;
    const int glass = b.material(glm::vec3(1.0f));
    Material& material = b.scene.materials[std::size_t(glass)];
    material.transmission = 1;
    material.roughness = 0.6f;
    material.thickness = ball ? 1.0f : 0.0f;
    material.specular = 1;
    if (ball)
        b.sphere({0, 0, 0}, 0.9f, 3, false, glass);
    else
        b.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, glass);
    const int bright = b.material(glm::vec3(0.0f), glm::vec3(40.0f), true);
    const int dim = b.material(glm::vec3(0.0f), glm::vec3(10.0f), true);
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k)
            for (const float z : {-1.6f, 1.6f}) {
                const glm::vec3 at(0.6f * (float(i) - 2.5f), 0.6f * (float(k) - 2.5f), z);
                b.quad(at, at + glm::vec3(0.03f, 0, 0), at + glm::vec3(0.03f, 0.03f, 0),
                       at + glm::vec3(0, 0.03f, 0), z < 0 ? dim : bright);
            }
    b.camera({0, 0, 1.5f}, {0, 0, 0}, 0.8f);
    return b.scene;
}

TEST(PathLights, LampsBehindFrostedGlassAreAsked) {
    for (const bool ball : {false, true}) {
        const Scene scene = frosted(ball);
        const Traced adaptive = trace(scene, options(LightChoice::Adaptive), 256),
                     power = trace(scene, options(LightChoice::Power), 1024);
        expectSame(adaptive, power, ball ? "ball" : "pane");
        const auto all = [](std::size_t) { return true; };
        // Of as many samples.
        const double gain = std::pow(estimate(power, 0, all).error / estimate(adaptive, 0, all).error, 2) * 4;
        fmt::print("{}: {:.2f} times the efficiency of a choice by power\n", ball ? "ball" : "pane", gain);
        EXPECT_GT(gain, ball ? 4 : 0.6);
    }
}

TEST(PathLights, CutsDoNotChangeThePicture) {
    const Scene scene = manyLights(1500, true);
    ASSERT_TRUE(packScene(scene, {.lights = LightChoice::Adaptive}).lightCuts);
    const Traced adaptive = trace(scene, options(LightChoice::Adaptive), 256);
    expectSame(adaptive, trace(scene, options(LightChoice::Power), 1024), "power");
    expectSame(adaptive, trace(scene, options(LightChoice::Uniform), 1024), "uniform");
}

/** Every table's chances add to 1 and every light has some, of cuts and of single lights. */
TEST(PathLights, EveryLightHasAChance) {
    for (int count : {3, 200, 1500}) {
        const PackedScene packed = packScene(manyLights(count, true), {.lights = LightChoice::Adaptive});
        const std::size_t slots = std::size_t(1) << packed.lightSlotBits;
        const std::size_t tables = packed.lightSlots.size() / slots;
        ASSERT_GT(tables, 20u);
        for (std::size_t t = 0; t < tables; ++t) {
            double sum = 0;
            std::size_t entries = 0;
            for (std::size_t i = 0; i < slots; ++i) {
                const float chance = glm::uintBitsToFloat(packed.lightSlots[t * slots + i].z);
                sum += double(chance);
                entries += chance > 0;
            }
            ASSERT_NEAR(sum, 1.0, 1e-6);
            if (!packed.lightCuts) {
                ASSERT_EQ(entries, packed.lightCount);
                continue;
            }
            // The entries' ranges cover all lights in order.
            const std::uint32_t* firsts = packed.lightRanges.data() + packed.lightCount + 1 + t * slots;
            ASSERT_EQ(firsts[0], 0u);
            for (std::size_t i = 0; i + 1 < slots; ++i) {
                ASSERT_LE(firsts[i], firsts[i + 1]);
                ASSERT_TRUE(i >= entries || firsts[i] < packed.lightCount);
            }
        }
        for (std::uint32_t cell : packed.lightCells) ASSERT_LT(cell, tables);
        for (std::size_t i = 0; i + 1 < packed.lightCount && packed.lightCuts; ++i)
            ASSERT_LT(packed.lightRanges[i], packed.lightRanges[i + 1]);
    }
}

TEST(PathLights, AHundredThousandStaySmall) {
    const Scene scene = manyLights(100000, true);
    const auto start = std::chrono::steady_clock::now();
    const PackedScene packed = packScene(scene, {.tree = false, .lights = LightChoice::Adaptive});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::size_t bytes = packed.lights.size() * 16 + packed.lightSlots.size() * 16 +
                              packed.lightCells.size() * 4 + packed.lightRanges.size() * 4 +
                              packed.lightOfTriangle.size() * 4;
    fmt::print("{} lights: {:.1f} MB, packed in {:.2f} s\n", packed.lightCount, double(bytes) * 1e-6,
               seconds);
    EXPECT_GE(packed.lightCount, 100000u);
    EXPECT_LT(bytes, 200'000'000u);
}

TEST(PathLights, NoTablesForFewLights) {
    SceneBuilder b;
    b.sphere({0, 0, 0}, 1.0f, 2, false, b.material(glm::vec3(0.5f)));
    b.pointLight({0, 3, 0}, glm::vec3(1.0f));
    b.pointLight({1, 3, 0}, glm::vec3(1.0f));
    DeviceScene few(device(), b.scene, {.lights = LightChoice::Adaptive});
    EXPECT_FALSE(few.hasLightTables());
    EXPECT_TRUE(few.lightTableConstants().empty());
    b.pointLight({2, 3, 0}, glm::vec3(1.0f));
    EXPECT_TRUE(DeviceScene(device(), b.scene, {.lights = LightChoice::Adaptive}).hasLightTables());
    EXPECT_FALSE(DeviceScene(device(), b.scene, {.lights = LightChoice::Power}).hasLightTables());
}

}  // namespace
}  // namespace helio::test
