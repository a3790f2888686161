/** @file
 * Four metal plates of growing roughness under four lamps of growing size and one power, after Veach, "Robust
 * Monte Carlo methods for light transport simulation", 1997, figure 9.2: neither sampling lamps nor sampling
 * reflections alone finds all of the highlights.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <cmath>

namespace helio::samples::plates {
namespace {

struct Plate {
    float alpha;
    glm::vec2 front, back;  ///< y, z of its edges
};
constexpr std::array<Plate, 4> plates{{{0.005f, {-2.70651f, 0.25609f}, {-2.08375f, -0.526323f}},
                                       {0.02f, {-3.28825f, 1.36972f}, {-2.83856f, 0.476536f}},
                                       {0.05f, {-3.73096f, 2.70046f}, {-3.43378f, 1.74564f}},
                                       {0.1f, {-3.99615f, 4.0667f}, {-3.82069f, 3.08221f}}}};
struct Lamp {
    float x, radius;
};
constexpr std::array<Lamp, 4> lamps{{{-3.75f, 0.0333333f}, {-1.25f, 0.1f}, {1.25f, 0.3f}, {3.75f, 0.9f}}};

Scene makePlates() {
    Scene scene;
    for (std::size_t i = 0; i < plates.size(); ++i) {
        const Plate& plate = plates[i];
        Material metal;
        metal.name = "plate " + std::to_string(i + 1);
        metal.baseColor = glm::vec4(0.35f, 0.38f, 0.42f, 1);
        metal.roughness = std::sqrt(plate.alpha);
        const glm::vec3 corner(-4, plate.front.x, plate.front.y);
        const glm::vec3 up(0, plate.back.x - plate.front.x, plate.back.y - plate.front.y);
        const std::string name = metal.name;
        addRoot(scene, name,
                addMesh(scene, name, quadShape(corner, {8, 0, 0}, up, addMaterial(scene, std::move(metal)))));
    }
    const int room = addMaterial(scene, diffuse("room", glm::vec3(0.4f)));
    addRoot(scene, "floor",
            addMesh(scene, "floor", quadShape({-10, -4.14615f, 10}, {20, 0, 0}, {0, 0, -12}, room)));
    addRoot(scene, "wall",
            addMesh(scene, "wall", quadShape({-10, -4.14615f, -2}, {20, 0, 0}, {0, 14, 0}, room)));
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        Material lamp = diffuse("lamp " + std::to_string(i + 1), glm::vec3(0));
        lamp.emission = glm::vec3(1 / (lamps[i].radius * lamps[i].radius));
        Node node;
        node.name = lamp.name;
        const std::string name = lamp.name;
        node.mesh = addMesh(scene, name, sphereShape(4, addMaterial(scene, std::move(lamp))));
        node.translation = {lamps[i].x, 0, 0};
        node.scale = glm::vec3(lamps[i].radius);
        addRoot(scene, node);
    }
    addCamera(scene, {0, 2, 15}, {0, -2, 2.5f}, 28);
    return scene;
}

const RegisterSample registered{"plates", makePlates};

}  // namespace
}  // namespace helio::samples::plates
