#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** Matrices of an accessor that may hold more than the joints ask for. */
std::vector<glm::mat4> matrices(const Asset& asset, int accessor, std::size_t joints,
                                const std::string& place, MemoryBudget& memory) {
    asset.check(accessor);
    const std::size_t count = asset.count(accessor);
    if (count < joints) {
        throw InputError(asset.file(), place, fmt::format("has {} matrices for {} joints", count, joints),
                         "give one matrix per joint");
    }
    memory.take(place, joints * sizeof(glm::mat4), count * sizeof(glm::mat4));
    const std::vector<float> values = asset.floats(accessor, 16, place);
    std::vector<glm::mat4> result(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        for (std::size_t i = 0; i < 16; ++i) result[j][int(i / 4)][int(i % 4)] = values[j * 16 + i];
        // Exporters compute an inverse, whose last row is off by rounding.
        constexpr float tolerance = 1e-3f;
        for (int c = 0; c < 4; ++c) {
            const float exact = c == 3 ? 1.0f : 0.0f;
            if (!(std::abs(result[j][c][3] - exact) <= tolerance)) {
                throw InputError(asset.file(), place, fmt::format("matrix {} is not affine", j),
                                 "give column-major numbers whose 4th row is 0 0 0 1");
            }
            result[j][c][3] = exact;
        }
    }
    return result;
}

/** The greatest index into a skin's joints that a mesh names; -1 where it names none. */
int greatestJoint(const Mesh& mesh) {
    int greatest = -1;
    for (const Primitive& primitive : mesh.primitives) {
        for (const auto& set : primitive.joints) {
            for (const glm::u16vec4& four : set)
                greatest = std::max({greatest, int(four.x), int(four.y), int(four.z), int(four.w)});
        }
    }
    return greatest;
}

}  // namespace

void buildSkins(const Asset& asset, MemoryBudget& memory, helio::Scene& scene) {
    const std::size_t count = asset.document().size("skins");
    if (count == 0) return;
    scene.skins.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const json from = asset.document().element("skins", i);
        memory.take(fmt::format("skins[{}].joints", i), from["joints"].size() * sizeof(int) + sizeof(Skin),
                    0);
        Skin skin;
        skin.joints.reserve(from["joints"].size());
        skin.name = from.value("name", "");
        for (const json& joint : from["joints"]) skin.joints.push_back(joint.get<int>());
        if (std::set<int>(skin.joints.begin(), skin.joints.end()).size() < skin.joints.size())
            warn(scene, fmt::format("skins[{}].joints names a node twice", i));
        if (from.contains("inverseBindMatrices")) {
            skin.inverseBindMatrices =
                matrices(asset, from["inverseBindMatrices"].get<int>(), skin.joints.size(),
                         fmt::format("skins[{}].inverseBindMatrices", i), memory);
        }
        scene.skins.push_back(std::move(skin));
    }
    std::vector<int> greatest(scene.meshes.size(), -2);  // -2: not looked for yet
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.skin < 0) continue;
        int& joint = greatest[std::size_t(node.mesh)];
        if (joint == -2) joint = greatestJoint(scene.meshes[std::size_t(node.mesh)]);
        const std::size_t joints = scene.skins[std::size_t(node.skin)].joints.size();
        if (joint >= int(joints)) {
            throw InputError(asset.file(), fmt::format("nodes[{}].skin", i),
                             fmt::format("has {} joints, the mesh names joint {}", joints, joint),
                             "keep JOINTS_0 below the number of joints");
        }
    }
}

}  // namespace helio::gltf
