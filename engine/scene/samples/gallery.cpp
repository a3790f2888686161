/** @file
 * A sphere of every kind of material in three rows on a grey floor, under a soft box and a faint sky: diffuse
 * and cloth behind, metals between, glass in front. n and k of the metals are published measurements at 630,
 * 532 and 465 nm.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <array>
#include <utility>
#include <vector>

namespace helio::samples::gallery {
namespace {

Material named(const char* name, glm::vec3 color, float metallic, float roughness) {
    Material m;
    m.name = name;
    m.baseColor = glm::vec4(color, 1);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

Material scattering(const char* name, Scattering::Model model, glm::vec3 color = glm::vec3(1)) {
    Material m = named(name, color, 1, 1);
    m.scattering = Scattering{};
    m.scattering->model = model;
    return m;
}

std::vector<Material> diffuseRow() {
    std::vector<Material> row{diffuse("Lambert", {0.6f, 0.25f, 0.2f})};
    row.push_back(scattering("Oren-Nayar", Scattering::Model::OrenNayar, {0.6f, 0.25f, 0.2f}));
    row.back().scattering->roughness = 0.9f;
    row.push_back(named("plastic", {0.1f, 0.3f, 0.6f}, 0, 0.25f));
    row.push_back(named("velvet", {0.15f, 0.02f, 0.1f}, 0, 0.9f));
    row.back().sheenColor = {0.8f, 0.3f, 0.6f};
    row.back().sheenRoughness = 0.4f;
    row.push_back(scattering("Phong", Scattering::Model::Phong, glm::vec3(0.7f)));
    row.back().scattering->exponent = 40;
    return row;
}

std::vector<Material> metalRow() {
    std::vector<Material> row{scattering("gold", Scattering::Model::Conductor)};
    row[0].scattering->n = {0.18f, 0.54f, 1.33f};
    row[0].scattering->k = {3.43f, 2.32f, 1.88f};
    row[0].scattering->alpha = glm::vec2(0.1f);
    row.push_back(scattering("rough copper", Scattering::Model::Conductor));
    row[1].scattering->n = {0.23f, 1.12f, 1.17f};
    row[1].scattering->k = {3.44f, 2.60f, 2.47f};
    row[1].scattering->alpha = glm::vec2(0.6f);
    row[1].scattering->multipleScattering = true;
    row.push_back(named("brushed steel", glm::vec3(0.6f), 1, 0.35f));
    row.back().anisotropyStrength = 0.9f;
    row.push_back(named("car paint", {0.5f, 0.02f, 0.02f}, 0.4f, 0.5f));
    row.back().clearcoat = 1;
    row.push_back(named("soap film", glm::vec3(0.5f), 1, 0.15f));
    row.back().iridescence = 1;
    row.back().iridescenceThicknessMaximum = 480;
    return row;
}

std::vector<Material> glassRow() {
    std::vector<Material> row{scattering("mirror", Scattering::Model::Mirror)};
    row.push_back(named("glass", glm::vec3(1), 0, 0));
    row.push_back(named("frosted glass", glm::vec3(1), 0, 0.45f));
    row.push_back(named("red glass", glm::vec3(1), 0, 0));
    row.back().attenuationColor = {0.9f, 0.15f, 0.1f};
    row.back().attenuationDistance = 0.5f;
    row.push_back(named("diamond", glm::vec3(1), 0, 0));
    row.back().ior = 2.42f;
    row.back().dispersion = 0.36f;
    for (Material& m : row) {
        m.transmission = m.scattering ? 0.0f : 1.0f;
        m.thickness = m.transmission;
    }
    return row;
}

Scene makeGallery() {
    Scene scene;
    const int floor = addMaterial(scene, diffuse("floor", glm::vec3(0.5f)));
    addRoot(scene, "floor", addMesh(scene, "floor", quadShape({-20, 0, 12}, {40, 0, 0}, {0, 0, -30}, floor)));
    float z = -2.6f;
    for (const std::vector<Material>& row : {diffuseRow(), metalRow(), glassRow()}) {
        float x = -2.6f;
        for (const Material& material : row) {
            Node node;
            node.name = material.name;
            node.mesh = addMesh(scene, material.name, sphereShape(32, addMaterial(scene, material)));
            node.translation = {x, 0.5f, z};
            node.scale = glm::vec3(0.5f);
            addRoot(scene, node);
            x += 1.3f;
        }
        z += 1.5f;
    }
    Material softBox = diffuse("soft box", glm::vec3(0));
    softBox.emission = glm::vec3(12);
    addRoot(scene, "soft box",
            addMesh(scene, "soft box",
                    quadShape({-3, 5, -2}, {6, 0, 0}, {0, 0.6f, 3}, addMaterial(scene, softBox))));
    scene.environment = Environment{glm::vec3(0.25f, 0.28f, 0.32f), -1};
    addCamera(scene, {0, 4.2f, 8}, {0, 0.4f, -1}, 34);
    return scene;
}

const RegisterSample registered{"gallery", makeGallery};

}  // namespace
}  // namespace helio::samples::gallery
