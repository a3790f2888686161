/** @file
 * Snell's window: the world above as a diver sees it who looks straight up through calm water, all of it in a
 * cone of 2 asin(1 / 1.333) = 97.2133 degrees; around it the pool, mirrored in the surface. An equidistant
 * fisheye: a pixel's distance from the middle of the picture is its angle.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <cmath>

namespace helio::samples::snell {
namespace {

Scene makeSnell() {
    Scene scene;
    Material water;
    water.name = "water";
    water.scattering = Scattering{};
    water.scattering->model = Scattering::Model::Dielectric;
    water.scattering->n = glm::vec3(1.333f);
    addRoot(
        scene, "water",
        addMesh(scene, "water", quadShape({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, addMaterial(scene, water))));

    const int tiles = addMaterial(scene, diffuse("tiles", {0.15f, 0.45f, 0.5f}));
    const std::array<std::array<glm::vec3, 3>, 5> sides = {{{{{-6, -3, 6}, {12, 0, 0}, {0, 0, -12}}},
                                                            {{{-6, -3, -6}, {12, 0, 0}, {0, 3, 0}}},
                                                            {{{6, -3, 6}, {-12, 0, 0}, {0, 3, 0}}},
                                                            {{{-6, -3, 6}, {0, 0, -12}, {0, 3, 0}}},
                                                            {{{6, -3, -6}, {0, 0, 12}, {0, 3, 0}}}}};
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const std::string name = i == 0 ? "floor" : "side " + std::to_string(i);
        addRoot(scene, name, addMesh(scene, name, quadShape(sides[i][0], sides[i][1], sides[i][2], tiles)));
    }
    // Posts round the pool, which the window bends to its rim, and balls above it.
    for (int i = 0; i < 12; ++i) {
        const float angle = 6.2831853f * float(i) / 12;
        const glm::vec3 color = i % 3 == 0 ? glm::vec3(0.8f, 0.2f, 0.1f) : glm::vec3(0.7f);
        const std::string name = "post " + std::to_string(i + 1);
        Node post;
        post.name = name;
        post.mesh = addMesh(scene, name, prismShape(12, addMaterial(scene, diffuse(name, color))));
        post.translation = {9 * std::cos(angle), 0, 9 * std::sin(angle)};
        post.scale = {0.4f, 5, 0.4f};
        addRoot(scene, post);
    }
    for (int i = 0; i < 3; ++i) {
        const float angle = 2.1f * float(i);
        const std::string name = "ball " + std::to_string(i + 1);
        Node ball;
        ball.name = name;
        ball.mesh =
            addMesh(scene, name,
                    sphereShape(10, addMaterial(scene, diffuse(name, {0.8f, 0.6f - 0.2f * float(i), 0.2f}))));
        ball.translation = {2 * std::cos(angle), 2, 2 * std::sin(angle)};
        ball.scale = glm::vec3(0.6f);
        addRoot(scene, ball);
    }
    addSun(scene, glm::vec3(2), {0.6f, 1, 0.3f});
    scene.environment = Environment{.radiance = {0.7f, 0.85f, 1.0f}};

    Camera camera;
    camera.name = "diver";
    camera.projection = Projection::Equidistant;
    camera.fieldOfView = 2.6179939f;  // 150 degrees
    scene.cameras.push_back(camera);
    Node diver;
    diver.name = "diver";
    diver.camera = 0;
    diver.translation = {0, -1.5f, 0};
    diver.rotation = glm::quat(0.70710678f, 0.70710678f, 0, 0);  // -z up
    addRoot(scene, diver);
    // For what draws no fisheyes: the first camera.
    addCamera(scene, {0, 4, 14}, {0, 0, 0}, 40);
    std::swap(scene.roots[scene.roots.size() - 1], scene.roots[scene.roots.size() - 2]);
    return scene;
}

const RegisterSample registered{"snell", makeSnell};

}  // namespace
}  // namespace helio::samples::snell
