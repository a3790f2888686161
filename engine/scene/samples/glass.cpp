/** @file
 * The Cornell box with a mirror sphere and a glass sphere in place of its blocks, 81,920 triangles each:
 * caustics on floor and wall, and light that no sample of the lamp finds.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <algorithm>

namespace helio::samples::glass {
namespace {

void addSphere(Scene& scene, Material material, glm::vec3 centre) {
    Node node;
    node.name = material.name;
    const std::string name = material.name;
    node.mesh = addMesh(scene, name, sphereShape(64, addMaterial(scene, std::move(material))));
    node.translation = centre;
    node.scale = glm::vec3(centre.y);  // it stands on the floor
    addRoot(scene, node);
}

Scene makeGlass() {
    Scene scene = makeSample("cornell");
    std::erase_if(scene.roots, [&](int root) {
        return scene.nodes[std::size_t(root)].name.find("block") != std::string::npos;
    });
    Material mirror;
    mirror.name = "mirror sphere";
    mirror.scattering = Scattering{};
    mirror.scattering->model = Scattering::Model::Mirror;
    addSphere(scene, mirror, {380, 100, 390});
    Material glass;
    glass.name = "glass sphere";
    glass.metallic = 0;
    glass.roughness = 0;
    glass.transmission = 1;
    glass.thickness = 1;
    addSphere(scene, glass, {170, 100, 190});
    return scene;
}

const RegisterSample registered{"glass", makeGlass};

}  // namespace
}  // namespace helio::samples::glass
