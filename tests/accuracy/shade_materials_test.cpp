// Materials under punctual lights in the raster pipeline: the path tracer's picture of the same light.
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace helio {
namespace {

Material gltf(glm::vec3 color, float metallic, float roughness) {
    Material m;
    m.baseColor = glm::vec4(color, 1);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

/** Plates side by side at z = 0, with a tilted normal map on one. */
Scene plates(const std::vector<Material>& materials) {
    Scene scene;
    scene.name = "plates";
    scene.images.push_back({"tilt", 1, 1, std::vector<float>{0.65f, 0.5f, 0.95f, 1}});
    scene.textures.push_back({});
    scene.textures[0].image = 0;
    scene.materials = materials;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const float x = float(i);
        Primitive p;
        p.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
        p.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
        p.indices = {0, 1, 2, 0, 2, 3};
        p.material = int(i);
        scene.meshes.push_back({"plate", {p}});
        Node node;
        node.mesh = int(i);
        scene.nodes.push_back(node);
    }
    // One light: no choice among several puts noise into the path tracer's picture.
    for (glm::vec3 place : {glm::vec3(3.2f, 2, 2.5f)}) {
        PunctualLight light;
        light.intensity = glm::vec3(4, 3, 2);
        scene.lights.push_back(light);
        Node node;
        node.light = int(scene.lights.size()) - 1;
        node.translation = place;
        scene.nodes.push_back(node);
    }
    Camera camera;
    camera.perspective = false;
    camera.ymag = 0.5f;
    scene.cameras = {camera};
    Node eye;
    eye.camera = 0;
    eye.translation = {0.5f * float(materials.size()), 0.5f, 5};
    scene.nodes.push_back(eye);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) scene.roots.push_back(int(i));
    return scene;
}

TEST(RasterMaterials, PunctualLightIsThePathTracers) {
    std::vector<Material> materials{gltf({0.9f, 0.6f, 0.2f}, 1, 0.5f), gltf({0.2f, 0.5f, 0.7f}, 0, 0.4f),
                                    Material{}};
    Material coated = gltf({0.5f, 0.1f, 0.1f}, 0.5f, 0.8f);
    coated.clearcoat = 1;
    coated.clearcoatRoughness = 0.5f;
    materials.push_back(coated);
    Material tilted = gltf(glm::vec3(0.6f), 0, 0.6f);
    tilted.normalTexture.texture = 0;
    materials.push_back(tilted);
    Material velvet = gltf({0.2f, 0.1f, 0.1f}, 0, 1);
    velvet.sheenColor = glm::vec3(0.8f);
    velvet.sheenRoughness = 0.6f;
    materials.push_back(velvet);
    Material copper = gltf(glm::vec3(1), 1, 1);
    copper.scattering = Scattering{};
    copper.scattering->model = Scattering::Model::Conductor;
    copper.scattering->n = {0.2f, 1.1f, 1.2f};
    copper.scattering->k = {3.4f, 2.6f, 2.5f};
    copper.scattering->alpha = {0.3f, 0.5f};
    materials.push_back(copper);
    const Scene scene = plates(materials);

    Renderer renderer(test::deviceOptions());
    RenderOptions options;
    constexpr std::uint32_t side = 24;
    options.size = {side * std::uint32_t(materials.size()), side};
    options.samples = 16;
    options.maxDepth = 1;
    options.auxiliary = false;
    options.environment = Environment{glm::vec3(0), -1};
    const RenderResult path = renderer.render(scene, options);
    options.pipeline = Pipeline::Raster;
    options.shadows.kind = Shadows::Kind::None;
    const RenderResult raster = renderer.render(scene, options);
    for (std::size_t i = 0; i < materials.size(); ++i)
        for (std::size_t y = 1; y + 1 < side; ++y)
            for (std::size_t x = 1; x + 1 < side; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t pixel = y * options.size[0] + i * side + x;
                    const float a = raster.image.data[pixel * raster.image.channels.size() + c];
                    const float b = path.image.data[pixel * path.image.channels.size() + c];
                    // A pixel's centre for its mean: a few thousandths where highlights bend.
                    ASSERT_NEAR(a, b, 0.01f * b + 1e-4f) << "material " << i << " at " << x << ", " << y;
                    ASSERT_GT(b, 0.0f);
                }
    // What it leaves out is said.
    bool gloss = false;
    for (const auto& [what, why] : raster.skipped) gloss = gloss || what == "gloss of area lights";
    EXPECT_TRUE(gloss);
}

}  // namespace
}  // namespace helio
