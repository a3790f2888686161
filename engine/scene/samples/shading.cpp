/** @file
 * Balls of few and of many triangles, dull to glossy, under a sun and a lamp: where light is found for whole
 * triangles, for corners or for pixels (--shading) shows in facets and highlights.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>

namespace helio::samples::shading {
namespace {

Scene makeShading() {
    Scene scene;
    const std::array<int, 3> cuts = {2, 4, 16};
    const std::array<glm::vec3, 3> colors = {glm::vec3(0.75f, 0.2f, 0.12f), glm::vec3(0.15f, 0.45f, 0.2f),
                                             glm::vec3(0.15f, 0.25f, 0.65f)};
    const std::array<float, 3> roughness = {0.7f, 0.5f, 0.35f};
    for (std::size_t row = 0; row < 3; ++row) {
        Material material;
        material.name = "paint " + std::to_string(row);
        material.baseColor = glm::vec4(colors[row], 1.0f);
        material.metallic = 0;
        material.roughness = roughness[row];
        material.specularColor = glm::vec3(1);
        material.ior = 2;
        const int paint = addMaterial(scene, material);
        for (std::size_t column = 0; column < 3; ++column) {
            const std::string name = "ball " + std::to_string(cuts[column]) + ", " + material.name;
            Node node;
            node.name = name;
            node.mesh = addMesh(scene, name, sphereShape(cuts[column], paint));
            node.translation = {2.4f * (float(column) - 1), 1, 2.4f * (float(row) - 1)};
            addRoot(scene, node);
        }
    }
    addRoot(scene, "floor",
            addMesh(scene, "floor",
                    quadShape({-9, 0, 9}, {18, 0, 0}, {0, 0, -18},
                              addMaterial(scene, diffuse("floor", glm::vec3(0.4f))))));
    addSun(scene, glm::vec3(2.0f, 1.9f, 1.7f), {0.5f, 1, 0.4f});
    PunctualLight lamp;
    lamp.name = "lamp";
    lamp.intensity = {12, 14, 20};
    scene.lights.push_back(lamp);
    Node node;
    node.name = "lamp";
    node.light = int(scene.lights.size()) - 1;
    node.translation = {-3.5f, 4, 3};
    addRoot(scene, node);
    scene.environment = Environment{glm::vec3(0.12f, 0.14f, 0.18f), -1};
    addCamera(scene, {0, 6.5f, 8.5f}, {0, 0.6f, 0.2f}, 38);
    return scene;
}

const RegisterSample sample{"shading", makeShading};

}  // namespace
}  // namespace helio::samples::shading
