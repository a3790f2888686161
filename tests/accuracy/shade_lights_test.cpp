/** @file Shading of the visibility buffer: lights against closed forms of irradiance, and the channels. */
#include "tests/accuracy/shade_runner.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace helio::test {
namespace {

using namespace verify;

Primitive floorQuad(float half) {
    return quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
}

/** A rectangle parallel to the floor at height h that shines down. */
Primitive ceilingQuad(float a, float b, float h) {
    return quad({-a / 2, h, -b / 2}, {a / 2, h, -b / 2}, {a / 2, h, b / 2}, {-a / 2, h, b / 2});
}

double red(const ShadedImage& image, std::uint32_t x, std::uint32_t y) {
    return image.color[image.at(x, y)].r;
}

TEST(ShadeLights, SquareOverTheFloor) {
    // truths: under the centre of a unit square at height 1, and of a 2 x 2 square.
    for (const auto& [side, expected] : {std::pair{1.0f, 0.752274688454}, std::pair{2.0f, 1.740839502730}}) {
        Scene scene;
        addPrimitive(scene, floorQuad(10), lambert(glm::vec3(0.5f, 0.25f, 1.0f)));
        addPrimitive(scene, ceilingQuad(side, side, 1), lambert(glm::vec3(0), glm::vec3(1, 2, 4)));
        const ShadedImage image = shade(scene, downView({0, 0.5, 0}, 3, 3, 1e6));
        const glm::vec4 c = image.color[image.at(1, 1)];
        EXPECT_NEAR(c.r * std::numbers::pi / 0.5 / expected, 1.0, 1e-6);
        EXPECT_NEAR(c.g * std::numbers::pi / 0.5 / expected, 1.0, 1e-6);
        EXPECT_NEAR(c.b * std::numbers::pi / 4.0 / expected, 1.0, 1e-6);
        EXPECT_NEAR(irradianceCentredRectangle(side, side, 1), expected, 1e-11);
    }
}

TEST(ShadeLights, RectanglesAnywhereAgainstTheClosedForm) {
    double worst = 0, small = 0;
    for (const auto& [a, b, h] : {std::array{1.0, 1.0, 1.0}, std::array{0.1, 3.0, 0.5},
                                  std::array{0.02, 0.01, 2.0}, std::array{30.0, 20.0, 0.7}}) {
        Scene scene;
        addPrimitive(scene, floorQuad(40), lambert(glm::vec3(1)));
        addPrimitive(scene, ceilingQuad(float(a), float(b), float(h)), lambert(glm::vec3(0), glm::vec3(1)));
        const RasterView view = downView({0, 0.25, 0}, 33, 31, 5.0);
        const ShadedImage image = shade(scene, view);
        const double x0 = double(float(a)) / 2, z0 = double(float(b)) / 2, y0 = double(float(h));
        for (std::uint32_t y = 0; y < 31; ++y)
            for (std::uint32_t x = 0; x < 33; ++x) {
                const double px = (x + 0.5 - 16.5) / 5.0, pz = (y + 0.5 - 15.5) / 5.0;
                const Vector corners[4] = {{-x0, y0, -z0}, {x0, y0, -z0}, {x0, y0, z0}, {-x0, y0, z0}};
                const double expected = std::abs(irradiancePolygon({px, 0, pz}, {0, 1, 0}, corners));
                // The sum's terms are of the order of 1, whatever is left of them.
                worst = std::max(worst,
                                 std::abs(red(image, x, y) * std::numbers::pi - expected) / (expected + 0.1));
                if (a * b < 1e-3)
                    small = std::max(small, std::abs(red(image, x, y) * std::numbers::pi / expected - 1.0));
            }
    }
    std::printf("             worst error over E + 0.1: %.2e; relative, of a small rectangle: %.2e\n", worst,
                small);
    EXPECT_LT(worst, 3e-6);
    EXPECT_LT(small, 4e-6);
}

TEST(ShadeLights, CutAtTheHorizonAndOneSided) {
    // A wall on the floor that reaches below it, seen from tilted receivers: the floor's smooth normals lean.
    Primitive receiver = floorQuad(4);
    const glm::vec3 normal = glm::normalize(glm::vec3(0.6f, 0.7f, 0.2f));
    receiver.normals = {normal, normal, normal, normal};
    const glm::vec3 a(1.5f, -1, -1), e1(0.3f, 0, 2), e2(0.2f, 3, 0.1f);
    Scene scene;
    addPrimitive(scene, receiver, lambert(glm::vec3(1)));
    addPrimitive(scene, quad(a, a + e1, a + e1 + e2, a + e2), lambert(glm::vec3(0), glm::vec3(2)));
    const ShadedImage image = shade(scene, downView({-1, 1, 0}, 16, 16, 8));
    // Midpoint rule in double over 600 x 600 parts of the wall.
    const glm::dvec3 n = glm::normalize(glm::dvec3(glm::cross(e1, e2)));
    const double area = glm::length(glm::dvec3(glm::cross(e1, e2)));
    double worst = 0;
    for (std::uint32_t y : {0u, 7u, 15u})
        for (std::uint32_t x : {0u, 5u, 15u}) {
            const glm::dvec3 p(-1 + (x + 0.5 - 8) / 8, 0, (y + 0.5 - 8) / 8);
            double sum = 0;
            constexpr int parts = 600;
            for (int i = 0; i < parts; ++i)
                for (int k = 0; k < parts; ++k) {
                    const glm::dvec3 d = glm::dvec3(a) + glm::dvec3(e1) * ((i + 0.5) / parts) +
                                         glm::dvec3(e2) * ((k + 0.5) / parts) - p;
                    const double squared = glm::dot(d, d);
                    sum += std::max(glm::dot(d, glm::dvec3(normal)), 0.0) * std::max(-glm::dot(d, n), 0.0) /
                           (squared * squared);
                }
            const double expected = 2.0 * sum * area / (parts * parts) / std::numbers::pi;
            EXPECT_GT(expected, 0.01);
            worst = std::max(worst, std::abs(red(image, x, y) / expected - 1.0));
        }
    std::printf("             worst relative error %.2e\n", worst);
    EXPECT_LT(worst, 2e-5);

    // The same wall turned round shines the other way, unless it is double-sided.
    for (const bool doubleSided : {false, true}) {
        Scene turned;
        Material shining = lambert(glm::vec3(0), glm::vec3(2));
        shining.doubleSided = doubleSided;
        addPrimitive(turned, receiver, lambert(glm::vec3(1)));
        addPrimitive(turned, quad(a, a + e2, a + e1 + e2, a + e1), shining);
        const ShadedImage back = shade(turned, downView({-1, 1, 0}, 16, 16, 8));
        if (doubleSided)
            EXPECT_NEAR(red(back, 5, 7) / red(image, 5, 7), 1.0, 1e-5);
        else
            EXPECT_EQ(red(back, 5, 7), 0.0);
    }
}

TEST(ShadeLights, TrianglesAddUpToTheRectangle) {
    // Three triangles cannot be paired: the light table keeps some as triangles.
    Scene pieces, whole;
    Primitive p;
    p.positions = {{-0.5f, 1, -0.5f}, {0.5f, 1, -0.5f}, {0.5f, 1, 0.5f}, {-0.5f, 1, 0.5f}, {0.1f, 1, 0.2f}};
    p.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    for (Scene* scene : {&pieces, &whole}) addPrimitive(*scene, floorQuad(3), lambert(glm::vec3(1)));
    addPrimitive(pieces, p, lambert(glm::vec3(0), glm::vec3(1)));
    addPrimitive(whole, ceilingQuad(1, 1, 1), lambert(glm::vec3(0), glm::vec3(1)));
    const RasterView view = downView({0, 0.5, 0}, 15, 15, 4);
    const ShadedImage a = shade(pieces, view), b = shade(whole, view);
    for (std::size_t i = 0; i < a.color.size(); ++i) EXPECT_NEAR(a.color[i].r / b.color[i].r, 1.0, 5e-6);
}

TEST(ShadeLights, PointSpotAndDirectional) {
    const RasterView view = downView({0, 4, 0}, 21, 21, 4);
    const auto position = [](std::uint32_t x, std::uint32_t y) {
        return glm::dvec3((x + 0.5 - 10.5) / 4, 0, (y + 0.5 - 10.5) / 4);
    };
    glm::dmat4 down(1.0);  // -Z of the node looks along -y
    down[0] = {1, 0, 0, 0};
    down[1] = {0, 0, -1, 0};
    down[2] = {0, 1, 0, 0};
    down[3] = {0.5, 2, -0.25, 1};
    PunctualLight light;
    light.intensity = glm::vec3(3, 2, 1);
    light.outerConeAngle = 0.6f;
    light.innerConeAngle = 0.3f;
    for (const auto type :
         {PunctualLight::Type::Point, PunctualLight::Type::Spot, PunctualLight::Type::Directional})
        for (const float range : {0.0f, 3.0f}) {
            light.type = type;
            light.range = range;
            Scene scene;
            addPrimitive(scene, floorQuad(10), lambert(glm::vec3(0.5f)));
            addLight(scene, light, down);
            const ShadedImage image = shade(scene, view);
            for (std::uint32_t y = 0; y < 21; ++y)
                for (std::uint32_t x = 0; x < 21; ++x) {
                    const glm::dvec3 d = glm::dvec3(down[3]) - position(x, y);
                    const double r2 = glm::dot(d, d), cosine = d.y / std::sqrt(r2);
                    double expected = 3.0 * cosine / r2;
                    if (type == PunctualLight::Type::Directional) expected = 3.0;
                    if (type == PunctualLight::Type::Spot) {
                        const double outer = std::cos(0.6f), inner = std::cos(0.3f);
                        const double cone =
                            std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
                        expected *= cone * cone;
                    }
                    if (range > 0 && type != PunctualLight::Type::Directional)
                        expected *= std::clamp(1.0 - std::pow(r2 / double(range * range), 2), 0.0, 1.0);
                    const glm::vec4 c = image.color[image.at(x, y)];
                    EXPECT_NEAR(c.r, expected * 0.5 / std::numbers::pi, 2e-6)
                        << int(type) << " " << x << " " << y;
                    EXPECT_NEAR(c.g, c.r * 2 / 3, 1e-6);
                }
        }
}

TEST(ShadeLights, BehindASurfaceTheyBringNothing) {
    Scene scene;
    addPrimitive(scene, floorQuad(10), lambert(glm::vec3(0.5f)));
    glm::dmat4 below(1.0);
    below[3] = {0.5, -2, -0.25, 1};
    addLight(scene, PunctualLight{}, below);
    for (const glm::vec4& c : shade(scene, downView({0, 4, 0}, 21, 21, 4)).color) EXPECT_EQ(c.r, 0.0f);
}

TEST(ShadeLights, EnvironmentEmissionAndMisses) {
    Scene scene;
    scene.environment = Environment{glm::vec3(0.5f, 1, 2), -1};
    Material front = lambert(glm::vec3(0.5f), glm::vec3(3, 0, 0)), both = front;
    both.doubleSided = true;
    addPrimitive(scene, quad({-3, 0, 1}, {-1, 0, 1}, {-1, 0, -1}, {-3, 0, -1}), lambert(glm::vec3(0.25f)));
    addPrimitive(scene, quad({-1, 0, 1}, {0, 0, 1}, {0, 0, -1}, {-1, 0, -1}), front);
    addPrimitive(scene, quad({0, 0, -1}, {1, 0, -1}, {1, 0, 1}, {0, 0, 1}), front);  // its back is seen
    addPrimitive(scene, quad({1, 0, -1}, {2, 0, -1}, {2, 0, 1}, {1, 0, 1}), both);
    const ShadedImage image = shade(scene, downView({0, 1, 0}, 8, 3, 1));
    const auto at = [&](int x, int y) {
        return image.color[image.at(std::uint32_t(x + 4), std::uint32_t(y))];
    };
    EXPECT_EQ(at(3, 1), glm::vec4(0.5f, 1, 2, 0)) << "a miss shows the environment";
    EXPECT_EQ(at(-2, 1), glm::vec4(0.125f, 0.25f, 0.5f, 1));
    EXPECT_EQ(at(-1, 1), glm::vec4(3.25f, 0.5f, 1, 1));
    EXPECT_EQ(at(0, 1), glm::vec4(0.25f, 0.5f, 1, 1));
    EXPECT_EQ(at(1, 1), glm::vec4(3.25f, 0.5f, 1, 1));
    EXPECT_EQ(image.ids[image.at(7, 1)], glm::ivec2(-1));
    EXPECT_EQ(image.albedoDepth[image.at(7, 1)], glm::vec4(0));
    EXPECT_EQ(image.normal[image.at(7, 1)], glm::vec4(0));
    EXPECT_EQ(image.albedoDepth[image.at(4, 1)].w, 1.0f);
    EXPECT_EQ(image.normal[image.at(4, 1)], glm::vec4(0, 1, 0, 0))
        << "the back's normal is turned to the viewer";
}

TEST(ShadeLights, MoreLightsThanOnePassTakes) {
    Scene many, one;
    for (Scene* scene : {&many, &one}) addPrimitive(*scene, floorQuad(10), lambert(glm::vec3(0.5f)));
    glm::dmat4 placed(1.0);
    placed[3] = {0.3, 2, 0.1, 1};
    PunctualLight light;
    light.intensity = glm::vec3(9000, 900, 90);
    addLight(one, light, placed);
    light.intensity /= 9000.0f;
    many.lights.push_back(light);
    for (int i = 0; i < 9000; ++i) {
        Node node;
        node.light = 0;
        node.matrix = glm::mat4(placed);
        many.nodes.push_back(node);
        many.roots.push_back(int(many.nodes.size()) - 1);
    }
    const RasterView view = downView({0, 1, 0}, 5, 4, 2);
    const ShadedImage a = shade(many, view), b = shade(one, view);
    for (std::size_t i = 0; i < a.color.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.color[i][c] / b.color[i][c], 1.0, 1e-4);
}

TEST(ShadeLights, AnEmptySceneShowsItsEnvironment) {
    Scene scene;
    scene.environment = Environment{glm::vec3(0.5f, 1, 2), -1};
    const ShadedImage image = shade(scene, downView({0, 1, 0}, 5, 3, 1));
    for (const glm::vec4& c : image.color) EXPECT_EQ(c, glm::vec4(0.5f, 1, 2, 0));
    for (const glm::ivec2& id : image.ids) EXPECT_EQ(id, glm::ivec2(-1));
}

TEST(ShadeChannels, IdsDepthAndNormalsInSceneOrderWhateverTheOrderOfTheBuffer) {
    Scene scene;
    Primitive sheet = floorQuad(1);
    sheet.normals = {{0.6f, 0.8f, 0}, {0.6f, 0.8f, 0}, {-0.6f, 0.8f, 0}, {-0.6f, 0.8f, 0}};
    scene.environment = Environment{glm::vec3(1), -1};
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
        glm::dmat4 placed(1.0);
        placed[3] = {(random() % 100) / 25.0 - 2, i * 0.01, (random() % 100) / 25.0 - 2, 1};
        placed[0][0] = placed[2][2] = 0.2;
        addPrimitive(scene, sheet, lambert(glm::vec3(1.0f, i / 40.0f, 0.0f)), placed);
    }
    const RasterView view = downView({0, 2, 0}, 64, 64, 20);
    const ShadedImage inOrder = shade(scene, view, false), inTree = shade(scene, view, true);
    EXPECT_EQ(inOrder.keys, inTree.keys);
    EXPECT_EQ(inOrder.ids, inTree.ids);
    EXPECT_EQ(inOrder.color, inTree.color);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < inOrder.ids.size(); ++i) {
        const glm::ivec2 id = inOrder.ids[i];
        if (id.x < 0) continue;
        ++hits;
        EXPECT_TRUE(id.y == 0 || id.y == 1);
        EXPECT_EQ(inOrder.albedoDepth[i].g, float(id.x / 40.0f));
        EXPECT_NEAR(inOrder.albedoDepth[i].w, 2 - id.x * 0.01, 1e-6);
        EXPECT_NEAR(glm::length(glm::vec3(inOrder.normal[i])), 1.0, 1e-6);
    }
    EXPECT_GT(hits, 1000u);
}

TEST(ShadeSkipped, NamesWhatIsLeftOut) {
    Scene scene;
    scene.environment = Environment{glm::vec3(1), -1};
    addPrimitive(scene, floorQuad(1), lambert(glm::vec3(1)));
    DeviceScene deviceScene(device(), scene, {.tree = false});
    const auto skipped = ShadePipeline(device(), deviceScene).skipped();
    EXPECT_TRUE(std::ranges::any_of(skipped, [](const auto& s) { return s.first == "shadows"; }));
    EXPECT_TRUE(std::ranges::any_of(skipped, [](const auto& s) { return s.first == "indirect light"; }));
}

}  // namespace
}  // namespace helio::test
