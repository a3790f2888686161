/** @file
 * Night over hills: 200,000 triangles of ground under 500 small lamps of many powers, each facing its own
 * way, in metres. What a choice among many lights is measured by.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <cmath>

namespace helio::samples::lights500 {
namespace {

constexpr int side = 316;  // squares along an edge of the ground: 2 * 316^2 triangles
constexpr int lamps = 500, colors = 5;
constexpr double extent = 40;

/** Uniform in [0, 1): the golden ratio's multiples, which cover evenly and are the same everywhere. */
double spread(int i, double step) {
    const double x = (i + 1) * step;
    return x - std::floor(x);
}

double height(double x, double z) {
    return 1.1 * std::sin(0.37 * x) * std::cos(0.29 * z) + 0.45 * std::sin(0.9 * x + 1.3 * z) +
           0.12 * std::sin(3.1 * x) * std::sin(2.7 * z);
}

Primitive ground(int material) {
    Primitive primitive;
    primitive.material = material;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const double x = extent * (double(i) / side - 0.5), z = extent * (double(j) / side - 0.5);
            primitive.positions.emplace_back(x, height(x, z), z);
        }
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t a = j * (side + 1) + i, b = a + 1, c = a + side + 1, d = c + 1;
            for (std::uint32_t k : {a, c, b, b, c, d}) primitive.indices.push_back(k);
        }
    return primitive;
}

Scene makeLights500() {
    Scene scene;
    addRoot(scene, "ground",
            addMesh(scene, "ground", ground(addMaterial(scene, diffuse("soil", {0.6f, 0.55f, 0.5f})))));
    const std::array<glm::vec3, colors> tints{glm::vec3(1.0f, 0.8f, 0.5f), glm::vec3(1.0f, 0.5f, 0.3f),
                                              glm::vec3(0.6f, 0.8f, 1.0f), glm::vec3(0.7f, 1.0f, 0.6f),
                                              glm::vec3(1.0f, 0.9f, 0.9f)};
    std::array<int, colors> meshes{};
    for (std::size_t c = 0; c < colors; ++c) {
        Material glow = diffuse("lamp", glm::vec3(0.0f));
        glow.emission = tints[c] * std::ldexp(30.0f, int(c));  // powers from 1 to 16
        meshes[c] = addMesh(scene, "lamp",
                            quadShape({-0.5f, 0, -0.5f}, {1, 0, 0}, {0, 0, 1}, addMaterial(scene, glow)));
    }
    for (int i = 0; i < lamps; ++i) {
        const double x = extent * (spread(i, 0.7548776662466927) - 0.5);  // the plastic number's
        const double z = extent * (spread(i, 0.5698402909980532) - 0.5);
        Node lamp;
        lamp.mesh = meshes[std::size_t(i * 7 % colors)];
        lamp.translation = glm::vec3(x, height(x, z) + 0.35 + 1.5 * spread(i, 0.381966), z);
        const float turn = float(6.2831853 * spread(i, 0.6180339887)),
                    tilt = float(1.2 * spread(i, 0.236068));
        lamp.rotation = glm::angleAxis(turn, glm::vec3(0, 1, 0)) * glm::angleAxis(tilt, glm::vec3(1, 0, 0));
        lamp.scale = glm::vec3(float(0.06 + 0.1 * spread(i, 0.1458980)));
        addRoot(scene, lamp);
    }
    addCamera(scene, {0, 9, 24}, {0, 0, 2}, 45);
    return scene;
}

const RegisterSample registered{"lights500", makeLights500};

}  // namespace
}  // namespace helio::samples::lights500
