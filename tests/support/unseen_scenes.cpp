#include "tests/support/unseen_scenes.hpp"

#include "tests/support/scene_parts.hpp"

#include <cmath>

namespace helio::test {
namespace {

/** A glossy surface of glTF's. */
int glossy(SceneBuilder& builder, glm::vec3 color, float metallic, float roughness) {
    const int index = builder.material(color);
    Material& material = builder.scene.materials[std::size_t(index)];
    material.metallic = metallic;
    material.roughness = roughness;
    material.specular = 1;
    return index;
}

/** Puts an image on the last mesh, a square, `times` across. */
template <typename Value>
void patterned(SceneBuilder& builder, int material, float times, std::uint32_t size, Value value) {
    Scene& scene = builder.scene;
    scene.meshes.back().primitives[0].texcoords = {
        {{0, 0}, {times, 0}, {times, times}, {0, 0}, {times, times}, {0, times}}};
    scene.textures.push_back({.name = "", .image = addImage(scene, size, size, value)});
    scene.materials[std::size_t(material)].baseColorTexture.texture = int(scene.textures.size()) - 1;
}

void lampAt(SceneBuilder& builder, glm::vec3 centre, float half, glm::vec3 radiance) {
    builder.quad(centre + glm::vec3(-half, 0, -half), centre + glm::vec3(half, 0, -half),
                 centre + glm::vec3(half, 0, half), centre + glm::vec3(-half, 0, half),
                 builder.material(glm::vec3(0), radiance));
}

}  // namespace

Scene studioScene() {
    SceneBuilder builder;
    const int tiles = glossy(builder, glm::vec3(0.9f), 0, 0.5f);
    floorUnder(builder, 5, tiles);
    patterned(builder, tiles, 9, 8, [](float u, float v) {
        return (u < 0.5f) != (v < 0.5f) ? glm::vec3(0.8f, 0.75f, 0.7f) : glm::vec3(0.12f, 0.1f, 0.14f);
    });
    builder.sphere({-1.1f, 0.6f, 0.1f}, 0.6f, 4, false, glossy(builder, {0.7f, 0.2f, 0.15f}, 0, 0.3f));
    builder.sphere({0.3f, 0.5f, 0.6f}, 0.5f, 4, false, glossy(builder, {0.9f, 0.75f, 0.4f}, 1, 0.45f));
    block(builder, {0.9f, 0, -0.2f}, 0.7f, 1.2f, builder.material({0.3f, 0.45f, 0.6f}));
    lampAt(builder, {-2, 3.2f, 1.5f}, 0.08f, glm::vec3(350, 300, 220));
    lampAt(builder, {1.8f, 3.5f, 0.5f}, 0.4f, glm::vec3(12, 13, 15));
    lampAt(builder, {0, 5, -1}, 1.5f, glm::vec3(0.8f));
    builder.camera({0.2f, 1.5f, 4.4f}, {0, 0.5f, 0}, 0.75f);
    return builder.scene;
}

Scene parlourScene() {
    SceneBuilder builder;
    const int plaster = builder.material({0.72f, 0.7f, 0.66f}), rug = builder.material({0.5f, 0.15f, 0.12f});
    const int wood = glossy(builder, {0.45f, 0.28f, 0.15f}, 0, 0.4f);
    floorUnder(builder, 2, wood, {0, 0, 0.5f});
    floorUnder(builder, 0.8f, rug, {-0.2f, 0.01f, 0.3f});
    builder.quad({-2, 0, -1.5f}, {2, 0, -1.5f}, {2, 2.4f, -1.5f}, {-2, 2.4f, -1.5f}, plaster);
    builder.quad({2, 0, -1.5f}, {2, 0, 2.5f}, {2, 2.4f, 2.5f}, {2, 2.4f, -1.5f}, plaster);
    builder.quad({-2, 2.4f, -1.5f}, {2, 2.4f, -1.5f}, {2, 2.4f, 2.5f}, {-2, 2.4f, 2.5f}, plaster);
    // The left wall has a window.
    builder.quad({-2, 0, 2.5f}, {-2, 0, -1.5f}, {-2, 0.8f, -1.5f}, {-2, 0.8f, 2.5f}, plaster);
    builder.quad({-2, 0.8f, 2.5f}, {-2, 0.8f, 1.2f}, {-2, 2.4f, 1.2f}, {-2, 2.4f, 2.5f}, plaster);
    builder.quad({-2, 0.8f, -0.4f}, {-2, 0.8f, -1.5f}, {-2, 2.4f, -1.5f}, {-2, 2.4f, -0.4f}, plaster);
    builder.quad({-2, 2, 1.2f}, {-2, 2, -0.4f}, {-2, 2.4f, -0.4f}, {-2, 2.4f, 1.2f}, plaster);
    block(builder, {0.5f, 0, 0.2f}, 0.7f, 0.5f, wood);
    builder.sphere({0.85f, 0.75f, -0.15f}, 0.25f, 4, false, builder.material({0.2f, 0.4f, 0.6f}));
    lampAt(builder, {1, 2.38f, -0.6f}, 0.3f, glm::vec3(6, 5, 3.5f));
    builder.scene.environment = Environment{.radiance = {2.5f, 2.9f, 3.5f}};
    builder.camera({0, 1.2f, 3.2f}, {-0.2f, 0.95f, -1}, 0.9f);
    return builder.scene;
}

Scene bazaarScene() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int sand = builder.material({0.6f, 0.5f, 0.35f}), wall = builder.material(glm::vec3(1));
    floorUnder(builder, 4, sand);
    builder.quad({-3, 0, -1.5f}, {3, 0, -1.5f}, {3, 6, -1.5f}, {-3, 6, -1.5f}, wall);
    patterned(builder, wall, 3, 32, [](float u, float v) {
        const float ring = std::sin(40 * std::hypot(u - 0.5f, v - 0.5f));
        return ring > 0 ? glm::vec3(0.75f, 0.5f * u + 0.2f, 0.2f) : glm::vec3(0.1f, 0.25f, 0.35f * v + 0.1f);
    });
    const int cloth = builder.material({0.3f, 0.05f, 0.15f}),
              paint = glossy(builder, {0.05f, 0.3f, 0.2f}, 0, 0.6f);
    scene.materials[std::size_t(cloth)].sheenColor = {0.8f, 0.6f, 0.4f};
    scene.materials[std::size_t(cloth)].sheenRoughness = 0.35f;
    scene.materials[std::size_t(paint)].clearcoat = 1;
    scene.materials[std::size_t(paint)].clearcoatRoughness = 0.3f;
    builder.sphere({-1.1f, 0.65f, 0}, 0.65f, 4, false, cloth);
    builder.sphere({0.4f, 0.55f, 0.5f}, 0.55f, 4, false, paint);
    builder.sphere({1.5f, 0.5f, -0.3f}, 0.5f, 4, false, glossy(builder, {0.8f, 0.5f, 0.3f}, 1, 0.35f));
    const int around = addImage(scene, 64, 32, [](float u, float v) {
        const float softBox = std::abs(u - 0.2f) < 0.06f && std::abs(v - 0.35f) < 0.1f ? 14.0f : 0.0f;
        const float window = std::abs(u - 0.6f) < 0.1f && std::abs(v - 0.4f) < 0.15f ? 3.0f : 0.0f;
        return glm::vec3(0.25f, 0.24f, 0.22f) + glm::vec3(1, 0.9f, 0.7f) * softBox +
               glm::vec3(0.7f, 0.85f, 1) * window;
    });
    scene.environment = Environment{glm::vec3(1), around, {1, 0, 0, 0}};
    builder.camera({0.3f, 1.4f, 4.3f}, {0.1f, 0.7f, 0}, 0.75f);
    return scene;
}

Scene frostScene() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int stripes = builder.material(glm::vec3(1));
    floorUnder(builder, 4, stripes);
    patterned(builder, stripes, 8, 16, [](float u, float) {
        return u < 0.5f ? glm::vec3(0.75f, 0.7f, 0.6f) : glm::vec3(0.2f, 0.35f, 0.25f);
    });
    const int glass = builder.material(glm::vec3(1));
    Scattering frosted;
    frosted.model = Scattering::Model::Dielectric;
    frosted.alpha = glm::vec2(0.4f);
    scene.materials[std::size_t(glass)].scattering = frosted;
    builder.sphere({-0.5f, 0.7f, 0.3f}, 0.7f, 4, false, glass);
    block(builder, {0.5f, 0, -0.2f}, 0.8f, 1.2f, builder.material({0.65f, 0.3f, 0.2f}));
    const int sky = addImage(scene, 32, 16, [](float u, float v) {
        return glm::vec3(0.5f, 0.7f, 1) * (0.4f + 1.6f * (1 - v) * (1 - v)) + glm::vec3(0.4f * u, 0.1f, 0);
    });
    scene.environment = Environment{glm::vec3(1), sky, {1, 0, 0, 0}};
    builder.camera({0.1f, 1.5f, 4.2f}, {0, 0.6f, 0}, 0.75f);
    return scene;
}

Scene porticoScene() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int marble = builder.material({0.75f, 0.72f, 0.68f}),
              paving = builder.material({0.45f, 0.42f, 0.4f});
    floorUnder(builder, 5, paving);
    block(builder, {-2.5f, 2.2f, 0.4f}, 5, 0.4f, marble);
    for (int i = 0; i < 5; ++i)
        for (const float z : {0.3f, -1.5f}) block(builder, {-2.1f + float(i), 0, z}, 0.3f, 2.2f, marble);
    const int sky = addImage(scene, 128, 64, [](float u, float v) {
        const float x = (u - 0.68f) * 6.2831853f, y = (v - 0.3f) * 3.1415927f;
        const bool sun = std::hypot(0.8f * x, y) < 0.052f;
        return sun ? glm::vec3(260, 230, 180) : glm::vec3(0.35f, 0.5f, 0.8f) * (v < 0.5f ? 1.0f : 0.25f);
    });
    scene.environment = Environment{glm::vec3(1), sky, {1, 0, 0, 0}};
    builder.camera({1.2f, 1.4f, 4.6f}, {-0.1f, 1, -0.5f}, 0.85f);
    return scene;
}

}  // namespace helio::test
