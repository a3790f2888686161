#include "passes/scene/packed_scene.hpp"

#include <heliograph/error.hpp>

namespace helio::pack {

std::vector<std::vector<glm::vec3>> motion(const std::vector<glm::vec3>& positions,
                                           std::span<const Scene> later, const PackOptions& options,
                                           PackedScene& packed, std::vector<Surface>& surfaces) {
    if (!options.tree || options.accelerator != AcceleratorKind::Bvh)
        throw InputError("", "accelerator", "knows no moving triangles",
                         "use bvh, or close the shutter at once");
    std::vector<std::vector<glm::vec3>> keys = {positions};
    packed.normalKeys = packed.normals;
    for (const Scene& scene : later) {
        PackedScene pose;
        std::vector<Surface> same;
        keys.push_back(geometry(scene, options.origin, pose, same));
        if (keys.back().size() != positions.size())
            throw InputError(scene.name, "motion", "has another number of triangles later",
                             "give poses of one scene");
        packed.normalKeys.insert(packed.normalKeys.end(), pose.normals.begin(), pose.normals.end());
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (keys.back()[i] != positions[i]) surfaces[i / 3].moves = true;
    }
    packed.motionKeys = std::uint32_t(keys.size());
    return keys;
}

std::vector<glm::vec3> waysBoxes(const std::vector<std::vector<glm::vec3>>& keys) {
    std::vector<glm::vec3> boxes(keys[0].size());
    for (std::size_t first = 0; first + 2 < boxes.size(); first += 3) {
        glm::vec3 lower = keys[0][first], upper = lower;
        for (const auto& key : keys)
            for (std::size_t i = first; i < first + 3; ++i) {
                lower = glm::min(lower, key[i]);
                upper = glm::max(upper, key[i]);
            }
        // The third corner would add nothing to the box of the other two.
        boxes[first] = boxes[first + 2] = lower;
        boxes[first + 1] = upper;
    }
    return boxes;
}

}  // namespace helio::pack
