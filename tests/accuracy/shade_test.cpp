/** @file Shading of the visibility buffer: closed forms of irradiance, exact attributes, channels. */
#include "passes/raster/push.hpp"
#include "tests/accuracy/shade_runner.hpp"

#include <heliograph/kernel.hpp>
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace helio::test {
namespace {

using namespace verify;

constexpr double kPi = 3.14159265358979323846;

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
        EXPECT_NEAR(c.r * kPi / 0.5 / expected, 1.0, 1e-6);
        EXPECT_NEAR(c.g * kPi / 0.5 / expected, 1.0, 1e-6);
        EXPECT_NEAR(c.b * kPi / 4.0 / expected, 1.0, 1e-6);
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
                worst = std::max(worst, std::abs(red(image, x, y) * kPi - expected) / (expected + 0.1));
                if (a * b < 1e-3) small = std::max(small, std::abs(red(image, x, y) * kPi / expected - 1.0));
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
            const double expected = 2.0 * sum * area / (parts * parts) / kPi;
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
                    EXPECT_NEAR(c.r, expected * 0.5 / kPi, 2e-6) << int(type) << " " << x << " " << y;
                    EXPECT_NEAR(c.g, c.r * 2 / 3, 1e-6);
                }
        }
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

TEST(ShadeAttributes, PerspectiveCorrectAgainstTheRayPlane) {
    // Vertex colours r = u, g = v on a plane tilted to the grazing; the channel albedo shows them.
    double worst = 0, affine = 0;
    for (const double tilt : {0.3, 1.2, 1.5}) {
        const glm::dvec3 right(1, 0, 0), along(0, std::cos(tilt), -std::sin(tilt)), centre(0.1, -0.05, -3);
        const double half = 2;
        Primitive p;
        for (const auto& [s, t] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
            p.positions.emplace_back(centre + half * double(s) * right + half * double(t) * along);
            p.colors.emplace_back(s * 0.5f + 0.5f, t * 0.5f + 0.5f, 0.0f, 1.0f);
        }
        p.indices = {0, 1, 2, 0, 2, 3};
        Scene scene;
        addPrimitive(scene, p, lambert(glm::vec3(1)));
        RasterView view;
        view.width = 200;
        view.height = 150;
        view.rowW = {0, 0, -1};
        view.rowX = 150.0 * glm::dvec3(1, 0, 0) + 100.0 * view.rowW;
        view.rowY = 150.0 * glm::dvec3(0, -1, 0) + 75.0 * view.rowW;
        view.depthOffset = 1e-6;
        const ShadedImage image = shade(scene, view);
        const glm::dvec3 v0(p.positions[0]), e1 = glm::dvec3(p.positions[1]) - v0,
                                             e2 = glm::dvec3(p.positions[3]) - v0;
        std::size_t hits = 0;
        for (std::uint32_t y = 0; y < 150; ++y)
            for (std::uint32_t x = 0; x < 200; ++x) {
                const std::size_t i = image.at(x, y);
                if (image.ids[i].x < 0) continue;
                const glm::dvec3 d((x + 0.5 - 100) / 150, -(y + 0.5 - 75) / 150, -1);
                const glm::dvec3 q = glm::cross(d, e2);
                const double u = glm::dot(-v0, q) / glm::dot(e1, q);
                const double v = glm::dot(d, glm::cross(-v0, e1)) / glm::dot(e1, q);
                if (u < 0.01 || v < 0.01 || u > 0.99 || v > 0.99) continue;  // snapping moves the rim
                ++hits;
                worst = std::max({worst, std::abs(image.albedoDepth[i].r / u - 1),
                                  std::abs(image.albedoDepth[i].g / v - 1)});
                const double depth =
                    1.0 / (glm::dot(glm::cross(e1, e2), d) / glm::dot(glm::cross(e1, e2), v0));
                EXPECT_NEAR(image.albedoDepth[i].w / depth, 1.0, 4e-7);
                // What screen-space interpolation would give between the near and the far edge.
                const double yNear = 75 - 150 * p.positions[0].y / -p.positions[0].z,
                             yFar = 75 - 150 * p.positions[3].y / -p.positions[3].z;
                affine = std::max(affine, std::abs((y + 0.5 - yNear) / (yFar - yNear) - v));
            }
        EXPECT_GT(hits, 1000u);
    }
    std::printf("             worst relative error %.2e; affine interpolation is off by %.2f\n", worst,
                affine);
    EXPECT_LT(worst, 4e-6);
    EXPECT_GT(affine, 0.1);
}

/** Level of detail and derivatives of (u, v) as shading takes them, for every pixel of a key buffer. */
const char* const kDerivativeKernel = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/surface.glsl"
#include "shaders/texture/trilinear.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer uVisibility { uvec2 visibility[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uResult { vec4 result[]; };
layout(set = 0, binding = 2, std430) writeonly buffer uLevel { float level[]; };
layout(set = 0, binding = 3) uniform samplerBuffer uUv;
void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    int index = pixel.y * size.x + pixel.x;
    bool hit = (visibility[index].x | visibility[index].y) != 0u;
    int g = hit ? int(~visibility[index].x) : 0;
    Surface surface = surfaceAt(fetchTriangle(g), pixel);
    vec2 uv0 = texelFetch(uUv, 3 * g).xy, e1 = texelFetch(uUv, 3 * g + 1).xy - uv0, e2 = texelFetch(uUv, 3 * g + 2).xy - uv0;
    vec2 dx = surface.db1.x * e1 + surface.db2.x * e2, dy = surface.db1.y * e1 + surface.db2.y * e2;
    result[index] = hit ? vec4(dx, dy) : vec4(0.0);
    level[index] = hit ? mipLevel(vec2(1024.0, 512.0), dx, dy) : -1.0;
})";

TEST(ShadeAttributes, DerivativesAndLevelOfATiltedPlane) {
    const Kernel kernel = compileKernel("test/derivatives", kDerivativeKernel);
    double worst = 0, worstLevel = 0;
    std::size_t hits = 0;
    for (const bool orthographic : {false, true})
        for (const double tilt : {0.2, 1.0, 1.45}) {
            const glm::dvec3 right(std::cos(0.4), std::sin(0.4), 0), centre(0.1, -0.05, -3);
            const glm::dvec3 along =
                std::cos(tilt) * glm::dvec3(-right.y, right.x, 0) + std::sin(tilt) * glm::dvec3(0, 0, -1);
            std::vector<glm::vec4> triangles, uv;
            const std::array<glm::dvec2, 4> corners = {glm::dvec2(-2, -2), glm::dvec2(2, -2),
                                                       glm::dvec2(2, 2), glm::dvec2(-2, 2)};
            for (const auto& [g, order] :
                 {std::pair{0u, std::array{0, 1, 2}}, std::pair{1u, std::array{0, 2, 3}}})
                for (int k = 0; k < 3; ++k) {
                    const glm::dvec2 c = corners[std::size_t(order[std::size_t(k)])];
                    triangles.emplace_back(glm::vec3(centre + c.x * right + c.y * along),
                                           glm::uintBitsToFloat(k == 0 ? g : 0u));
                    uv.emplace_back(c.x * 0.25f + 0.5f, c.y * 0.25f + 0.5f, 0, 0);
                }
            auto view = std::make_shared<RasterView>();
            view->width = 160;
            view->height = 120;
            view->rowW = {0, 0, -1};
            view->orthographic = orthographic;
            const double focal = orthographic ? 40 : 120;
            view->rowX = {focal, 0, orthographic ? 0 : -80};
            view->rowY = {0, -focal, orthographic ? 0 : -60};
            view->depthOffset = orthographic ? 1 : 1e-6;
            view->depthSlope = -0.01;

            DeviceBuffer triangleBuffer = makeBuffer(device(), "triangles", triangles),
                         uvBuffer = makeBuffer(device(), "uv", uv);
            Graph graph(device());
            const Buffer source = graph.import(triangleBuffer);
            const RasterOutput raster = RasterPipeline(device()).declare(graph, {source, 2}, view);
            const Buffer result = graph.buffer("result", {160 * 120 * 16}),
                         levels = graph.buffer("level", {160 * 120 * 4});
            graph.compute("derivatives", kernel)
                .reads({{"uVisibility", raster.visibility},
                        {"uTriangles", source},
                        {"uUv", graph.import(uvBuffer)}})
                .overwrites({{"uResult", result}, {"uLevel", levels}})
                .record([view](Commands& c) {
                    c.push(makeRasterPush(*view, 0, 0, 0)).dispatchOver(view->width, view->height);
                });
            const auto derivatives = graph.readback<glm::vec4>(result);
            const auto level = graph.readback<float>(levels);
            Plan plan = graph.compile();
            const Execution done = plan.execute();
            const auto values = derivatives.wait(done);
            const auto levelValues = level.wait(done);

            // (u, v) of a point of the screen: the plane itself, met by the pixel's ray; derivatives by
            // central differences.
            const auto uvAt = [&](double x, double y) {
                const glm::dvec3 n = glm::cross(right, along);
                const glm::dvec3 at((x - 80) / focal, -(y - 60) / focal, 0);
                const glm::dvec3 origin = orthographic ? at : glm::dvec3(0),
                                 direction = orthographic ? glm::dvec3(0, 0, -1) : at + glm::dvec3(0, 0, -1);
                const glm::dvec3 p =
                    origin + direction * (glm::dot(centre - origin, n) / glm::dot(direction, n)) - centre;
                return glm::dvec2(glm::dot(p, right) * 0.25 + 0.5, glm::dot(p, along) * 0.25 + 0.5);
            };
            for (std::uint32_t y = 0; y < 120; ++y)
                for (std::uint32_t x = 0; x < 160; ++x) {
                    const std::size_t i = y * 160 + x;
                    if (levelValues[i] < 0) continue;
                    ++hits;
                    constexpr double h = 1e-3;
                    const glm::dvec2 dx = (uvAt(x + 0.5 + h, y + 0.5) - uvAt(x + 0.5 - h, y + 0.5)) / (2 * h);
                    const glm::dvec2 dy = (uvAt(x + 0.5, y + 0.5 + h) - uvAt(x + 0.5, y + 0.5 - h)) / (2 * h);
                    const double scale = glm::length(dx) + glm::length(dy);
                    for (int c = 0; c < 2; ++c)
                        worst = std::max({worst, std::abs(values[i][c] - dx[c]) / scale,
                                          std::abs(values[i][c + 2] - dy[c]) / scale});
                    const glm::dvec2 texels(1024, 512);
                    const double expected = std::max(
                        0.0, std::log2(std::max(glm::length(dx * texels), glm::length(dy * texels))));
                    worstLevel = std::max(worstLevel, std::abs(levelValues[i] - expected));
                }
        }
    std::printf("             %zu pixels, derivatives off by %.1e, levels by %.1e\n", hits, worst,
                worstLevel);
    EXPECT_GT(hits, 10000u);
    EXPECT_LT(worst, 1e-6);
    EXPECT_LT(worstLevel, 1e-5);
}

/** A textured floor of 64 x 64 texels, one unit wide. */
Scene texturedFloor(std::vector<glm::dvec4>& linear, bool mipmaps = true) {
    Scene scene;
    std::mt19937 random(5);
    TextureImage image{"", 64, 64, {}};
    std::vector<float> texels;
    for (int i = 0; i < 64 * 64; ++i)
        for (int c = 0; c < 4; ++c) texels.push_back(c == 3 ? 1.0f : random() / 4294967296.0f);
    for (int i = 0; i < 64 * 64; ++i)
        linear.emplace_back(texels[std::size_t(i) * 4], texels[std::size_t(i) * 4 + 1],
                            texels[std::size_t(i) * 4 + 2], 1);
    image.texels = texels;
    scene.images.push_back(image);
    Texture texture;
    texture.image = 0;
    texture.useMipmaps = mipmaps;
    scene.textures.push_back(texture);
    Primitive p = quad({0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0});
    p.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    Material material = lambert(glm::vec3(1));
    material.baseColorTexture.texture = 0;
    addPrimitive(scene, p, material);
    return scene;
}

TEST(ShadeTextures, MinifiedByPowersOfTwoIsTheMeanOfTheBlock) {
    std::vector<glm::dvec4> linear;
    const Scene scene = texturedFloor(linear);
    for (const std::uint32_t size : {64u, 32u, 16u, 4u, 1u}) {
        const ShadedImage image = shade(scene, downView({0.5, 1, 0.5}, size, size, size));
        const std::uint32_t block = 64 / size;
        double worst = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                glm::dvec4 mean(0.0);
                for (std::uint32_t j = 0; j < block; ++j)
                    for (std::uint32_t i = 0; i < block; ++i)
                        mean += linear[(y * block + j) * 64 + x * block + i] / double(block * block);
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(image.albedoDepth[image.at(x, y)][c] - mean[c]));
            }
        EXPECT_LT(worst, 4e-6) << size;
    }
    // Without mip levels the base is sampled between its texels instead.
    std::vector<glm::dvec4> again;
    const ShadedImage plain = shade(texturedFloor(again, false), downView({0.5, 1, 0.5}, 16, 16, 16));
    glm::dvec4 four(0.0);
    for (int k : {0, 1, 64, 65}) four += again[std::size_t(k + 64 + 1)] * 0.25;
    EXPECT_NEAR(plain.albedoDepth[0].r, four.r, 4e-6);
}

TEST(ShadeTextures, LevelsBlendWithTheLogarithmOfTheFootprint) {
    // Footprints of 2^D texels: the colour is on the line between levels floor(D) and floor(D) + 1, at its
    // fraction.
    std::vector<glm::dvec4> linear;
    const Scene scene = texturedFloor(linear);
    for (const double level : {0.25, 1.5, 2.75, 5.5}) {
        const double pixelsPerUnit = 64 / std::exp2(level);
        const ShadedImage image = shade(scene, downView({0.5, 1, 0.5}, 1, 1, pixelsPerUnit));
        // At the floor's centre every level's value is the mean of its four middle texels.
        const auto middle = [&](int k) {
            const int size = 64 >> k, block = 1 << k;
            glm::dvec4 sum(0.0);
            if (size == 1) {
                for (const auto& t : linear) sum += t / 4096.0;
                return sum;
            }
            for (int j = 32 - block; j < 32 + block; ++j)
                for (int i = 32 - block; i < 32 + block; ++i)
                    sum += linear[std::size_t(j * 64 + i)] / (4.0 * block * block);
            return sum;
        };
        const int fine = int(level);
        const glm::dvec4 expected = glm::mix(middle(fine), middle(fine + 1), level - fine);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.albedoDepth[0][c], expected[c], 2e-6) << level;
    }
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
