/** @file
 * The caustic of a napkin ring: half a mirrored cylinder of radius 1, open towards the sun. Its light, once
 * mirrored, is enveloped by half a nephroid whose cusp lies at half the radius; on the axis between the cusp
 * and the ring's centre it is 1 / (1 - 2 x) times what the sun brings directly, x from the centre.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <cmath>

namespace helio::samples::caustic {
namespace {

constexpr double pi = 3.14159265358979323846;
/** The sun: an upright strip, so that more light finds it, since how high a ray comes from changes nothing of
 * the pattern on the floor. Half its width and the tangents of where it begins and ends over the horizon; so
 * far away that its rays are parallel to 1 in 800. */
constexpr float sunWidth = 0.05f, sunLow = 0.35f, sunHigh = 1.0f, sunDistance = 400;

Primitive halfRing(int sides, float height, int material) {
    Primitive ring;
    ring.material = material;
    for (int i = 0; i <= sides; ++i) {
        const double angle = pi * (double(i) / sides - 0.5);
        const glm::vec3 foot(float(std::cos(angle)), 0, float(-std::sin(angle)));
        for (const float y : {0.0f, height}) {
            ring.positions.emplace_back(foot.x, y, foot.z);
            ring.normals.push_back(-foot);
        }
    }
    for (std::uint32_t i = 0; i < std::uint32_t(2 * sides); i += 2)
        for (const std::uint32_t corner : {i, i + 1, i + 2, i + 1, i + 3, i + 2})
            ring.indices.push_back(corner);
    return ring;
}

Scene makeCaustic() {
    Scene scene;
    const int floor = addMaterial(scene, diffuse("floor", {0.75f, 0.7f, 0.6f}));
    addRoot(scene, "floor", addMesh(scene, "floor", quadShape({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, floor)));
    Material mirror;
    mirror.name = "mirror";
    mirror.scattering = Scattering{};
    mirror.scattering->model = Scattering::Model::Mirror;
    // As high as what lights the axis 0.3 behind the centre.
    addRoot(scene, "ring",
            addMesh(scene, "ring", halfRing(512, 1.3f, addMaterial(scene, std::move(mirror)))));

    Material light = diffuse("sun", glm::vec3(0));
    light.emission = glm::vec3(50, 46, 40);
    addRoot(scene, "sun",
            addMesh(scene, "sun",
                    quadShape(sunDistance * glm::vec3(-1, sunLow, sunWidth),
                              sunDistance * glm::vec3(0, 0, -2 * sunWidth),
                              sunDistance * glm::vec3(0, sunHigh - sunLow, 0),
                              addMaterial(scene, std::move(light)))));
    scene.environment = Environment{.radiance = glm::vec3(0.1f, 0.12f, 0.16f)};

    addCamera(scene, {-2.2f, 2.4f, 1.6f}, {0.2f, 0.2f, 0}, 42);
    // Straight down on the axis: a picture ten times as wide as high spans x from -0.1 to 0.3.
    Camera above;
    above.name = "above";
    above.perspective = false;
    above.ymag = 0.02f;
    scene.cameras.push_back(above);
    Node node;
    node.name = "above";
    node.camera = 1;
    node.translation = {0.1f, 3, 0};
    node.rotation = glm::quat(0.70710678f, -0.70710678f, 0, 0);  // -z down
    addRoot(scene, node);
    return scene;
}

const RegisterSample registered{"caustic", makeCaustic};

}  // namespace
}  // namespace helio::samples::caustic
