/** @file
 * Three rows of spheres in a studio, in metres: dielectrics of every hue from a mirror-like to a dull coat,
 * metals of published reflectance by roughness, and small lamps between them. Lit by a soft box above, a cool
 * rim light, and a faint surround.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace helio::samples::materials {
namespace {

constexpr int columns = 7;

/** A floor that bends up into a wall, so that no edge shows behind the spheres. */
Primitive studio(int material) {
    constexpr float halfWidth = 14, front = 12, back = -5, bend = 3, top = 9;
    constexpr int steps = 24;
    std::vector<glm::vec2> profile{{front, 0}};  // z, y
    for (int i = 0; i <= steps; ++i) {
        const double angle = 0.5 * 3.14159265358979323846 * i / steps;
        profile.emplace_back(back - bend * std::sin(angle), bend * (1 - std::cos(angle)));
    }
    profile.emplace_back(back - bend, top);
    Primitive primitive;
    primitive.material = material;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const glm::vec2 along =
            glm::normalize(profile[std::min(i + 1, profile.size() - 1)] - profile[i > 0 ? i - 1 : 0]);
        for (float side : {-halfWidth, halfWidth}) {
            primitive.positions.emplace_back(side, profile[i].y, profile[i].x);
            primitive.normals.emplace_back(0, -along.x, along.y);
        }
        if (i == 0) continue;
        const auto a = std::uint32_t(2 * (i - 1));
        for (std::uint32_t corner : {a, a + 1, a + 3, a, a + 3, a + 2}) primitive.indices.push_back(corner);
    }
    return primitive;
}

/** Linear Rec.709 of a fully saturated hue in 0..1, at most 0.8, with some white. */
glm::vec3 hue(double h) {
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) {
        const double distance = std::abs(std::fmod(h * 6 + 6 - 2 * c + 3, 6.0) - 3);
        color[c] = float(0.05 + 0.7 * std::clamp(2 - distance, 0.0, 1.0));
    }
    return color;
}

void addSphere(Scene& scene, Material material, glm::vec3 centre, float radius, int frequency) {
    const std::string name = material.name;
    const int mesh = addMesh(scene, name, sphereShape(frequency, addMaterial(scene, std::move(material))));
    Node node;
    node.name = name;
    node.mesh = mesh;
    node.translation = centre;
    node.scale = glm::vec3(radius);
    addRoot(scene, node);
}

void addSpheres(Scene& scene) {
    // Reflectance at normal incidence, linear Rec.709, of measured n and k: gold, copper, iron, silver.
    constexpr std::array<glm::vec3, 4> metals{
        {{1.0f, 0.77f, 0.34f}, {0.95f, 0.64f, 0.54f}, {0.56f, 0.57f, 0.58f}, {0.97f, 0.96f, 0.91f}}};
    constexpr std::array<const char*, 4> metalNames{"gold", "copper", "iron", "silver"};
    for (int column = 0; column < columns; ++column) {
        const float x = 1.25f * float(column - columns / 2);
        const double roughness = double(column) / (columns - 1);
        Material coat;
        coat.name = "coat " + std::to_string(column);
        coat.baseColor = glm::vec4(hue(double(column) / columns), 1);
        coat.metallic = 0;
        coat.roughness = float(roughness);
        addSphere(scene, coat, {x, 0.5f, 0.9f}, 0.5f, 16);

        Material metal;
        const std::size_t kind = std::size_t(column) % metals.size();
        metal.name = std::string(metalNames[kind]) + " " + std::to_string(column);
        metal.baseColor = glm::vec4(metals[kind], 1);
        metal.roughness = float(0.05 + 0.75 * roughness);
        addSphere(scene, metal, {x, 0.6f, -0.9f}, 0.6f, 16);

        if (column + 1 == columns) break;
        Material lamp = diffuse("lamp " + std::to_string(column), glm::vec3(0.1f));
        lamp.emission = 3.0f * hue((column + 0.5) / columns);
        addSphere(scene, lamp, {x + 0.625f, 0.16f, 1.9f}, 0.16f, 6);
    }
}

Scene makeMaterials() {
    Scene scene;
    addRoot(scene, "studio",
            addMesh(scene, "studio", studio(addMaterial(scene, diffuse("paper", glm::vec3(0.55f))))));
    addSpheres(scene);

    Material softBox = diffuse("soft box", glm::vec3(0.8f));
    softBox.emission = glm::vec3(11.0f, 10.5f, 9.8f);
    addRoot(scene, "soft box",
            addMesh(scene, "soft box",
                    quadShape({-3, 5, -1}, {6, 0, 0}, {0, 0.6f, 3}, addMaterial(scene, softBox))));
    Material rim = diffuse("rim light", glm::vec3(0.8f));
    rim.emission = glm::vec3(6.0f, 8.5f, 12.0f);
    addRoot(scene, "rim light",
            addMesh(scene, "rim light",
                    quadShape({-6, 0.8f, -2}, {0, 0, 3}, {0.8f, 2.6f, 0}, addMaterial(scene, rim))));
    scene.environment = Environment{glm::vec3(0.12f, 0.13f, 0.15f), -1};
    addCamera(scene, {0, 4.6f, 10.4f}, {0, 0.45f, 0.2f}, 28);
    return scene;
}

const RegisterSample registered{"materials", makeMaterials};

}  // namespace
}  // namespace helio::samples::materials
