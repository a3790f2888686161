/** @file
 * A wheel of six spokes that rolls by in a second, one turn on the way, through a shutter that opens at once
 * and through one that rolls down the picture: blur in proportion to speed, none where the wheel touches the
 * ground; bent spokes.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <cmath>

namespace helio::samples::wheel {
namespace {

constexpr float pi = 3.14159265f;

Scene makeWheel() {
    Scene scene;
    const int ground = addMaterial(scene, diffuse("ground", glm::vec3(0.45f)));
    addRoot(scene, "ground",
            addMesh(scene, "ground", quadShape({-20, -1, 10}, {40, 0, 0}, {0, 0, -30}, ground)));
    const int spokes = addMaterial(scene, diffuse("spokes", glm::vec3(0.75f, 0.3f, 0.15f)));
    const int rim = addMaterial(scene, diffuse("rim", glm::vec3(0.15f)));
    Node wheel;
    wheel.name = "wheel";
    Mesh mesh;
    mesh.name = "wheel";
    for (int i = 0; i < 3; ++i) {
        const float angle = pi * float(i) / 3;
        const glm::vec3 depth(0, 0, 0.01f * float(i + 1));  // before one another and the rim
        const glm::vec3 along(std::cos(angle), std::sin(angle), 0), across(-along.y, along.x, 0);
        mesh.primitives.push_back(
            quadShape(-0.9f * along - 0.05f * across + depth, 1.8f * along, 0.1f * across, spokes));
    }
    constexpr int sides = 48;
    for (int i = 0; i < sides; ++i) {
        const auto at = [&](int k) {
            const float angle = 2 * pi * float(k) / sides;
            return glm::vec3(std::cos(angle), std::sin(angle), 0);
        };
        Primitive part = quadShape(0.85f * at(i), 0.15f * at(i), 0.85f * (at(i + 1) - at(i)), rim);
        part.positions[2] = at(i + 1);
        mesh.primitives.push_back(part);
    }
    scene.meshes.push_back(mesh);
    wheel.mesh = int(scene.meshes.size()) - 1;
    const int node = addRoot(scene, wheel);

    // Without slipping: a turn takes it 2 pi of its radii.
    Animation roll;
    roll.name = "roll";
    AnimationChannel turns{node, AnimationPath::Rotation, Interpolation::Linear, {}, {}};
    for (int i = 0; i <= 8; ++i) {
        const float angle = -2 * pi * float(i) / 8;
        turns.times.push_back(float(i) / 8);
        turns.values.insert(turns.values.end(), {0, 0, std::sin(angle / 2), std::cos(angle / 2)});
    }
    roll.channels = {
        turns, {node, AnimationPath::Translation, Interpolation::Linear, {0, 1}, {-pi, 0, 0, pi, 0, 0}}};
    scene.animations.push_back(roll);
    addSun(scene, glm::vec3(2.5f), {0.5f, 1, 0.8f});
    scene.environment = Environment{.radiance = glm::vec3(0.5f)};

    addCamera(scene, {0, 0.4f, 9}, {0, 0, 0}, 26);
    scene.cameras[0].name = "still";
    scene.cameras.push_back(scene.cameras[0]);
    scene.cameras[1].name = "open";
    scene.cameras[1].shutter = Shutter{0.45, 0.5, 0};
    scene.cameras.push_back(scene.cameras[0]);
    scene.cameras[2].name = "rolling";
    scene.cameras[2].shutter = Shutter{0.3, 0.3, 0.4};
    for (int i = 1; i < 3; ++i) {
        Node copy = scene.nodes[std::size_t(scene.placedCameras()[0].node)];
        copy.name = scene.cameras[std::size_t(i)].name;
        copy.camera = i;
        addRoot(scene, copy);
    }
    return scene;
}

const RegisterSample registered{"wheel", makeWheel};

}  // namespace
}  // namespace helio::samples::wheel
