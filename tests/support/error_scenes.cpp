#include "tests/support/error_scenes.hpp"

#include "tests/accuracy/path_scenes.hpp"

namespace helio::test {
namespace {

Scene room() {
    SceneBuilder builder;
    const int white = builder.material(glm::vec3(0.8f));
    const int red = builder.material({0.7f, 0.15f, 0.1f});
    builder.room({-1, 0, -3}, {1, 2, 3}, {red, white, white, white, white, white});
    const int lamp = builder.material(glm::vec3(0.0f), glm::vec3(6.0f), true);
    builder.quad({-0.5f, 1.9f, 2.2f}, {0.5f, 1.9f, 2.2f}, {0.5f, 1.9f, 2.8f}, {-0.5f, 1.9f, 2.8f}, lamp);
    builder.sphere({-0.4f, 0.5f, -1.6f}, 0.5f, 3, false, white);
    builder.camera({0, 1, 2}, {0, 0.9f, -3}, 0.8f);
    builder.scene.name = "room";
    return builder.scene;
}

Scene spheres() {
    SceneBuilder builder;
    const int light = builder.material(glm::vec3(0.7f)), dark = builder.material(glm::vec3(0.1f));
    const int blue = builder.material({0.15f, 0.25f, 0.7f}), orange = builder.material({0.8f, 0.4f, 0.1f});
    for (int z = -4; z < 4; ++z) {
        for (int x = -4; x < 4; ++x) {
            const auto corner = [](int i, int k) { return glm::vec3(float(i), 0.0f, float(k)); };
            builder.quad(corner(x, z), corner(x, z + 1), corner(x + 1, z + 1), corner(x + 1, z),
                         (x + z) % 2 == 0 ? light : dark);
        }
    }
    for (int i = 0; i < 5; ++i)
        builder.sphere({float(i) - 2.0f, 0.45f, float(i % 3) - 1.0f}, 0.45f, 3, false,
                       i % 2 == 0 ? blue : orange);
    builder.camera({0, 2.2f, 4.5f}, {0, 0.3f, 0}, 0.9f);
    builder.scene.environment = Environment{.radiance = {0.9f, 1.0f, 1.1f}};
    builder.scene.name = "spheres";
    return builder.scene;
}

/** A yard under sky and a lamp at a point, three blocks and walls of three colours round it. */
Scene yard() {
    SceneBuilder builder;
    const int stone = builder.material(glm::vec3(0.55f)), brick = builder.material({0.6f, 0.25f, 0.15f});
    const int green = builder.material({0.2f, 0.5f, 0.2f}), dark = builder.material(glm::vec3(0.15f));
    builder.quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}, stone);
    builder.quad({-3, 0, -3}, {3, 0, -3}, {3, 2.5f, -3}, {-3, 2.5f, -3}, brick);
    builder.quad({-3, 0, 3}, {-3, 0, -3}, {-3, 2.5f, -3}, {-3, 2.5f, 3}, green);
    builder.quad({3, 0, -3}, {3, 0, 3}, {3, 2.5f, 3}, {3, 2.5f, -3}, stone);
    const auto block = [&](glm::vec3 at, float side, float height, int material) {
        const glm::vec3 a = at, b = at + glm::vec3(side, 0, 0), c = at + glm::vec3(side, 0, -side),
                        d = at + glm::vec3(0, 0, -side), up(0, height, 0);
        builder.quad(a, b, b + up, a + up, material);
        builder.quad(b, c, c + up, b + up, material);
        builder.quad(c, d, d + up, c + up, material);
        builder.quad(d, a, a + up, d + up, material);
        builder.quad(a + up, b + up, c + up, d + up, material);
    };
    block({-1.8f, 0, -0.5f}, 1, 1.4f, stone);
    block({0.4f, 0, 0.2f}, 0.8f, 0.5f, dark);
    block({1.2f, 0, -1.4f}, 1, 2, brick);
    builder.pointLight({1, 4, 2}, {14, 12, 9});
    builder.camera({0.3f, 2.2f, 5.5f}, {0, 0.7f, -1}, 0.8f);
    builder.scene.environment = Environment{.radiance = {0.4f, 0.5f, 0.7f}};
    builder.scene.name = "yard";
    return builder.scene;
}

/** Rough metals, a glossy coat on the floor and two coloured lamps. */
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
    builder.scene.name = "metals";
    return builder.scene;
}

/** A wide lamp behind slats: half shadows wherever one looks. */
Scene blinds() {
    SceneBuilder builder;
    const int white = builder.material(glm::vec3(0.65f)), blue = builder.material({0.3f, 0.4f, 0.6f});
    const int slat = builder.material({0.5f, 0.4f, 0.25f}, glm::vec3(0), true);
    builder.quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}, white);
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
    builder.scene.name = "blinds";
    return builder.scene;
}

}  // namespace

Scene errorScene(const std::string& name) {
    if (name == "room") return room();
    if (name == "spheres") return spheres();
    if (name == "yard") return yard();
    if (name == "metals") return metals();
    if (name == "blinds") return blinds();
    return load("sample:" + name);
}

}  // namespace helio::test
