/** @file Row G18: shadow maps against exact visibility. */
#include "tests/accuracy/shade_runner.hpp"

#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace helio::test {
namespace {

using Kind = Shadows::Kind;

ShadedImage shadeWithShadows(const Scene& scene, const RasterView& view, const Shadows& shadows) {
    DeviceScene deviceScene(device(), scene, {.tree = false});
    ShadePipeline pipeline(device(), deviceScene, scene.bounds(), shadows);
    const RasterPipeline raster(device());
    if (pipeline.shadows().needed()) {
        Graph graph(device());
        pipeline.shadows().declare(graph, raster, pipeline.triangles(graph));
        Plan plan = graph.compile({.poison = true});
        plan.wait(plan.execute());
    }
    Graph graph(device());
    auto shared = std::make_shared<const RasterView>(view);
    const RasterOutput visible = raster.declare(graph, pipeline.triangles(graph), shared);
    const ShadeOutput output = pipeline.declare(graph, visible, shared);
    const auto color = graph.readback<glm::vec4>(output.color);
    const auto ids = graph.readback<glm::ivec2>(output.ids);
    Plan plan = graph.compile({.poison = true});
    const Execution done = plan.execute();
    return {view.width, color.wait(done), {}, {}, ids.wait(done), {}};
}

PunctualLight light(PunctualLight::Type type) {
    PunctualLight result;
    result.type = type;
    result.intensity = glm::vec3(10.0f);
    result.innerConeAngle = 0.6f;
    result.outerConeAngle = 0.7f;
    return result;
}

/** A light at `position` whose -Z points at `target`. */
void aim(Scene& scene, PunctualLight::Type type, const glm::dvec3& position, const glm::dvec3& target) {
    addLight(scene, light(type), glm::inverse(glm::lookAt(position, target, glm::dvec3(0.1, 0.2, 1))));
}

Primitive floorQuad(float half) {
    return quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
}

constexpr std::uint32_t kSize = 161;
constexpr double kPixelsPerUnit = 40;

/** Where on the floor a pixel of the view from above looks. */
glm::dvec2 floorAt(std::uint32_t x, std::uint32_t y) {
    return {(x + 0.5 - 0.5 * kSize) / kPixelsPerUnit, (y + 0.5 - 0.5 * kSize) / kPixelsPerUnit};
}

RasterView fromAbove() {
    // Below the occluder, which is at height 1: the camera sees the floor alone.
    return downView({0, 0.9, 0}, kSize, kSize, kPixelsPerUnit);
}

struct Case {
    const char* name;
    PunctualLight::Type type;
    glm::dvec3 position;
};
const Case kCases[] = {{"directional", PunctualLight::Type::Directional, {1.5, 4, -0.7}},
                       {"spot", PunctualLight::Type::Spot, {1.0, 4, -0.6}},
                       {"point", PunctualLight::Type::Point, {0.8, 3, 0.5}}};

/** Signed distance on the floor from a point to the outline of the shadow of the square |x|, |z| <= 1/2 at
 * height 1; negative inside. */
double toOutline(const Case& c, const glm::dvec2& p) {
    // The point of height 1 on the way to the light, and how its offset from the square maps back to the
    // floor.
    const glm::dvec3 to =
        c.type == PunctualLight::Type::Directional ? c.position : c.position - glm::dvec3(p.x, 0, p.y);
    const glm::dvec2 at = p + glm::dvec2(to.x, to.z) / to.y;
    const double scale =
        c.type == PunctualLight::Type::Directional ? 1.0 : c.position.y / (c.position.y - 1.0);
    const glm::dvec2 q = glm::abs(at) - 0.5;
    const double outside = glm::length(glm::max(q, glm::dvec2(0)));
    return scale * (outside > 0 ? outside : std::max(q.x, q.y));
}

Scene squareOverFloor(const Case& c) {
    Scene scene;
    addPrimitive(scene, floorQuad(3), lambert(glm::vec3(1)));
    addPrimitive(scene, quad({-0.5f, 1, 0.5f}, {0.5f, 1, 0.5f}, {0.5f, 1, -0.5f}, {-0.5f, 1, -0.5f}),
                 lambert(glm::vec3(1)));
    aim(scene, c.type, c.position, {0, 0, 0});
    return scene;
}

TEST(Shadows, OutlineOfASquareIsWhereRaysHaveIt) {
    for (const Case& c : kCases) {
        const Scene scene = squareOverFloor(c);
        const ShadedImage open = shade(scene, fromAbove());
        for (const std::uint32_t resolution : {256u, 1024u}) {
            const ShadedImage image = shadeWithShadows(scene, fromAbove(), {Kind::Hard, resolution});
            // A texel on the floor: the map spans the scene's sphere (radius 4.3), the cone, or the cube's
            // face.
            const double far = c.type == PunctualLight::Type::Directional ? 2 * 4.31
                               : c.type == PunctualLight::Type::Spot      ? 2 * std::tan(0.7) * 5.5
                                                                          : 2 * 4.5;
            const double texel = far / (resolution - 8) / (c.position.y / glm::length(c.position));
            std::size_t wrong = 0, inBand = 0, dark = 0;
            for (std::uint32_t y = 0; y < kSize; ++y)
                for (std::uint32_t x = 0; x < kSize; ++x) {
                    const std::size_t i = image.at(x, y);
                    const double distance = toOutline(c, floorAt(x, y));
                    if (open.color[i].r <= 0) continue;  // beyond the cone
                    dark += image.color[i].r == 0;
                    if (std::abs(distance) < 1.5 * texel) {
                        ++inBand;
                        continue;
                    }
                    wrong += (image.color[i].r == 0) != (distance < 0);
                    if (distance > 0) {
                        EXPECT_EQ(image.color[i], open.color[i]);
                    }
                }
            std::printf("             %s, %u: %zu in shadow, %zu in the band of 1.5 texels, %zu wrong\n",
                        c.name, resolution, dark, inBand, wrong);
            EXPECT_EQ(wrong, 0u) << c.name << resolution;
            EXPECT_GT(dark, 1000u);
        }
    }
}

TEST(Shadows, PlanesOfAnyTiltNeverShadowThemselves) {
    // A fan of planes through the middle of the scene, one by one, alone: every pixel keeps its bits.
    for (const Case& c : kCases)
        for (const double tilt : {0.0, 0.3, -0.7, 1.2, -1.35}) {
            const glm::vec3 along(std::cos(tilt), std::sin(tilt), 0), across(0, 0, 1);
            Scene scene;
            // Many triangles, so that texels fall on neighbours too.
            Primitive sheet;
            constexpr int cells = 12;
            for (int y = 0; y <= cells; ++y)
                for (int x = 0; x <= cells; ++x)
                    sheet.positions.push_back((2.0f * float(x) / cells - 1.0f) * 1.5f * along +
                                              (1.0f - 2.0f * float(y) / cells) * 1.5f * across);
            for (std::uint32_t y = 0; y < cells; ++y)
                for (std::uint32_t x = 0; x < cells; ++x) {
                    const std::uint32_t k = y * (cells + 1) + x;
                    for (std::uint32_t v : {k, k + 1, k + cells + 2, k, k + cells + 2, k + cells + 1})
                        sheet.indices.push_back(v);
                }
            addPrimitive(scene, sheet, lambert(glm::vec3(1)));
            aim(scene, c.type, c.position, {0, 0, 0});
            const RasterView view = downView({0, 2.5, 0}, kSize, kSize, kPixelsPerUnit);
            const ShadedImage open = shade(scene, view);
            for (const Kind kind : {Kind::Hard, Kind::Filtered, Kind::Soft, Kind::Variance}) {
                const ShadedImage image = shadeWithShadows(scene, view, {kind, 256});
                std::size_t acne = 0, lit = 0;
                for (std::size_t i = 0; i < open.color.size(); ++i) {
                    lit += open.color[i].r > 0;
                    acne += open.color[i].r > 0 && image.color[i].r < open.color[i].r * 0.9999f;
                }
                EXPECT_EQ(acne, 0u) << c.name << ", tilt " << tilt << ", kind " << int(kind) << " of " << lit;
            }
        }
}

TEST(Shadows, FilteredEdgesAreAsWideAsTheBox) {
    const Case& c = kCases[0];
    const Scene scene = squareOverFloor(c);
    const ShadedImage open = shade(scene, fromAbove());
    for (const Kind kind : {Kind::Filtered, Kind::Variance}) {
        const ShadedImage image = shadeWithShadows(scene, fromAbove(), {kind, 512, 3.0f});
        const double texel = 2 * 4.31 / 504 / (c.position.y / glm::length(c.position));
        std::size_t partial = 0;
        double lost = 0;
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const std::size_t i = image.at(x, y);
                const double share = image.color[i].r / open.color[i].r,
                             distance = toOutline(c, floorAt(x, y));
                EXPECT_GE(share, 0.0);
                EXPECT_LE(share, 1.0);
                partial += share > 0.02 && share < 0.98;
                lost += 1 - share;
                if (distance > 6 * texel) {
                    EXPECT_EQ(share, 1.0);
                }
                if (distance < -6 * texel) {
                    EXPECT_LT(share, 1e-3);
                }
            }
        EXPECT_GT(partial, 100u);
        // A box moves light about and loses none: the shadow of the unit square has its area. So has
        // Chebyshev's bound, which for two depths is the share of the box that is lit.
        const double area = lost / (kPixelsPerUnit * kPixelsPerUnit);
        std::printf("             area of the shadow %.4f\n", area);
        EXPECT_NEAR(area, 1.0, 0.01);
    }
}

TEST(Shadows, SoftPenumbraWidensWithTheLight) {
    // Similar triangles: a light of radius r at height 4 over an edge at height 1 blurs it by 2 r / 3 on the
    // floor.
    const Case c{"point", PunctualLight::Type::Point, {0, 4, 0}};
    const Scene scene = squareOverFloor(c);
    const ShadedImage open = shade(scene, fromAbove());
    for (const float size : {0.15f, 0.3f, 0.6f}) {
        const ShadedImage image = shadeWithShadows(scene, fromAbove(), {Kind::Soft, 1024, 1.0f, size});
        // Along the middle row, from inside the shadow outwards: the stretch between 10 % and 90 %.
        double begin = 0, end = 0;
        for (std::uint32_t x = kSize / 2; x < kSize; ++x) {
            const std::size_t i = image.at(x, kSize / 2);
            const double share = image.color[i].r / open.color[i].r, at = floorAt(x, 0).x;
            if (share < 0.1) begin = at;
            if (share < 0.9) end = at;
        }
        const double expected = 2 * size / 3 * 0.8;
        std::printf(
            "             light of radius %.2f: 10 to 90 %% over %.3f, similar triangles of a square %.3f\n",
            size, end - begin, expected);
        EXPECT_NEAR((end - begin) / expected, 1.0, 0.25);
        EXPECT_NEAR(0.5 * (begin + end), 0.5 * 4.0 / 3.0, 0.05);
    }
}

TEST(Shadows, TouchingTheFloorLeavesNoLightBelow) {
    // A wall that stands on the floor: its shadow begins at its foot.
    Scene scene;
    addPrimitive(scene, floorQuad(3), lambert(glm::vec3(1)));
    addPrimitive(scene, quad({0, 0, 1}, {0, 0, -1}, {0, 0.5f, -1}, {0, 0.5f, 1}), lambert(glm::vec3(1)));
    aim(scene, PunctualLight::Type::Directional, {3, 4, 0}, {0, 0, 0});
    const RasterView view = downView({0, 0.45, 0}, kSize, kSize, kPixelsPerUnit);
    const ShadedImage image = shadeWithShadows(scene, view, {Kind::Hard, 1024});
    // Lit from +x at slope 4/3: the shadow reaches 3/8 to the other side.
    double first = 0, last = 0;
    for (std::uint32_t x = 0; x < kSize; ++x) {
        const std::size_t i = image.at(x, kSize / 2);
        if (image.ids[i].x != 0 || image.color[i].r > 0) continue;
        const double at = floorAt(x, 0).x;
        first = std::min(first, at);
        last = last == 0 ? at : std::max(last, at);
    }
    const double texel = 2 * 4.31 / 1016 / 0.8;
    EXPECT_NEAR(first, -0.375, texel + 1 / kPixelsPerUnit);
    EXPECT_NEAR(last, 0, 2 * texel + 1 / kPixelsPerUnit);
}

TEST(Shadows, WithoutPunctualLightsThereAreNoMaps) {
    Scene scene;
    addPrimitive(scene, floorQuad(3), lambert(glm::vec3(1)));
    DeviceScene deviceScene(device(), scene, {.tree = false});
    ShadePipeline pipeline(device(), deviceScene, scene.bounds(), {});
    EXPECT_FALSE(pipeline.shadows().needed());
    EXPECT_TRUE(pipeline.shadows().layout().faces.empty());
}

}  // namespace
}  // namespace helio::test
