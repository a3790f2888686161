#include "engine/scene/shape.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace helio {
namespace {

bool inRange(int index, std::size_t size) {
    return index >= 0 && std::size_t(index) < size;
}

void checkReference(const Scene& scene, int node, const char* what, int index, std::size_t size) {
    if (index < 0 || std::size_t(index) < size) return;
    throw InputError(scene.name, fmt::format("node {}", node),
                     fmt::format("its {} {} does not exist", what, index),
                     fmt::format("the scene has {}", size));
}

/** Visits the nodes under the roots depth first, parents before children, with their world transforms. The
 * stack is explicit, with an entry per level: neither a chain nor a list of a million nodes must fill it. */
template <class Visit>
void visitNodes(const Scene& scene, Visit&& visit) {
    struct Level {
        std::span<const int> left;
        int parent;
        glm::dmat4 parentToWorld;
    };
    std::vector<Level> levels{{scene.roots, -1, glm::dmat4(1.0)}};
    std::vector<bool> seen(scene.nodes.size(), false);
    while (!levels.empty()) {
        Level& level = levels.back();
        if (level.left.empty()) {
            levels.pop_back();
            continue;
        }
        const int index = level.left.front();
        level.left = level.left.subspan(1);
        if (!inRange(index, scene.nodes.size())) {
            throw InputError(scene.name, level.parent < 0 ? "roots" : fmt::format("node {}", level.parent),
                             fmt::format("node {} does not exist", index),
                             fmt::format("the scene has {} nodes", scene.nodes.size()));
        }
        const Node& node = scene.nodes[std::size_t(index)];
        if (seen[std::size_t(index)]) {
            throw InputError(scene.name, fmt::format("node {}", index),
                             "is reached twice: the hierarchy has a cycle or a node with two parents",
                             "nodes must form trees; place a mesh again with another node");
        }
        seen[std::size_t(index)] = true;
        const glm::dmat4 toWorld = level.parentToWorld * node.localTransform();
        visit(index, node, toWorld);
        if (!node.children.empty()) levels.push_back({node.children, index, toWorld});
    }
}

/** Calls visit(Instance) for each. */
template <class Visit>
void visitInstances(const Scene& scene, Visit&& visit) {
    visitNodes(scene, [&](int index, const Node& node, const glm::dmat4& toWorld) {
        checkReference(scene, index, "mesh", node.mesh, scene.meshes.size());
        if (node.mesh < 0) return;
        const glm::dmat4 transform =
            node.meshOrigin ? glm::translate(glm::dmat4(1.0), *node.meshOrigin) : toWorld;
        if (node.copies.empty()) visit(Instance{index, node.mesh, transform});
        for (const Placement& copy : node.copies)
            visit(Instance{index, node.mesh, transform * copy.matrix()});
    });
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void extend(Scene::Bounds& bounds, const glm::dvec3& point) {
    bounds.lower = glm::min(bounds.lower, point);
    bounds.upper = glm::max(bounds.upper, point);
}

Scene::Bounds objectBounds(const Mesh& mesh) {
    Scene::Bounds bounds;
    for (const Primitive& primitive : mesh.primitives) {
        for (std::uint32_t index : primitive.indices) {
            const glm::dvec3 point = primitive.positions[index];
            if (isFinite(point)) extend(bounds, point);
        }
    }
    return bounds;
}

/** Whether the transformed box lies inside, so that its mesh cannot extend the bounds. */
bool boxIsInside(const Scene::Bounds& box, const glm::dmat4& transform, const Scene::Bounds& bounds) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 point(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                               corner & 4 ? box.upper.z : box.lower.z, 1.0);
        const glm::dvec3 world(transform * point);
        if (!glm::all(glm::greaterThanEqual(world, bounds.lower)) ||
            !glm::all(glm::lessThanEqual(world, bounds.upper))) {
            return false;
        }
    }
    return true;
}

}  // namespace

glm::dmat4 Placement::matrix() const {
    // A float quaternion is off unit length by 1e-7; normalised in double the rotation is rigid to 1e-16.
    const glm::dquat q(rotation);
    const double length = glm::length(q);
    const glm::dmat4 rotate = length > 0 ? glm::mat4_cast(q / length) : glm::dmat4(1.0);
    return glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(translation)) * rotate, glm::dvec3(scale));
}

glm::dmat4 Node::localTransform() const {
    return matrix ? glm::dmat4(*matrix) : Placement{translation, rotation, scale}.matrix();
}

std::vector<Instance> Scene::instances() const {
    std::size_t most = 0;
    for (const Node& node : nodes) most += node.mesh < 0 ? 0 : std::max<std::size_t>(node.copies.size(), 1);
    std::vector<Instance> placed;
    placed.reserve(most);
    visitInstances(*this, [&](const Instance& instance) { placed.push_back(instance); });
    return placed;
}

std::vector<PlacedCamera> Scene::placedCameras() const {
    std::vector<PlacedCamera> placed;
    visitNodes(*this, [&](int index, const Node& node, const glm::dmat4& toWorld) {
        checkReference(*this, index, "camera", node.camera, cameras.size());
        if (node.camera >= 0) placed.push_back({index, node.camera, toWorld});
    });
    return placed;
}

std::vector<PlacedLight> Scene::placedLights() const {
    std::vector<PlacedLight> placed;
    visitNodes(*this, [&](int index, const Node& node, const glm::dmat4& toWorld) {
        checkReference(*this, index, "light", node.light, lights.size());
        if (node.light >= 0) placed.push_back({index, node.light, toWorld});
    });
    return placed;
}

std::vector<PlacedMeter> Scene::placedMeters() const {
    std::vector<PlacedMeter> placed;
    visitNodes(*this, [&](int index, const Node& node, const glm::dmat4& toWorld) {
        checkReference(*this, index, "meter", node.meter, meters.size());
        if (node.meter >= 0) placed.push_back({index, node.meter, toWorld});
    });
    return placed;
}

Scene::Bounds Scene::bounds() const {
    std::vector<Bounds> boxes;
    for (const Mesh& mesh : meshes) boxes.push_back(objectBounds(mesh));
    Bounds bounds;
    visitInstances(*this, [&](const Instance& instance) {
        const Bounds& box = boxes[std::size_t(instance.mesh)];
        for (const Primitive& primitive : meshes[std::size_t(instance.mesh)].primitives) {
            if (!primitive.shape) continue;
            const Bounds shape = shapeBounds(placeShape(*this, instance, *primitive.shape));
            extend(bounds, shape.lower);
            extend(bounds, shape.upper);
        }
        if (box.empty() || boxIsInside(box, instance.transform, bounds)) return;
        for (const Primitive& primitive : meshes[std::size_t(instance.mesh)].primitives) {
            for (std::uint32_t index : primitive.indices) {
                const glm::dvec3 point(instance.transform * glm::dvec4(primitive.positions[index], 1.0));
                if (isFinite(point)) extend(bounds, point);
            }
        }
    });
    return bounds;
}

std::uint64_t Scene::triangleCount() const {
    std::uint64_t count = 0;
    visitInstances(*this, [&](const Instance& instance) {
        for (const Primitive& primitive : meshes[std::size_t(instance.mesh)].primitives)
            count += primitive.indices.size() / 3;
    });
    return count;
}

std::uint64_t Scene::shapeCount() const {
    std::uint64_t count = 0;
    visitInstances(*this, [&](const Instance& instance) {
        for (const Primitive& primitive : meshes[std::size_t(instance.mesh)].primitives)
            count += primitive.shape ? 1 : 0;
    });
    return count;
}

}  // namespace helio
