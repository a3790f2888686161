/** @file Row X14: baked ambient occlusion and irradiance against closed forms. */
#include "engine/scene/samples/shapes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/bake.hpp>
#include <heliograph/error.hpp>
#include <heliograph/image.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace helio::test {
namespace {

Primitive triangles(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices) {
    Primitive p;
    p.positions = std::move(positions);
    p.indices = std::move(indices);
    return p;
}

/** A rectangle from `corner` along two edges; its coordinates cover the image. */
Primitive rectangle(glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    Primitive p = triangles({corner, corner + u, corner + u + v, corner + v}, {0, 1, 2, 0, 2, 3});
    p.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    return p;
}

/** The floor is the first node. */
Scene sceneOf(std::vector<Primitive> primitives) {
    Scene scene;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        scene.meshes.push_back({"", {std::move(primitives[i])}});
        Node node;
        node.name = fmt::format("node {}", i);
        node.mesh = int(i);
        scene.nodes.push_back(node);
        scene.roots.push_back(int(i));
    }
    return scene;
}

ImageF bakeOf(const Scene& scene, std::uint32_t size, std::uint32_t samples, double distance = INFINITY) {
    ImageF image =
        bakeAmbientOcclusion(device(), scene, {.size = size, .samples = samples, .distance = distance});
    EXPECT_EQ(image.width, size);
    return image;
}

TEST(Bake, FloorBeforeALongWall) {
    // Floor 0 <= x <= 2 facing +y, wall of height 1 at x = 0: half of (1 + d / sqrt(d^2 + h^2)) is open.
    const Scene scene = sceneOf(
        {rectangle({0, 0, 0.5f}, {2, 0, 0}, {0, 0, -1}), rectangle({0, 0, -200}, {0, 0, 400}, {0, 1, 0})});
    constexpr std::uint32_t size = 16;
    const ImageF image = bakeOf(scene, size, 1024);
    double worst = 0;
    for (std::uint32_t x = 0; x < size; ++x) {
        const double d = 2 * (x + 0.5) / size, truth = 0.5 * (1 + d / std::sqrt(d * d + 1));
        double mean = 0;
        for (std::uint32_t y = 0; y < size; ++y) mean += double(image.at(x, y, 0)) / size;
        worst = std::max(worst, std::abs(mean / truth - 1));
    }
    fmt::print("wall: largest relative error of 16 distances {:.2e}\n", worst);
    EXPECT_LT(worst, 0.005);
}

TEST(Bake, UnderADisc) {
    // A disc of radius R at height h hides R^2 / (R^2 + h^2) of the sky from below its middle.
    constexpr int corners = 256;
    for (const double radius : {0.5, 1.0, 3.0}) {
        // As large as the circle.
        const double reach =
            radius * std::sqrt(2 * std::numbers::pi / corners / std::sin(2 * std::numbers::pi / corners));
        std::vector<glm::vec3> positions{{0, 1, 0}};
        std::vector<std::uint32_t> indices;
        for (int i = 0; i < corners; ++i) {
            const double turn = 2 * std::numbers::pi * i / corners;
            positions.emplace_back(reach * std::cos(turn), 1, reach * std::sin(turn));
            indices.insert(indices.end(), {0u, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % corners)});
        }
        const Scene scene = sceneOf(
            {rectangle({-0.005f, 0, 0.005f}, {0.01f, 0, 0}, {0, 0, -0.01f}), triangles(positions, indices)});
        const ImageF image = bakeOf(scene, 8, 1024);
        double mean = 0;
        for (std::size_t i = 0; i < 64; ++i) mean += double(image.data[i * 3]) / 64;
        const double truth = 1 - radius * radius / (radius * radius + 1);
        fmt::print("disc of radius {}: {:.5f} for {:.5f}\n", radius, mean, truth);
        EXPECT_NEAR(mean / truth, 1, 0.005);
    }
}

TEST(Bake, UnderARectangle) {
    // E / pi of a rectangle a x b at height 1 over the point below its corner (Howell's catalogue, B-3), four
    // of them.
    const double a = 1, b = 2;
    const double A = a / std::sqrt(1 + a * a), B = b / std::sqrt(1 + b * b);
    const double corner =
        (A * std::atan(b / std::sqrt(1 + a * a)) + B * std::atan(a / std::sqrt(1 + b * b))) /
        (2 * std::numbers::pi);
    const Scene scene = sceneOf({rectangle({-0.005f, 0, 0.005f}, {0.01f, 0, 0}, {0, 0, -0.01f}),
                                 rectangle({-1, 1, -2}, {2, 0, 0}, {0, 0, 4})});
    const ImageF image = bakeOf(scene, 8, 1024);
    double mean = 0;
    for (std::size_t i = 0; i < 64; ++i) mean += double(image.data[i * 3]) / 64;
    fmt::print("rectangle: {:.5f} for {:.5f}\n", mean, 1 - 4 * corner);
    EXPECT_NEAR(mean / (1 - 4 * corner), 1, 0.005);
    // Out of reach nothing hides.
    const ImageF near = bakeOf(scene, 2, 64, 0.9);
    EXPECT_EQ(near.at(0, 0, 0), 1.0f);
}

TEST(Bake, AFlatFloorOfManyTrianglesHidesNothingFromItself) {
    Primitive grid;
    constexpr std::uint32_t n = 9;
    std::vector<glm::vec2> uv;
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const glm::vec2 t(float(i % n) / (n - 1), float(i / n) / (n - 1));
        // A tilted plane far from the origin, whose corners are rounded.
        grid.positions.emplace_back(100 + 3 * t.x, 50 + 0.7f * t.x - 0.3f * t.y, -70 - 2 * t.y);
        uv.push_back(t);
    }
    grid.texcoords = {uv};
    for (std::uint32_t y = 0; y + 1 < n; ++y)
        for (std::uint32_t x = 0; x + 1 < n; ++x) {
            const std::uint32_t i = y * n + x;
            grid.indices.insert(grid.indices.end(), {i, i + 1, i + n + 1, i, i + n + 1, i + n});
        }
    const ImageF image = bakeOf(sceneOf({grid}), 32, 256);
    for (const float value : image.data) ASSERT_EQ(value, 1.0f);
}

TEST(Bake, TheRasterizerFetchesWhatPathsFind) {
    // The floor before a wall again, white under a white sky; its baked texture in the material.
    Scene scene = sceneOf(
        {rectangle({0, 0, 0.5f}, {2, 0, 0}, {0, 0, -1}), rectangle({0, 0, -20}, {0, 0, 40}, {0, 1, 0})});
    constexpr std::uint32_t size = 32;
    const ImageF baked = bakeOf(scene, size, 256);
    TextureImage image{"occlusion", size, size, std::vector<float>()};
    for (std::size_t i = 0; i < std::size_t(size) * size; ++i) {
        const float v = baked.data[i * 3];
        auto& texels = std::get<std::vector<float>>(image.texels);
        texels.insert(texels.end(), {v, 0.0f, 0.0f, 1.0f});  // red alone counts
    }
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = 0;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    scene.textures.push_back(texture);
    const int white = addMaterial(scene, diffuse("white", glm::vec3(1)));
    for (Mesh& mesh : scene.meshes) mesh.primitives[0].material = white;
    addCamera(scene, {1, 2.5f, 0.6f}, {1, 0, 0}, 40);
    scene.environment = Environment{glm::vec3(1.0f), -1};

    RenderOptions options;
    options.size = {32, 32};
    const auto floorPixels = [&](const RenderResult& result) {
        std::vector<double> values;
        const std::size_t channels = result.image.channels.size();
        const auto red = std::size_t(result.image.channel("R")),
                   id = std::size_t(result.image.channel("id.instance"));
        for (std::size_t i = 0; i < 32 * 32; ++i)
            values.push_back(result.image.data[i * channels + id] == 0.0f
                                 ? double(result.image.data[i * channels + red])
                                 : -1.0);
        return values;
    };
    options.maxDepth = 1;
    options.samples = 256;
    const std::vector<double> paths = floorPixels(renderer().render(scene, options));
    options.maxDepth = -1;
    options.pipeline = Pipeline::Raster;
    const std::vector<double> open = floorPixels(renderer().render(scene, options));
    scene.materials[std::size_t(white)].occlusionTexture.texture = 0;
    const std::vector<double> occluded = floorPixels(renderer().render(scene, options));
    scene.materials[std::size_t(white)].occlusionStrength = 0.25f;
    const std::vector<double> quarter = floorPixels(renderer().render(scene, options));
    EXPECT_EQ(takeValidationMessages(), std::vector<std::string>());
    double sum = 0, truth = 0, squares = 0;
    int pixels = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i] < 0 || occluded[i] < 0) continue;
        ++pixels;
        sum += occluded[i];
        truth += paths[i];
        squares += (occluded[i] - paths[i]) * (occluded[i] - paths[i]);
        EXPECT_FLOAT_EQ(float(open[i]), 1.0f);
        EXPECT_NEAR(quarter[i], 1 + 0.25 * (occluded[i] - 1), 1e-5);
    }
    ASSERT_GT(pixels, 100);
    fmt::print("{} pixels: mean {:.4f}, of paths {:.4f}, RMS difference {:.4f}\n", pixels, sum / pixels,
               truth / pixels, std::sqrt(squares / pixels));
    EXPECT_NEAR(sum / truth, 1, 0.005);
    EXPECT_LT(std::sqrt(squares / pixels), 0.03);  // noise of 256 paths: about 0.02
}

/** A receiver about the origin that faces +y, and what shines on it. */
double irradianceUnder(Primitive lamp, glm::vec3 place = glm::vec3(0)) {
    Scene scene = sceneOf({rectangle({-0.005f, 0, 0.005f}, {0.01f, 0, 0}, {0, 0, -0.01f}), std::move(lamp)});
    const int glow = addMaterial(scene, diffuse("glow", glm::vec3(0)));
    scene.materials[std::size_t(glow)].emission = glm::vec3(1);
    scene.meshes[1].primitives[0].material = glow;
    scene.nodes[1].translation = place;
    const ImageF image = bakeIrradiance(device(), scene, {.size = 8, .samples = 512});
    double mean = 0;
    for (std::size_t i = 0; i < 64; ++i) mean += double(image.data[i * 3]) / 64;
    return mean;
}

TEST(BakeIrradiance, OfSquaresAndASphere) {
    const auto expect = [](const char* what, double found, double truth) {
        fmt::print("{}: {:.6f} for {:.6f}\n", what, found, truth);
        EXPECT_NEAR(found / truth, 1, 0.005) << what;
    };
    expect("square of side 1 at 1", irradianceUnder(rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1})),
           0.752274688454);
    expect("square of side 2 at 1", irradianceUnder(rectangle({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})),
           1.740839502730);
    Primitive sphere;
    sphere.shape = Shape{.kind = Shape::Kind::Sphere, .radius = 1};
    expect("sphere of radius 1 at 3", irradianceUnder(sphere, {0, 3, 0}), 0.349065850);
    expect("the same, 60 degrees off", irradianceUnder(sphere, {3 * std::sin(std::numbers::pi / 3), 1.5, 0}),
           0.174532925);
}

/** A cube of side 1 from the origin, seen from inside; each face has a ninth of the image. */
Primitive room() {
    Primitive p;
    p.texcoords.resize(1);
    const glm::vec3 corners[][3] = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                    {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
    for (std::uint32_t face = 0; face < 6; ++face) {
        const auto& [corner, u, v] = corners[face];
        const glm::vec2 at = glm::vec2(face % 3, face / 3) / 3.0f;
        for (const glm::vec2& s : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
            p.positions.push_back(corner + s.x * u + s.y * v);
            p.texcoords[0].push_back(at + s * 0.33f);
        }
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(face * 4 + k);
    }
    return p;
}

TEST(BakeIrradiance, OfAllReflectionsInAClosedRoom) {
    // Le = 1 and reflectance 1/2 on every wall: radiance 2 everywhere, of which 1 + ... + 2^-n has up to n
    // reflections.
    Scene scene = sceneOf({room()});
    const int shining = addMaterial(scene, diffuse("shining", glm::vec3(0.5f)));
    scene.materials[std::size_t(shining)].emission = glm::vec3(1);
    scene.meshes[0].primitives[0].material = shining;
    for (const auto& [depth, radiance] : {std::pair{-1, 2.0}, {0, 1.0}, {1, 1.5}, {2, 1.75}}) {
        const ImageF image = bakeIrradiance(device(), scene, {.size = 18, .samples = 64, .maxDepth = depth});
        double sum = 0;
        for (std::uint32_t y = 0; y < 12; ++y)
            for (std::uint32_t x = 0; x < 18; ++x) sum += double(image.at(x, y, 1)) / (12 * 18);
        fmt::print("depth {}: {:.5f} for {:.5f}\n", depth, sum, std::numbers::pi * radiance);
        EXPECT_NEAR(sum / (std::numbers::pi * radiance), 1, 0.005) << depth;
    }
}

TEST(BakeIrradiance, TheRasterizerShowsWhatPathsFind) {
    // A grey floor with a red wall, which colours it, under a lamp and a faint sky.
    Scene scene =
        sceneOf({rectangle({0, 0, 1}, {2, 0, 0}, {0, 0, -2}), rectangle({0, 0, -1}, {0, 0, 2}, {0, 1, 0}),
                 rectangle({0.5f, 1.5f, -0.5f}, {1, 0, 0}, {0, 0, 1})});
    const int grey = addMaterial(scene, diffuse("grey", glm::vec3(0.6f))),
              red = addMaterial(scene, diffuse("red", {0.8f, 0.1f, 0.1f})),
              glow = addMaterial(scene, diffuse("glow", glm::vec3(0)));
    scene.materials[std::size_t(glow)].emission = glm::vec3(2);
    const int materials[] = {grey, red, glow};
    for (std::size_t i = 0; i < 3; ++i) scene.meshes[i].primitives[0].material = materials[i];
    scene.environment = Environment{glm::vec3(0.2f), -1};
    addCamera(scene, {2.5f, 1.2f, 0.1f}, {1, 0, 0}, 40);

    const ImageF baked = bakeIrradiance(device(), scene, {.node = "node 0", .size = 32, .samples = 512});
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "heliograph-lightmap.exr";
    saveImage(file, baked);
    RenderOptions options;
    options.size = {40, 24};
    options.samples = 512;
    const RenderResult paths = renderer().render(scene, options);
    options.pipeline = Pipeline::Raster;
    const RenderResult live = renderer().render(scene, options);
    setLightmap(scene, "node 0", 0, loadImage(file));
    std::filesystem::remove(file);
    const RenderResult mapped = renderer().render(scene, options);
    EXPECT_EQ(takeValidationMessages(), std::vector<std::string>());
    const std::size_t channels = paths.image.channels.size();
    const auto first = std::size_t(paths.image.channel("R")),
               id = std::size_t(paths.image.channel("id.instance"));
    double squares = 0, liveSquares = 0;
    glm::dvec3 sum(0), truth(0);
    int pixels = 0;
    for (std::size_t i = 0; i < 40 * 24; ++i) {
        const std::size_t at = i * channels;
        if (paths.image.data[at + id] != mapped.image.data[at + id]) continue;
        if (paths.image.data[at + id] != 0) {
            if (mapped.image.data[at + id] >= 0) {
                EXPECT_EQ(mapped.image.data[at + first], live.image.data[at + first]);
            }
            continue;
        }
        ++pixels;
        for (std::size_t c = 0; c < 3; ++c) {
            const double path = paths.image.data[at + first + c], map = mapped.image.data[at + first + c];
            sum[glm::length_t(c)] += map;
            truth[glm::length_t(c)] += path;
            squares += (map - path) * (map - path);
            liveSquares += std::pow(double(live.image.data[at + first + c]) - path, 2);
        }
    }
    ASSERT_GT(pixels, 150);
    const glm::dvec3 ratio = sum / truth;
    const double scale = (truth.x + truth.y + truth.z) / (3 * pixels);
    fmt::print(
        "{} pixels: mean over that of paths {:.4f} {:.4f} {:.4f}; RMS difference {:.4f} of the mean, {:.4f} "
        "without the map\n",
        pixels, ratio.x, ratio.y, ratio.z, std::sqrt(squares / (3 * pixels)) / scale,
        std::sqrt(liveSquares / (3 * pixels)) / scale);
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(ratio[c], 1, 0.01);
    EXPECT_LT(squares, 0.1 * liveSquares);
}

TEST(BakeIrradiance, WhatItRefuses) {
    Primitive none = rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    none.texcoords.clear();
    Primitive twice = rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    twice.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0.5f, 0.0f}}};
    for (const Primitive& p : {none, twice})
        EXPECT_THROW((void)bakeIrradiance(device(), sceneOf({p}), {.size = 16, .samples = 1}), InputError);
    Scene good = sceneOf({rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1})}), bare = sceneOf({none});
    EXPECT_TRUE(
        bakeIrradiance(device(), good, {.size = 4, .samples = 1, .progress = [](double) { return false; }})
            .data.empty());
    ImageF image{2, 2, {"R", "G", "B"}, std::vector<float>(12, 1.0f), {}};
    EXPECT_THROW(setLightmap(good, "nobody", 0, image), InputError);
    EXPECT_THROW(setLightmap(good, "", 1, image), InputError);
    EXPECT_THROW(setLightmap(bare, "", 0, image), InputError);
    setLightmap(good, "", 0, image);
    EXPECT_NO_THROW(good.validate());
    image.data[5] = -1;
    EXPECT_THROW(setLightmap(good, "", 0, image), InputError);
    EXPECT_THROW(setLightmap(good, "", 0, ImageF{1, 1, {"Y"}, {1.0f}, {}}), InputError);
}

TEST(Bake, WhatItRefuses) {
    Primitive twice = rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    twice.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0.5f, 0.0f}}};  // folded over
    EXPECT_THROW(bakeOf(sceneOf({twice}), 16, 1), InputError);
    Primitive outside = rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    outside.texcoords[0][1] = {2, 0};
    EXPECT_THROW(bakeOf(sceneOf({outside}), 16, 1), InputError);
    Primitive none = rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
    none.texcoords.clear();
    EXPECT_THROW(bakeOf(sceneOf({none}), 16, 1), InputError);
    const Scene good = sceneOf({rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1})});
    EXPECT_THROW((void)bakeAmbientOcclusion(device(), good, {.node = "nobody"}), InputError);
    const ImageF stopped = bakeAmbientOcclusion(
        device(), good, {.size = 4, .samples = 1, .progress = [](double) { return false; }});
    EXPECT_TRUE(stopped.data.empty());
}

}  // namespace
}  // namespace helio::test
