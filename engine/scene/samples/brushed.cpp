/** @file
 * Brushed steel: a plate brushed along its width, before it a disc turned on a lathe. Facets are seven times
 * as wide across the scratches as along them, so that highlights are streaks, on the disc a bow tie.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <cmath>

namespace helio::samples::brushed {
namespace {

constexpr double pi = 3.14159265358979323846;

/** Iron at 630, 532 and 465 nm, scratched along the tangent. */
Material brushedSteel() {
    Material steel;
    steel.name = "brushed steel";
    steel.scattering = Scattering{};
    steel.scattering->model = Scattering::Model::Conductor;
    steel.scattering->n = {2.88f, 2.95f, 2.65f};
    steel.scattering->k = {3.05f, 2.93f, 2.81f};
    steel.scattering->alpha = {0.05f, 0.35f};
    return steel;
}

/** An annulus that faces up, its tangents along its circles. */
Primitive turnedDisc(int sides, float inner, int material) {
    Primitive disc;
    disc.material = material;
    for (int i = 0; i <= sides; ++i) {
        const double angle = 2 * pi * i / sides;
        const glm::vec3 out(float(std::cos(angle)), 0, float(-std::sin(angle)));
        for (const float radius : {inner, 1.0f}) {
            disc.positions.push_back(radius * out);
            disc.normals.emplace_back(0, 1, 0);
            disc.tangents.emplace_back(out.z, 0, -out.x, 1);
        }
    }
    for (std::uint32_t i = 0; i < std::uint32_t(2 * sides); i += 2)
        for (const std::uint32_t corner : {i, i + 1, i + 3, i, i + 3, i + 2}) disc.indices.push_back(corner);
    return disc;
}

Scene makeBrushed() {
    Scene scene;
    const int table = addMaterial(scene, diffuse("table", {0.25f, 0.17f, 0.11f}));
    addRoot(scene, "table",
            addMesh(scene, "table", quadShape({-8, -0.02f, 8}, {16, 0, 0}, {0, 0, -16}, table)));
    const int steel = addMaterial(scene, brushedSteel());
    addRoot(scene, "plate",
            addMesh(scene, "plate", quadShape({-1.6f, 0, -1.2f}, {3.2f, 0, 0}, {0, 2.4f, 0}, steel)));
    Node disc;
    disc.name = "disc";
    disc.mesh = addMesh(scene, "disc", turnedDisc(180, 0.04f, steel));
    disc.translation = {0, 0, 0.2f};
    addRoot(scene, disc);

    PunctualLight lamp;
    lamp.name = "lamp";
    lamp.intensity = glm::vec3(10);
    scene.lights.push_back(lamp);
    Node placed;
    placed.name = "lamp";
    placed.light = 0;
    placed.translation = {0, 1.2f, 2.8f};  // 4 before the plate's middle
    addRoot(scene, placed);
    scene.environment = Environment{.radiance = glm::vec3(0.25f, 0.28f, 0.32f)};

    addCamera(scene, {0.4f, 2.2f, 4.2f}, {0, 0.7f, -0.4f}, 40);
    // At the lamp: half vectors are the way to the camera, their slopes on the plate x / 4 and y / 4.
    Camera lampsView;
    lampsView.name = "lamp";
    lampsView.yfov = float(2 * std::atan(0.28));
    scene.cameras.push_back(lampsView);
    Node view = placed;
    view.light = -1;
    view.camera = 1;
    addRoot(scene, view);
    return scene;
}

const RegisterSample registered{"brushed", makeBrushed};

}  // namespace
}  // namespace helio::samples::brushed
