/** @file
 * 4,181 instances of five small meshes in the order of a sunflower's seeds (Vogel 1979: the n-th at angle n
 * times the golden angle and radius proportional to sqrt(n)), in metres. Seeds that are 13 or 21 apart touch,
 * so colouring by n modulo 13 or 21 draws the spirals one sees in the flower. Grouped under 21 nodes, one per
 * spiral.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <cmath>

namespace helio::samples::instances {
namespace {

constexpr int count = 4181;  // a Fibonacci number
constexpr int spirals = 21;
constexpr double spacing = 0.5;

Node seed(int n, const std::array<int, 5>& meshes) {
    const double golden = 3.14159265358979323846 * (3 - std::sqrt(5.0));
    const double angle = n * golden, radius = spacing * std::sqrt(n + 0.5);
    const double edge = spacing * std::sqrt(double(count));
    // A dome with ripples, falling to the rim.
    const double fall = 1 - (radius / edge) * (radius / edge);
    const double height =
        0.35 + 4.5 * fall * fall + 0.9 * (0.5 + 0.5 * std::cos(radius * 1.1)) * (0.3 + 0.7 * fall);
    Node node;
    node.translation = glm::vec3(radius * std::cos(angle), 0, radius * std::sin(angle));
    node.rotation = glm::angleAxis(float(-angle), glm::vec3(0, 1, 0));
    const int kind = n % spirals;
    if (kind % 7 == 3) {  // a gem that hovers over its place
        node.mesh = meshes[3];
        node.translation.y = float(height + 0.55);
        node.scale = glm::vec3(0.3f, 0.5f, 0.3f);
    } else if (kind % 7 == 5) {
        node.mesh = meshes[4];
        node.translation.y = float(height);
        node.scale = glm::vec3(0.4f);
    } else {
        node.mesh = meshes[std::size_t(n % 13 % 3)];
        node.scale = glm::vec3(0.42, height, 0.42);
    }
    return node;
}

Scene makeInstances() {
    Scene scene;
    const auto plastic = [&](const char* name, glm::vec3 color) {
        Material material = diffuse(name, color);
        material.specular = 1;
        material.roughness = 0.45f;
        return addMaterial(scene, material);
    };
    Material gold = diffuse("gold", {1.0f, 0.77f, 0.34f});
    gold.metallic = 1;
    gold.specular = 1;
    gold.roughness = 0.25f;
    const std::array<int, 5> meshes{
        addMesh(scene, "amber column", prismShape(6, plastic("amber", {0.80f, 0.36f, 0.05f}))),
        addMesh(scene, "wine column", prismShape(6, plastic("wine", {0.42f, 0.05f, 0.08f}))),
        addMesh(scene, "sand column", prismShape(6, plastic("sand", {0.76f, 0.60f, 0.36f}))),
        addMesh(scene, "gem", gemShape(6, plastic("sea", {0.04f, 0.38f, 0.48f}))),
        addMesh(scene, "bead", sphereShape(3, addMaterial(scene, gold))),
    };
    const float ground = 400;
    addRoot(scene, "ground",
            addMesh(scene, "ground",
                    quadShape({-ground, 0, ground}, {2 * ground, 0, 0}, {0, 0, -2 * ground},
                              addMaterial(scene, diffuse("ground", {0.20f, 0.24f, 0.20f})))));
    for (int spiral = 0; spiral < spirals; ++spiral) {
        Node group;
        group.name = "spiral " + std::to_string(spiral);
        const int parent = addRoot(scene, group);
        for (int n = spiral; n < count; n += spirals) {
            scene.nodes.push_back(seed(n, meshes));
            scene.nodes[std::size_t(parent)].children.push_back(int(scene.nodes.size()) - 1);
        }
    }
    addSun(scene, {3.4f, 3.0f, 2.5f}, {-30, 26, 14});
    scene.environment = Environment{glm::vec3(0.42f, 0.52f, 0.70f), -1};
    addCamera(scene, {0, 30, 62}, {0, 0, 3}, 40);
    return scene;
}

const RegisterSample registered{"instances", makeInstances};

}  // namespace
}  // namespace helio::samples::instances
