#include "tests/support/held_out_scenes.hpp"

#include "tests/support/scene_parts.hpp"
#include "tests/support/unseen_scenes.hpp"

#include <cmath>

namespace helio::test {
namespace {

Scene yard() {
    SceneBuilder builder;
    const int stone = builder.material(glm::vec3(0.55f)), brick = builder.material({0.6f, 0.25f, 0.15f});
    const int green = builder.material({0.2f, 0.5f, 0.2f}), dark = builder.material(glm::vec3(0.15f));
    floorUnder(builder, 3, stone);
    builder.quad({-3, 0, -3}, {3, 0, -3}, {3, 2.5f, -3}, {-3, 2.5f, -3}, brick);
    builder.quad({-3, 0, 3}, {-3, 0, -3}, {-3, 2.5f, -3}, {-3, 2.5f, 3}, green);
    builder.quad({3, 0, -3}, {3, 0, 3}, {3, 2.5f, 3}, {3, 2.5f, -3}, stone);
    block(builder, {-1.8f, 0, -0.5f}, 1, 1.4f, stone);
    block(builder, {0.4f, 0, 0.2f}, 0.8f, 0.5f, dark);
    block(builder, {1.2f, 0, -1.4f}, 1, 2, brick);
    builder.pointLight({1, 4, 2}, {14, 12, 9});
    builder.camera({0.3f, 2.2f, 5.5f}, {0, 0.7f, -1}, 0.8f);
    builder.scene.environment = Environment{.radiance = {0.4f, 0.5f, 0.7f}};
    return builder.scene;
}

Scene metals() {
    SceneBuilder builder;
    const int floor = builder.material({0.4f, 0.35f, 0.3f}), wall = builder.material(glm::vec3(0.6f));
    const int warm = builder.material(glm::vec3(0), {9, 6, 3}, true);
    const int cold = builder.material(glm::vec3(0), {1, 2, 4}, true);
    const auto metal = [&](glm::vec3 color, float roughness) {
        const int index = builder.material(color);
        Material& material = builder.scene.materials[std::size_t(index)];
        material.metallic = 1;
        material.roughness = roughness;
        material.specular = 1;
        return index;
    };
    builder.scene.materials[std::size_t(floor)].specular = 1;
    builder.scene.materials[std::size_t(floor)].roughness = 0.6f;
    builder.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -3}, {-4, 0, -3}, floor);
    builder.quad({-4, 0, -3}, {4, 0, -3}, {4, 5, -3}, {-4, 5, -3}, wall);
    builder.quad({-2.5f, 3.5f, -1}, {-1, 3.5f, -1}, {-1, 3.5f, 0.5f}, {-2.5f, 3.5f, 0.5f}, warm);
    builder.quad({1, 2.5f, 2}, {3.5f, 2.5f, 2}, {3.5f, 4, 1}, {1, 4, 1}, cold);
    builder.sphere({-1.3f, 0.7f, -0.6f}, 0.7f, 3, false, metal({0.9f, 0.7f, 0.4f}, 0.6f));
    builder.sphere({0.4f, 0.6f, 0.3f}, 0.6f, 3, false, metal({0.9f, 0.5f, 0.4f}, 0.75f));
    builder.sphere({1.7f, 0.8f, -0.9f}, 0.8f, 3, false, metal(glm::vec3(0.85f), 0.9f));
    builder.camera({0, 1.8f, 5}, {0, 0.8f, -0.5f}, 0.75f);
    return builder.scene;
}

Scene blinds() {
    SceneBuilder builder;
    const int white = builder.material(glm::vec3(0.65f)), blue = builder.material({0.3f, 0.4f, 0.6f});
    const int slat = builder.material({0.5f, 0.4f, 0.25f}, glm::vec3(0), true);
    floorUnder(builder, 3, white);
    builder.quad({-3, 0, -3}, {3, 0, -3}, {3, 3, -3}, {-3, 3, -3}, blue);
    const int lamp = builder.material(glm::vec3(0), glm::vec3(5), true);
    builder.quad({-3, 0.5f, -2}, {-3, 0.5f, 2}, {-3, 3, 2}, {-3, 3, -2}, lamp);
    for (int i = 0; i < 12; ++i) {
        const float y = 0.2f + 0.25f * float(i);
        builder.quad({-2, y, 2.2f}, {-1.85f, y + 0.1f, 2.2f}, {-1.85f, y + 0.1f, -2.2f}, {-2, y, -2.2f},
                     slat);
    }
    builder.sphere({0.5f, 0.6f, -0.5f}, 0.6f, 3, false, white);
    builder.camera({1.5f, 1.6f, 5}, {0, 0.9f, -1}, 0.8f);
    return builder.scene;
}

Scene garden() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int tiles = builder.material(glm::vec3(0.8f)), clay = builder.material({0.7f, 0.4f, 0.25f});
    const int leaf = builder.material({0.25f, 0.5f, 0.2f});
    floorUnder(builder, 4, tiles);
    scene.meshes.back().primitives[0].texcoords = {{{0, 0}, {6, 0}, {6, 6}, {0, 0}, {6, 6}, {0, 6}}};
    scene.textures.push_back({.name = "", .image = addImage(scene, 16, 16, [](float u, float v) {
                                              const bool odd = (u < 0.5f) != (v < 0.5f);
                                              return odd ? glm::vec3(0.9f, 0.85f, 0.7f)
                                                         : glm::vec3(0.3f, 0.32f + 0.3f * u, 0.4f);
                                          })});
    scene.materials[std::size_t(tiles)].baseColorTexture.texture = 0;
    builder.sphere({-0.9f, 0.8f, -0.5f}, 0.8f, 3, false, leaf);
    block(builder, {0.5f, 0, 0.3f}, 0.9f, 1.1f, clay);
    builder.camera({0.2f, 1.9f, 4.5f}, {0, 0.5f, -0.3f}, 0.8f);
    // A bright veil of the sun some 20 degrees wide over a sky that pales towards the horizon.
    const int sky = addImage(scene, 64, 32, [](float u, float v) {
        const float up = std::cos(3.14159265f * v);
        const float sun = std::exp(-40 * ((u - 0.7f) * (u - 0.7f) * 4 + (v - 0.25f) * (v - 0.25f)));
        return glm::vec3(0.5f, 0.6f, 0.9f) * (up > 0 ? 1.2f - 0.8f * up : 0.3f) + glm::vec3(9, 8, 6) * sun;
    });
    scene.environment = Environment{glm::vec3(1), sky, {1, 0, 0, 0}};
    return scene;
}

Scene shelf() {
    SceneBuilder builder;
    const int wood = builder.material({0.5f, 0.33f, 0.2f}), wall = builder.material({0.6f, 0.62f, 0.55f});
    const int lamp = builder.material(glm::vec3(0), {7, 6.5f, 6}, true);
    floorUnder(builder, 3, wood);
    builder.quad({-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}, wall);
    builder.quad({-1.2f, 3, 0.2f}, {1.2f, 3, 0.2f}, {1.2f, 3, 1.4f}, {-1.2f, 3, 1.4f}, lamp);
    for (int i = 0; i < 5; ++i) {
        const float x = -1.6f + 0.8f * float(i), z = 1.6f - 0.7f * float(i);
        builder.sphere({x, 0.35f, z}, 0.35f, 3, false,
                       builder.material({0.2f + 0.12f * float(i), 0.45f, 0.75f - 0.1f * float(i)}));
    }
    builder.camera({0, 1.3f, 4.6f}, {0, 0.5f, 0}, 0.7f);
    Camera& camera = builder.scene.cameras[0];
    camera.lens = ThinLens{.apertureDiameter = 0.25f, .focusDistance = 4.4f, .blades = 6};
    return builder.scene;
}

Scene pane() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int light = builder.material(glm::vec3(0.75f)), dark = builder.material({0.15f, 0.12f, 0.3f});
    for (int z = -3; z < 3; ++z)
        for (int x = -3; x < 3; ++x)
            floorUnder(builder, 0.5f, (x + z) % 2 == 0 ? light : dark, {float(x) + 0.5f, 0, float(z) + 0.5f});
    block(builder, {-0.8f, 0, -0.6f}, 0.8f, 1, builder.material({0.7f, 0.5f, 0.2f}));
    const int glass = builder.material(glm::vec3(1));
    Scattering scattering;
    scattering.model = Scattering::Model::Dielectric;
    scene.materials[std::size_t(glass)].scattering = scattering;
    // A slab before the block: its front and back, far wider than what is seen through it.
    block(builder, {-1.2f, 0.01f, 1.3f}, 2.4f, 1.5f, glass);
    scene.environment = Environment{.radiance = {0.8f, 0.9f, 1.1f}};
    builder.camera({0.4f, 1.4f, 4.6f}, {0, 0.5f, 0}, 0.75f);
    return scene;
}

/** A box like Cornell's with two lamps, a centimetre below its ceiling. */
Scene cellar(bool lightsCeiling) {
    SceneBuilder builder;
    const int plaster = builder.material({0.7f, 0.68f, 0.6f}), red = builder.material({0.6f, 0.12f, 0.1f});
    const int blue = builder.material({0.12f, 0.2f, 0.55f});
    builder.room({-1.5f, 0, -1.5f}, {1.5f, 2.4f, 2.5f}, {red, blue, plaster, plaster, plaster, plaster});
    const int lamp = builder.material(glm::vec3(0), {8, 7, 5}, lightsCeiling);
    builder.quad({-1.1f, 2.39f, -0.9f}, {-0.5f, 2.39f, -0.9f}, {-0.5f, 2.39f, -0.3f}, {-1.1f, 2.39f, -0.3f},
                 lamp);
    builder.quad({0.6f, 2.39f, 0.4f}, {1.2f, 2.39f, 0.4f}, {1.2f, 2.39f, 1}, {0.6f, 2.39f, 1}, lamp);
    block(builder, {-0.9f, 0, 0}, 0.7f, 1.3f, plaster);
    block(builder, {0.3f, 0, 0.6f}, 0.6f, 0.6f, plaster);
    builder.camera({0, 1.2f, 2.3f}, {0, 1, -1.5f}, 1.0f);
    return builder.scene;
}

Scene lacquer() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const auto glossy = [&](glm::vec3 color, float roughness, float coat) {
        const int index = builder.material(color);
        Material& material = scene.materials[std::size_t(index)];
        material.roughness = roughness;
        material.specular = 1;
        material.clearcoat = coat;
        material.clearcoatRoughness = 0.5f;
        return index;
    };
    floorUnder(builder, 4, glossy({0.35f, 0.3f, 0.28f}, 0.5f, 0));
    builder.sphere({-1.2f, 0.7f, 0}, 0.7f, 4, false, glossy({0.7f, 0.1f, 0.1f}, 0.6f, 1));
    builder.sphere({0.4f, 0.5f, 0.7f}, 0.5f, 4, false, glossy({0.1f, 0.4f, 0.6f}, 0.45f, 0));
    block(builder, {0.9f, 0, -0.3f}, 0.9f, 1.4f, glossy({0.75f, 0.7f, 0.3f}, 0.7f, 0.6f));
    builder.pointLight({-2, 3, 3}, {18, 18, 20});
    scene.environment = Environment{.radiance = {0.35f, 0.33f, 0.3f}};
    builder.camera({0, 1.6f, 4.8f}, {0, 0.6f, 0}, 0.75f);
    return scene;
}

/** A floor and a wall, and lamps from a twentieth of a pixel to two across of a 64x64 picture. */
Scene stars() {
    SceneBuilder builder;
    floorUnder(builder, 4, builder.material({0.45f, 0.4f, 0.35f}));
    builder.quad({-4, 0, -3}, {4, 0, -3}, {4, 5, -3}, {-4, 5, -3}, builder.material(glm::vec3(0.3f)));
    for (int i = 0; i < 24; ++i) {
        const float size = 0.003f * std::pow(1.18f, float(i));
        const glm::vec3 at(-2.3f + 0.2f * float(i), 0.5f + 0.09f * float(i * 7 % 24),
                           0.3f * float(i % 5) - 1);
        builder.sphere(
            at, size, 2, false,
            builder.material(glm::vec3(0), glm::vec3(0.1f / (size * size), 0.08f / (size * size), 0.1f)));
    }
    builder.camera({0, 1.5f, 5}, {0, 1.2f, 0}, 0.9f);
    return builder.scene;
}

Scene sunlit() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    floorUnder(builder, 4, builder.material({0.5f, 0.45f, 0.3f}));
    block(builder, {-1.3f, 0, 0.2f}, 0.8f, 1.6f, builder.material(glm::vec3(0.7f)));
    const int paint = builder.material({0.1f, 0.3f, 0.6f});
    scene.materials[std::size_t(paint)].specular = 1;
    scene.materials[std::size_t(paint)].roughness = 0.35f;
    builder.sphere({0.8f, 0.7f, 0}, 0.7f, 4, false, paint);
    const int sky = addImage(scene, 128, 64, [](float u, float v) {
        const bool sun = std::abs(u - 0.62f) < 0.008f && std::abs(v - 0.3f) < 0.016f;
        return sun ? glm::vec3(4000, 3600, 3000) : glm::vec3(0.3f, 0.5f, 0.9f) * (v < 0.5f ? 1.0f : 0.3f);
    });
    scene.environment = Environment{glm::vec3(1), sky, {1, 0, 0, 0}};
    builder.camera({0.4f, 1.7f, 4.5f}, {0, 0.6f, 0}, 0.8f);
    return scene;
}

Scene quilt() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int cloth = builder.material(glm::vec3(1));
    floorUnder(builder, 6, cloth);
    scene.meshes.back().primitives[0].texcoords = {{{0, 0}, {20, 0}, {20, 20}, {0, 0}, {20, 20}, {0, 20}}};
    scene.textures.push_back({.name = "", .image = addImage(scene, 64, 64, [](float u, float v) {
                                              const int x = int(64 * u), y = int(64 * v);
                                              const bool thread = (x * 7 + y * 13) % 5 == 0 || x % 16 == 0;
                                              return thread ? glm::vec3(0.95f, 0.9f, 0.8f)
                                                            : glm::vec3(0.03f + 0.3f * u, 0.05f, 0.2f * v);
                                          })});
    scene.materials[std::size_t(cloth)].baseColorTexture.texture = 0;
    builder.sphere({0.2f, 0.6f, 0.4f}, 0.6f, 4, false, builder.material({0.6f, 0.6f, 0.3f}));
    const int lamp = builder.material(glm::vec3(0), {20, 19, 17}, true);
    builder.quad({-1.5f, 3.5f, -1}, {-0.7f, 3.5f, -1}, {-0.7f, 3.5f, -0.4f}, {-1.5f, 3.5f, -0.4f}, lamp);
    builder.camera({0.3f, 1.6f, 4.5f}, {0, 0.3f, 0}, 0.8f);
    return scene;
}

Scene workshop() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    builder.room({-1.5f, 0, -1.5f}, {1.5f, 2.2f, 2.6f},
                 {builder.material({0.5f, 0.3f, 0.2f}), builder.material({0.2f, 0.4f, 0.5f}),
                  builder.material(glm::vec3(0.4f)), builder.material(glm::vec3(0.6f)),
                  builder.material(glm::vec3(0.55f)), builder.material(glm::vec3(0.6f))});
    for (int i = 0; i < 3; ++i) {
        const int metal = builder.material({0.9f, 0.8f - 0.2f * float(i), 0.6f});
        scene.materials[std::size_t(metal)].metallic = 1;
        scene.materials[std::size_t(metal)].specular = 1;
        scene.materials[std::size_t(metal)].roughness = 0.15f + 0.15f * float(i);
        builder.sphere({-0.9f + 0.9f * float(i), 0.4f, -0.4f}, 0.4f, 4, false, metal);
    }
    const int lamp = builder.material(glm::vec3(0), {90, 80, 60}, true);
    builder.quad({-0.12f, 2.1f, 0}, {0.12f, 2.1f, 0}, {0.12f, 2.1f, 0.24f}, {-0.12f, 2.1f, 0.24f}, lamp);
    builder.camera({0, 1.1f, 2.4f}, {0, 0.7f, -1}, 0.9f);
    return scene;
}

Scene aquarium() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    builder.room({-1.5f, 0, -1.5f}, {1.5f, 2.2f, 2.6f},
                 {builder.material({0.6f, 0.5f, 0.4f}), builder.material({0.3f, 0.5f, 0.5f}),
                  builder.material(glm::vec3(0.6f)), builder.material(glm::vec3(0.6f)),
                  builder.material(glm::vec3(0.6f)), builder.material(glm::vec3(0.6f))});
    const int glass = builder.material(glm::vec3(1));
    Scattering scattering;
    scattering.model = Scattering::Model::Dielectric;
    scene.materials[std::size_t(glass)].scattering = scattering;
    builder.sphere({-0.3f, 0.6f, -0.2f}, 0.5f, 4, false, glass);
    const int lamp = builder.material(glm::vec3(0), {12, 12, 11}, true);
    builder.quad({-0.6f, 2.15f, -0.6f}, {0.6f, 2.15f, -0.6f}, {0.6f, 2.15f, 0.6f}, {-0.6f, 2.15f, 0.6f},
                 lamp);
    builder.camera({0, 1.1f, 2.4f}, {0, 0.7f, -1}, 0.9f);
    return scene;
}

}  // namespace

const std::map<std::string, Scene (*)()>& heldOutScenes() {
    static const std::map<std::string, Scene (*)()> scenes = {{"yard", yard},
                                                              {"metals", metals},
                                                              {"blinds", blinds},
                                                              {"garden", garden},
                                                              {"shelf", shelf},
                                                              {"pane", pane},
                                                              {"hall", [] { return cellar(false); }},
                                                              {"cellar", [] { return cellar(true); }},
                                                              {"lacquer", lacquer},
                                                              {"stars", stars},
                                                              {"sunlit", sunlit},
                                                              {"quilt", quilt},
                                                              {"workshop", workshop},
                                                              {"aquarium", aquarium},
                                                              {"studio", studioScene},
                                                              {"parlour", parlourScene},
                                                              {"bazaar", bazaarScene},
                                                              {"frost", frostScene},
                                                              {"portico", porticoScene}};
    return scenes;
}

}  // namespace helio::test
