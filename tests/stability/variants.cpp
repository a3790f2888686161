#include "tests/stability/variants.hpp"

#include <algorithm>
#include <array>
#include <random>

namespace helio::test {

Scene transformed(Scene scene, const glm::mat4& transform) {
    Node root;
    root.matrix = transform;
    root.children = scene.roots;
    scene.nodes.push_back(root);
    scene.roots = {int(scene.nodes.size()) - 1};
    return scene;
}

Scene brightened(Scene scene, float factor) {
    for (Material& material : scene.materials) material.emission *= factor;
    for (PunctualLight& light : scene.lights) light.intensity *= factor;
    if (scene.environment) scene.environment->radiance *= factor;
    return scene;
}

namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles(const Primitive& primitive) {
    std::vector<Triangle> result;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
        result.push_back({primitive.indices[i], primitive.indices[i + 1], primitive.indices[i + 2]});
    return result;
}

bool emits(const Scene& scene, const Primitive& primitive) {
    return primitive.material >= 0 &&
           scene.materials[std::size_t(primitive.material)].emission != glm::vec3(0.0f);
}

}  // namespace

Scene permuted(Scene scene, std::uint32_t seed) {
    std::mt19937 random(seed);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            if (emits(scene, primitive)) continue;
            std::vector<Triangle> order = triangles(primitive);
            std::shuffle(order.begin(), order.end(), random);
            primitive.indices.clear();
            for (const Triangle& t : order)
                primitive.indices.insert(primitive.indices.end(), t.begin(), t.end());
        }
    return scene;
}

Scene refined(Scene scene) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            const auto middle = [&primitive](std::uint32_t a, std::uint32_t b) {
                const auto add = [a, b](auto& attribute, auto combine) {
                    if (!attribute.empty()) attribute.push_back(combine(attribute[a], attribute[b]));
                };
                const auto mean = [](auto x, auto y) { return (x + y) * 0.5f; };
                add(primitive.positions, mean);
                add(primitive.normals, [](glm::vec3 x, glm::vec3 y) { return glm::normalize(x + y); });
                add(primitive.tangents, mean);
                for (auto& set : primitive.texcoords) add(set, mean);
                add(primitive.colors, mean);
                return std::uint32_t(primitive.positions.size() - 1);
            };
            const std::vector<Triangle> coarse = triangles(primitive);
            primitive.indices.clear();
            for (const auto& [a, b, c] : coarse) {
                const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
                for (const std::uint32_t index : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
                    primitive.indices.push_back(index);
            }
        }
    return scene;
}

Scene baked(const Scene& scene) {
    Scene result = scene;
    for (Node& node : result.nodes) {
        node.mesh = -1;
        node.copies.clear();
    }
    result.meshes.clear();
    for (const Instance& instance : scene.instances()) {
        Mesh mesh = scene.meshes[std::size_t(instance.mesh)];
        const glm::dmat4& matrix = instance.transform;
        const glm::dmat3 linear(matrix);
        const glm::dmat3 cofactor = glm::transpose(glm::inverse(linear));
        for (Primitive& primitive : mesh.primitives) {
            for (glm::vec3& p : primitive.positions) p = glm::vec3(matrix * glm::dvec4(p, 1.0));
            for (glm::vec3& n : primitive.normals) n = glm::vec3(glm::normalize(cofactor * glm::dvec3(n)));
            for (glm::vec4& t : primitive.tangents)
                t = glm::vec4(glm::vec3(glm::normalize(linear * glm::dvec3(t))), t.w);
            if (glm::determinant(linear) < 0)
                for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
                    std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
        }
        Node node;
        node.mesh = int(result.meshes.size());
        result.meshes.push_back(std::move(mesh));
        result.nodes.push_back(node);
        result.roots.push_back(int(result.nodes.size()) - 1);
    }
    return result;
}

Scene doubled(Scene scene) {
    for (Node& node : scene.nodes) {
        if (node.copies.empty()) node.copies.emplace_back();
        const std::vector<Placement> once = node.copies;
        node.copies.insert(node.copies.end(), once.begin(), once.end());
    }
    return scene;
}

Scene withEmitters(Scene scene, const std::function<bool(std::size_t)>& kept) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (!kept(i)) scene.materials[i].emission = glm::vec3(0.0f);
    return scene;
}

}  // namespace helio::test
