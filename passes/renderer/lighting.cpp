#include "passes/renderer/lighting.hpp"

#include <algorithm>

namespace helio {
namespace {

bool emits(const Scene& scene, const Primitive& primitive) {
    return primitive.material >= 0 && std::size_t(primitive.material) < scene.materials.size() &&
           scene.materials[std::size_t(primitive.material)].emission != glm::vec3(0.0f);
}

}  // namespace

bool hasLight(const Scene& scene, const std::optional<Environment>& environment) {
    if (environment && environment->radiance != glm::vec3(0.0f)) return true;
    const std::vector<PlacedLight> lights = scene.placedLights();
    if (std::ranges::any_of(lights, [&](const PlacedLight& placed) {
            return scene.lights[std::size_t(placed.light)].intensity != glm::vec3(0.0f);
        })) {
        return true;
    }
    const std::vector<Instance> instances = scene.instances();
    return std::ranges::any_of(instances, [&](const Instance& instance) {
        const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
        return std::ranges::any_of(mesh.primitives, [&](const Primitive& p) { return emits(scene, p); });
    });
}

Scene whiteScene(const Scene& scene) {
    Scene white = scene;
    for (Material& material : white.materials) {
        Material plain;
        plain.name = material.name;
        plain.metallic = 0.0f;
        plain.specular = 0.0f;
        plain.normalTexture = material.normalTexture;
        plain.normalScale = material.normalScale;
        plain.heightTexture = material.heightTexture;
        plain.heightScale = material.heightScale;
        material = plain;
    }
    // What has no material would be glTF's default, a metal.
    Material plain;
    plain.metallic = 0.0f;
    plain.specular = 0.0f;
    white.materials.push_back(plain);
    for (Mesh& mesh : white.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.colors.clear();
            if (primitive.material < 0) primitive.material = int(white.materials.size()) - 1;
        }
    for (Node& node : white.nodes) node.light = -1;
    return white;
}

std::optional<Environment> chooseEnvironment(const Scene& scene, const RenderOptions& options,
                                             std::vector<std::string>& warnings) {
    if (options.integrator == Integrator::AmbientOcclusion) return Environment{glm::vec3(1.0f), -1};
    const std::optional<Environment>& chosen = options.environment ? options.environment : scene.environment;
    if (hasLight(scene, chosen)) return chosen;
    if (options.environment) {
        warnings.push_back(
            "nothing in the scene gives light and the environment is black: so is the picture");
        return chosen;
    }
    warnings.push_back(
        "nothing in the scene gives light: it is lit by an environment of radiance 1 from everywhere; "
        "--environment 0,0,0 turns that off");
    return Environment{glm::vec3(1.0f), -1};
}

}  // namespace helio
