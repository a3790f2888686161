#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helio::gltf {
namespace {

using nlohmann::json;

void buildCameras(const Asset& asset, helio::Scene& scene) {
    for (std::size_t i = 0; i < asset.document().size("cameras"); ++i) {
        const json from = asset.document().element("cameras", i);
        Camera camera;
        camera.name = from.value("name", "");
        camera.perspective = from["type"] == "perspective";
        const json& lens = from[camera.perspective ? "perspective" : "orthographic"];
        const double zfar = numberOr(lens, "zfar", 0), znear = numberOr(lens, "znear", 0);
        if (zfar > 0 && !(zfar > znear)) {
            throw InputError(asset.file(), fmt::format("cameras[{}]", scene.cameras.size()),
                             "has zfar before znear", "give a zfar above znear");
        }
        if (camera.perspective) {
            camera.yfov = float(numberOr(lens, "yfov", 0));
            camera.aspectRatio = float(numberOr(lens, "aspectRatio", 0));
        } else {
            const double ymag = numberOr(lens, "ymag", 1);
            camera.ymag = float(ymag);
            camera.aspectRatio = float(std::abs(numberOr(lens, "xmag", 1)) / ymag);
        }
        camera.znear = float(znear);
        if (zfar > 0) camera.zfar = float(zfar);
        extras::readCamera(asset.file(), from, int(scene.cameras.size()), camera);
        scene.cameras.push_back(std::move(camera));
    }
}

/** KHR_lights_punctual. Candela and lux are taken as W/sr and W/m^2 (the contract's radiometry). */
void buildLights(const Asset& asset, MemoryBudget& memory, helio::Scene& scene) {
    const json& document = asset.document().root();
    const json::json_pointer path("/extensions/KHR_lights_punctual/lights");
    if (!document.contains(path)) return;
    memory.take("extensions.KHR_lights_punctual.lights", document[path].size() * sizeof(PunctualLight), 0);
    scene.lights.reserve(document[path].size());
    for (const json& from : document[path]) {
        PunctualLight light;
        light.name = from.value("name", "");
        const auto& type = from["type"].get_ref<const std::string&>();
        if (type == "spot") light.type = PunctualLight::Type::Spot;
        if (type == "directional") light.type = PunctualLight::Type::Directional;
        if (from.contains("color")) {
            for (int c = 0; c < 3; ++c) light.intensity[c] = from["color"][std::size_t(c)].get<float>();
        }
        light.intensity *= from.value("intensity", 1.0f);
        light.range = from.value("range", 0.0f);
        if (from.contains("spot")) {
            light.innerConeAngle = from["spot"].value("innerConeAngle", light.innerConeAngle);
            light.outerConeAngle = from["spot"].value("outerConeAngle", light.outerConeAngle);
        }
        if (light.type == PunctualLight::Type::Spot && !(light.innerConeAngle < light.outerConeAngle)) {
            throw InputError(
                asset.file(),
                fmt::format("extensions.KHR_lights_punctual.lights[{}].spot", scene.lights.size()),
                "has its inner cone outside its outer cone", "give innerConeAngle < outerConeAngle");
        }
        scene.lights.push_back(std::move(light));
    }
}

glm::mat4 matrixOf(const Asset& asset, const json& values, std::size_t node) {
    glm::mat4 matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix[int(i / 4)][int(i % 4)] = values[i].get<float>();
    const glm::vec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (last != glm::vec4(0, 0, 0, 1)) {
        throw InputError(asset.file(), fmt::format("nodes[{}].matrix", node), "is not affine",
                         "give column-major numbers whose 4th row is 0 0 0 1");
    }
    return matrix;
}

glm::quat rotationOf(const Asset& asset, const json& values, std::size_t node, helio::Scene& scene) {
    const auto number = [&values](std::size_t i) { return values[i].get<double>(); };
    const glm::dquat q(number(3), number(0), number(1), number(2));
    const double length = glm::length(q);
    if (!(length > 1e-6)) {
        throw InputError(asset.file(), fmt::format("nodes[{}].rotation", node), "is no unit quaternion",
                         "give x, y, z, w of length 1");
    }
    if (std::abs(length - 1) > 0.01)
        warn(scene, fmt::format("nodes[{}].rotation is a quaternion of length {:.3g}, not 1", node, length));
    return glm::quat(q / length);
}

/** EXT_mesh_gpu_instancing: accessors of one translation, rotation and scale per copy of the node's mesh. */
std::vector<Placement> copiesOf(const Asset& asset, const json& attributes, std::size_t node,
                                MemoryBudget& memory, helio::Scene& scene) {
    const std::string place = fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing.attributes", node);
    std::vector<Placement> copies;
    bool isFirst = true;
    for (const auto& [name, value] : attributes.items()) {
        const int accessor = value.get<int>();
        asset.check(accessor);
        if (!isFirst && asset.count(accessor) != copies.size()) {
            throw InputError(
                asset.file(), place + "." + name,
                fmt::format("has {} elements, another attribute {}", asset.count(accessor), copies.size()),
                "give every attribute one element per copy");
        }
        if (isFirst) {
            const std::size_t count = asset.count(accessor);
            memory.take(place, count * (sizeof(Placement) + sizeof(Instance)), count * 4 * sizeof(float));
        }
        isFirst = false;
        copies.resize(asset.count(accessor));
        if (name == "ROTATION") {
            const std::vector<float> values = asset.floats(accessor, 4, place + "." + name);
            for (std::size_t i = 0; i < copies.size(); ++i) {
                const float* const q = &values[i * 4];
                copies[i].rotation = glm::quat(q[3], q[0], q[1], q[2]);
            }
        } else if (name == "TRANSLATION" || name == "SCALE") {
            const std::vector<float> values = asset.floats(accessor, 3, place + "." + name);
            for (std::size_t i = 0; i < copies.size(); ++i) {
                glm::vec3& part = name == "SCALE" ? copies[i].scale : copies[i].translation;
                part = glm::vec3(values[i * 3], values[i * 3 + 1], values[i * 3 + 2]);
            }
        } else {
            skip(scene, "attribute " + name + " of copies", "the scene model has no place for it");
        }
    }
    return copies;
}

Node nodeOf(const Asset& asset, const json& from, std::size_t index, MemoryBudget& memory,
            helio::Scene& scene) {
    Node node;
    node.name = from.value("name", "");
    for (const json& child : listOf(from, "children")) node.children.push_back(child.get<int>());
    if (from.contains("matrix")) node.matrix = matrixOf(asset, from["matrix"], index);
    node.translation = vectorOr(from, "translation", node.translation);
    if (from.contains("rotation")) node.rotation = rotationOf(asset, from["rotation"], index, scene);
    node.scale = vectorOr(from, "scale", node.scale);
    node.mesh = integerOr(from, "mesh", -1);
    const int skin = integerOr(from, "skin", -1);
    if (node.mesh >= 0 && !scene.meshes[std::size_t(node.mesh)].primitives.empty()) {
        node.weights =
            morphWeights(asset, from, scene.meshes[std::size_t(node.mesh)].primitives[0].targets.size(),
                         fmt::format("nodes[{}].weights", index));
        node.skin = skin;
    }
    node.camera = integerOr(from, "camera", -1);
    const std::size_t meshes = scene.meshes.size();
    extras::readNode(asset.file(), from, index, asset.document().size("materials"), node, scene);
    if (scene.meshes.size() > meshes) memory.take("nodes", sizeof(Mesh) + sizeof(Primitive), 0);
    for (const auto& [name, value] : extensionsOf(from).items()) {
        if (name == "KHR_lights_punctual") {
            node.light = integerOr(value, "light", -1);
        } else if (name == "EXT_mesh_gpu_instancing") {
            if (skin >= 0) {
                skip(scene, "EXT_mesh_gpu_instancing of skinned meshes", "one is shown where its skin says");
            } else {
                node.copies = copiesOf(asset, value["attributes"], index, memory, scene);
            }
        } else {
            skip(scene, name, "is not supported");
        }
    }
    return node;
}

/** Every node's parent, -1 for a root. Refuses a second parent and, with that, finds every cycle as nodes
 * that no root leads to. */
std::vector<int> parents(const Asset& asset, const helio::Scene& scene) {
    std::vector<int> parent(scene.nodes.size(), -1);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (int child : scene.nodes[i].children) {
            if (parent[std::size_t(child)] >= 0 || child == int(i)) {
                throw InputError(asset.file(), fmt::format("nodes[{}]", child),
                                 child == int(i) ? "is its own child" : "has two parents",
                                 "nodes must form trees");
            }
            parent[std::size_t(child)] = int(i);
        }
    }
    std::vector<int> reached;
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (parent[i] < 0) reached.push_back(int(i));
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const auto& children = scene.nodes[std::size_t(reached[i])].children;
        reached.insert(reached.end(), children.begin(), children.end());
    }
    if (reached.size() < parent.size()) {
        std::vector<bool> isReached(parent.size(), false);
        for (int node : reached) isReached[std::size_t(node)] = true;
        const auto first = std::find(isReached.begin(), isReached.end(), false) - isReached.begin();
        throw InputError(asset.file(), fmt::format("nodes[{}]", first), "is in a cycle",
                         "nodes must form trees");
    }
    return parent;
}

}  // namespace

void buildNodes(const Asset& asset, MemoryBudget& memory, helio::Scene& scene) {
    const Document& document = asset.document();
    const std::size_t nodes = document.size("nodes"), cameras = document.size("cameras");
    memory.take("cameras", cameras * sizeof(Camera), 0);
    scene.cameras.reserve(cameras);
    buildCameras(asset, scene);
    buildLights(asset, memory, scene);
    // A node's own, its children's indices in the list, and as an instance.
    memory.take("nodes", nodes * (sizeof(Node) + 3 * sizeof(int) + sizeof(Instance)), 0);
    scene.nodes.reserve(nodes);
    for (std::size_t i = 0; i < nodes; ++i)
        scene.nodes.push_back(nodeOf(asset, document.element("nodes", i), i, memory, scene));
    const std::vector<int> parent = parents(asset, scene);
    const std::size_t scenes = document.size("scenes");
    if (scenes == 0) {
        for (std::size_t i = 0; i < parent.size(); ++i) {
            if (parent[i] < 0) scene.roots.push_back(int(i));
        }
        return;
    }
    const auto shown = std::size_t(integerOr(document.root(), "scene", 0));
    if (scenes > 1) {
        skip(scene, fmt::format("{} further scenes", scenes - 1), fmt::format("scene {} is shown", shown));
    }
    std::vector<bool> isNamed(parent.size(), false);
    const json from = document.element("scenes", shown);
    for (const json& named : listOf(from, "nodes")) {
        const int root = named.get<int>();
        const bool isTwice = isNamed[std::size_t(root)];
        isNamed[std::size_t(root)] = true;
        scene.roots.push_back(root);
        if (parent[std::size_t(root)] >= 0 || isTwice) {
            throw InputError(asset.file(), fmt::format("scenes[{}].nodes[{}]", shown, scene.roots.size() - 1),
                             isTwice ? "names a node twice" : "names a node that has a parent",
                             "name root nodes, once each");
        }
    }
}

}  // namespace helio::gltf
