/** @file
 * One row of balls at growing distance through five cameras: a pinhole, a thin lens at f/1.4, a double Gauss
 * of eleven surfaces, a fisheye and a panorama. What the lenses have in focus is the ball in the middle.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <cmath>

namespace helio::samples::lenses {
namespace {

/** Distance of the ball in the middle from the cameras. */
constexpr float focus = 2.5f;

/** Double Gauss of US patent 2,673,491 (Tronnier), scaled to 50 mm: radii, distances and indices are the
 * patent's; it claims 1 : 2 and a back focus of 0.71436 focal lengths. Diameters, which it does not print,
 * are those of Smith's "Modern Lens Design", p. 312. */
LensTable doubleGauss() {
    LensTable lens;
    lens.surfaces = {{29.475f, 3.76f, 1.67125f, 25.2f},  {84.83f, 0.12f, 1.0f, 25.2f},
                     {19.275f, 4.025f, 1.67125f, 23.0f}, {40.77f, 3.275f, 1.69842f, 23.0f},
                     {12.75f, 5.466f, 1.0f, 18.0f},      {0.0f, 4.741f, 1.0f, 17.1f},
                     {-14.495f, 1.18f, 1.60266f, 17.0f}, {40.77f, 6.065f, 1.65953f, 20.0f},
                     {-20.385f, 0.19f, 1.0f, 20.0f},     {437.065f, 3.22f, 1.7174f, 20.0f},
                     {-39.73f, 0.0f, 1.0f, 20.0f}};
    lens.focusDistance = focus;
    return lens;
}

void addLensCamera(Scene& scene, const std::string& name, Camera camera) {
    camera.name = name;
    scene.cameras.push_back(std::move(camera));
    Node node = lookAtNode(name, {0, 0.35f, 0}, {0, 0.3f, -focus});
    node.camera = int(scene.cameras.size()) - 1;
    addRoot(scene, node);
}

Scene makeLenses() {
    Scene scene;
    const int floor = addMaterial(scene, diffuse("floor", glm::vec3(0.4f)));
    addRoot(scene, "floor", addMesh(scene, "floor", quadShape({-12, 0, 12}, {24, 0, 0}, {0, 0, -24}, floor)));
    const std::array<glm::vec3, 5> colors = {{{0.8f, 0.25f, 0.2f},
                                              {0.8f, 0.6f, 0.2f},
                                              {0.3f, 0.7f, 0.3f},
                                              {0.2f, 0.5f, 0.8f},
                                              {0.6f, 0.3f, 0.7f}}};
    const std::array<float, 5> distances = {1.25f, 1.7f, focus, 4.2f, 8.0f};
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const std::string name = "ball " + std::to_string(i + 1);
        Node ball;
        ball.name = name;
        ball.mesh = addMesh(scene, name, sphereShape(12, addMaterial(scene, diffuse(name, colors[i]))));
        ball.translation = {(float(i) - 2) * 0.16f * distances[i], 0.25f, -distances[i]};
        ball.scale = glm::vec3(0.25f);
        addRoot(scene, ball);
        // A small bright lamp above each: what is out of focus becomes a disc.
        Material lamp = diffuse("lamp " + std::to_string(i + 1), glm::vec3(0));
        lamp.emission = glm::vec3(160.0f);
        Node spark;
        spark.name = lamp.name;
        const std::string lampName = lamp.name;
        spark.mesh = addMesh(scene, lampName, sphereShape(4, addMaterial(scene, std::move(lamp))));
        spark.translation = ball.translation + glm::vec3(0, 0.4f, 0);
        spark.scale = glm::vec3(0.003f * distances[i]);
        addRoot(scene, spark);
    }
    scene.environment = Environment{.radiance = {0.35f, 0.4f, 0.5f}};

    Camera pinhole;
    pinhole.yfov = 0.4710898f;  // 24 mm at 50 mm
    addLensCamera(scene, "pinhole", pinhole);
    Camera thin = pinhole;
    thin.lens = thinLens(pinhole, 1.4, focus);
    thin.lens->blades = 7;
    addLensCamera(scene, "thin lens", thin);
    Camera gauss = pinhole;
    gauss.lensTable = doubleGauss();
    addLensCamera(scene, "double gauss", gauss);
    Camera fisheye = pinhole;
    fisheye.projection = Projection::Equisolid;
    addLensCamera(scene, "fisheye", fisheye);
    Camera panorama = pinhole;
    panorama.projection = Projection::LatLong;
    addLensCamera(scene, "panorama", panorama);
    return scene;
}

const RegisterSample registered{"lenses", makeLenses};

}  // namespace
}  // namespace helio::samples::lenses
