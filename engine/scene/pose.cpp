#include "engine/scene/deform.hpp"

#include <heliograph/error.hpp>
#include <heliograph/pose.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

namespace helio {
namespace {

/** The animation to show; nullptr for none. */
const Animation* chooseAnimation(const Scene& scene, const std::string& nameOrIndex) {
    if (nameOrIndex.empty()) return scene.animations.empty() ? nullptr : &scene.animations.front();
    const auto named = std::ranges::find(scene.animations, nameOrIndex, &Animation::name);
    if (named != scene.animations.end()) return &*named;
    if (nameOrIndex == "none") return nullptr;
    std::size_t index = 0;
    const char* const end = nameOrIndex.data() + nameOrIndex.size();
    const auto [parsed, error] = std::from_chars(nameOrIndex.data(), end, index);
    if (error == std::errc() && parsed == end && index < scene.animations.size())
        return &scene.animations[index];
    std::string known;
    for (std::size_t i = 0; i < std::min<std::size_t>(scene.animations.size(), 20); ++i)
        known += fmt::format("{}{} ({})", i == 0 ? "" : ", ", i, scene.animations[i].name);
    throw InputError(scene.name, "animation", fmt::format("there is no animation '{}'", nameOrIndex),
                     known.empty() ? "the scene has none" : "give one of " + known);
}

void apply(const AnimationChannel& channel, double time, Node& node) {
    const std::vector<double> value = valueAt(channel, time);
    switch (channel.path) {
        case AnimationPath::Translation:
            node.translation = glm::dvec3(value[0], value[1], value[2]);
            break;
        case AnimationPath::Rotation:
            node.rotation = glm::quat(glm::dquat(value[3], value[0], value[1], value[2]));
            break;
        case AnimationPath::Scale:
            node.scale = glm::dvec3(value[0], value[1], value[2]);
            break;
        case AnimationPath::Weights:
            node.weights.assign(value.begin(), value.end());
    }
}

/** Node to world for every node, those that no root leads to included: a skin may name any. */
std::vector<glm::dmat4> worldTransforms(const Scene& scene) {
    std::vector<int> parent(scene.nodes.size(), -1);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (int child : scene.nodes[i].children) {
            if (child < 0 || std::size_t(child) >= scene.nodes.size() || parent[std::size_t(child)] >= 0)
                throw InputError(scene.name, fmt::format("node {}", i),
                                 fmt::format("its child {} does not exist or has two parents", child),
                                 "nodes must form trees");
            parent[std::size_t(child)] = int(i);
        }
    }
    std::vector<glm::dmat4> toWorld(scene.nodes.size());
    std::vector<int> order;
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (parent[i] < 0) order.push_back(int(i));
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto index = std::size_t(order[i]);
        const Node& node = scene.nodes[index];
        const glm::dmat4 local = node.localTransform();
        toWorld[index] = parent[index] < 0 ? local : toWorld[std::size_t(parent[index])] * local;
        order.insert(order.end(), node.children.begin(), node.children.end());
    }
    if (order.size() < scene.nodes.size())
        throw InputError(scene.name, "nodes", "have a cycle", "nodes must form trees");
    return toWorld;
}

/** Gives every node whose mesh is deformed a mesh of its own, shared where targets alone make it the same. */
class Deformer {
public:
    explicit Deformer(Scene& scene) : scene_(scene), toWorld_(worldTransforms(scene)) {}

    void run() {
        const std::size_t original = scene_.meshes.size();
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (scene_.nodes[i].mesh >= 0) deform(i);
        }
        std::vector<bool> isShown(scene_.meshes.size(), false);
        for (const Node& node : scene_.nodes) {
            if (node.mesh >= 0) isShown[std::size_t(node.mesh)] = true;
        }
        for (std::size_t m = 0; m < original; ++m) {
            Mesh& mesh = scene_.meshes[m];
            if (!isShown[m]) mesh.primitives.clear();
            mesh.weights.clear();
            for (Primitive& primitive : mesh.primitives) {
                primitive.targets.clear();
                primitive.joints.clear();
                primitive.weights.clear();
            }
        }
    }

private:
    void deform(std::size_t index) try {
        Node& node = scene_.nodes[index];
        const Mesh& mesh = scene_.meshes[std::size_t(node.mesh)];
        const std::vector<float> weights = node.weights.empty() ? mesh.weights : node.weights;
        const bool isMoved = std::ranges::any_of(weights, [](float weight) { return weight != 0; });
        if (node.skin >= 0) {
            DeformedMesh deformed = skinned(mesh, weights, joints(node.skin), toWorld_[index]);
            node.mesh = keep(std::move(deformed.mesh));
            node.meshOrigin = deformed.origin;
            node.copies.clear();
        } else if (isMoved) {
            const auto [known, isNew] = morphed_.try_emplace({node.mesh, weights}, -1);
            if (isNew) known->second = keep(morphed(mesh, weights).mesh);
            node.mesh = known->second;
        }
        node.skin = -1;
        node.weights.clear();
    } catch (const std::range_error&) {
        throw InputError(scene_.name, fmt::format("node {}", index),
                         "its mesh is deformed to coordinates that no float holds",
                         "give smaller transforms and weights");
    }

    int keep(Mesh mesh) {
        for (const Primitive& primitive : mesh.primitives) vertices_ += primitive.positions.size();
        if (vertices_ > mostVertices)
            throw InputError(scene_.name, "nodes",
                             fmt::format("deform meshes to more than {} vertices", mostVertices),
                             "let fewer nodes share a mesh that is deformed");
        scene_.meshes.push_back(std::move(mesh));
        return int(scene_.meshes.size()) - 1;
    }

    std::vector<glm::dmat4> joints(int index) const {
        const Skin& skin = scene_.skins[std::size_t(index)];
        std::vector<glm::dmat4> matrices;
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            const glm::dmat4& toWorld = toWorld_[std::size_t(skin.joints[j])];
            matrices.push_back(skin.inverseBindMatrices.empty()
                                   ? toWorld
                                   : toWorld * glm::dmat4(skin.inverseBindMatrices[j]));
        }
        return matrices;
    }

    /** Every node with a skin has vertices of its own: a small file may not fill the memory with them. */
    static constexpr std::size_t mostVertices = std::size_t(1) << 26;

    Scene& scene_;
    std::vector<glm::dmat4> toWorld_;
    std::size_t vertices_ = 0;
    std::map<std::pair<int, std::vector<float>>, int> morphed_;
};

}  // namespace

bool needsPose(const Scene& scene) {
    return !scene.animations.empty() || std::ranges::any_of(scene.nodes, [](const Node& node) {
        return node.skin >= 0;
    }) || std::ranges::any_of(scene.meshes, [](const Mesh& mesh) {
        return std::ranges::any_of(mesh.primitives, [](const Primitive& p) { return !p.targets.empty(); });
    });
}

Scene posed(Scene scene, double time, const std::string& animation) {
    scene.validate();
    if (!std::isfinite(time))
        throw InputError(scene.name, "frame time", fmt::format("is {}", time),
                         "give a finite time in seconds");
    if (const Animation* const chosen = chooseAnimation(scene, animation)) {
        for (const AnimationChannel& channel : chosen->channels)
            apply(channel, time, scene.nodes[std::size_t(channel.node)]);
    }
    Deformer(scene).run();
    scene.animations.clear();
    scene.skins.clear();
    return scene;
}

}  // namespace helio
