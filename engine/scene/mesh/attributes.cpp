#include "engine/scene/mesh/attributes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace helio::mesh {

glm::vec3 linearFromSrgb(glm::vec3 color) {
    for (int c = 0; c < 3; ++c) {
        const double s = std::clamp(double(color[c]), 0.0, 1.0);
        color[c] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return color;
}

bool isNormal(const glm::vec3& normal) {
    return glm::length(glm::dvec3(normal)) > 1e-20;
}

glm::vec3 unit(const glm::vec3& normal) {
    return glm::normalize(glm::dvec3(normal));
}

glm::vec3 faceNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 area = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const double length = glm::length(area);
    return length > 0 ? glm::vec3(area / length) : glm::vec3(0, 0, 1);
}

Material neutralMaterial(bool hasColors) {
    Material material;
    material.baseColor = glm::vec4(glm::vec3(hasColors ? 1.0f : 0.8f), 1);
    material.metallic = 0;
    material.specular = 0;
    return material;
}

Scene sceneOf(const std::string& file) {
    Scene scene;
    scene.name = file;
    const std::string name = std::filesystem::path(file).stem().string();
    scene.meshes.emplace_back().name = name;
    Node node;
    node.name = name;
    node.mesh = 0;
    scene.nodes.push_back(std::move(node));
    scene.roots.push_back(0);
    return scene;
}

}  // namespace helio::mesh
