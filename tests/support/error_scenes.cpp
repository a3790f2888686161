#include "tests/support/error_scenes.hpp"

#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/held_out_scenes.hpp"

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
    return builder.scene;
}

}  // namespace

Scene errorScene(const std::string& name) {
    const auto heldOut = heldOutScenes().find(name);
    Scene scene = name == "room"                     ? room()
                  : name == "spheres"                ? spheres()
                  : heldOut != heldOutScenes().end() ? heldOut->second()
                                                     : load("sample:" + name);
    scene.name = name;
    return scene;
}

}  // namespace helio::test
