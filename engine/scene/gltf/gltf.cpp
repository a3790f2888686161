#include "engine/scene/gltf/gltf.hpp"

#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/schema.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

namespace helio {
namespace gltf {

bool isSupported(const std::string& extension) {
    constexpr std::array supported = std::to_array<std::string_view>({
        "EXT_lights_image_based",
        "EXT_mesh_gpu_instancing",
        "EXT_texture_webp",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
    });
    return std::find(supported.begin(), supported.end(), extension) != supported.end();
}

namespace {

void checkExtensions(const Container& container, helio::Scene& scene) {
    for (const auto& extension : listOf(container.document.root(), "extensionsRequired")) {
        const auto& name = extension.get_ref<const std::string&>();
        if (!isSupported(name)) {
            throw InputError(container.file, "extensionsRequired", name + " is not supported",
                             "export the file without " + name);
        }
    }
    for (const auto& extension : listOf(container.document.root(), "extensionsUsed")) {
        const auto& name = extension.get_ref<const std::string&>();
        if (!isSupported(name)) skip(scene, name, "is not supported");
    }
}

/** Materials that some instance shows, under any variant if all are wanted. */
std::set<int> usedMaterials(const helio::Scene& scene, bool everyVariant) {
    std::set<int> used;
    for (const Instance& instance : scene.instances()) {
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            used.insert(primitive.material);
            if (!everyVariant) continue;
            used.insert(primitive.variantMaterials.begin(), primitive.variantMaterials.end());
        }
    }
    return used;
}

}  // namespace
}  // namespace gltf

Scene loadGltf(const std::string& file, const LoadOptions& options, LoadMonitor& monitor) try {
    Scene scene;
    scene.name = file;
    gltf::Container container = gltf::readContainer(file);
    const std::size_t largest = gltf::checkSchema(file, container.document);
    gltf::checkExtensions(container, scene);
    monitor.report("buffers", 0);
    const gltf::Asset asset(std::move(container));
    for (const std::string& place : asset.misaligned())
        warn(scene, place + " is not aligned to its components, as glTF asks for");
    gltf::MemoryBudget memory(asset, largest);
    gltf::buildMeshes(asset, memory, monitor, scene);
    gltf::buildNodes(asset, memory, scene);
    gltf::buildSkins(asset, memory, scene);
    gltf::buildAnimations(asset, memory, scene);
    if (!options.variant.empty()) chooseVariant(scene, options.variant);
    gltf::buildMaterials(asset, gltf::usedMaterials(scene, options.everyVariant), memory, monitor, scene);
    gltf::buildEnvironment(asset, memory, monitor, scene);
    for (const std::string& remark : asset.remarks()) warn(scene, remark);
    const auto isShown = [&](const Node& node) {
        return node.mesh >= 0 && !scene.meshes[std::size_t(node.mesh)].primitives.empty();
    };
    if (scene.roots.empty() || std::none_of(scene.nodes.begin(), scene.nodes.end(), isShown))
        warn(scene, "the file shows no triangles: nothing is to be seen");
    return scene;
} catch (const std::bad_alloc&) {
    throw InputError(file, "", "does not fit in memory", "give a smaller file");
}

}  // namespace helio
