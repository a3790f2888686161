/** @file Rows S7, X4 to X6 in shading: attributes, their derivatives, levels of detail, and filtered
 * textures. */
#include "passes/raster/push.hpp"
#include "tests/accuracy/shade_runner.hpp"

#include <heliograph/kernel.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace helio::test {
namespace {

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
            graph.compute("derivatives", kernel, {.spec = {{"ORTHOGRAPHIC", orthographic}}})
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

}  // namespace
}  // namespace helio::test
