#include "passes/scene/packed_scene.hpp"

#include <heliograph/renderer.hpp>

#include <algorithm>

namespace helio {

std::vector<std::pair<std::string, std::string>> leftOut(const Scene& scene) {
    std::vector<bool> isUsed(scene.materials.size() + 1, false);  // the last is glTF's default material
    for (const Instance& instance : scene.instances()) {
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            const bool isNamed =
                primitive.material >= 0 && std::size_t(primitive.material) < scene.materials.size();
            isUsed[isNamed ? std::size_t(primitive.material) : scene.materials.size()] = true;
        }
    }
    auto result = scene.skipped;
    for (auto& entry : pack::notShown(scene, isUsed)) {
        if (std::ranges::find(result, entry) == result.end()) result.push_back(std::move(entry));
    }
    return result;
}

}  // namespace helio
