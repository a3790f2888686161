#include "engine/scene/gltf/frames.hpp"

#include "engine/scene/parallel.hpp"

#include <cmath>

namespace helio::gltf {

void fixNormals(Primitive& primitive) {
    auto& normals = primitive.normals;
    const auto hasLength = [&](std::size_t i) { return glm::length(glm::dvec3(normals[i])) > 1e-20; };
    forBlocks(normals.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (hasLength(i)) normals[i] = glm::normalize(glm::dvec3(normals[i]));
        }
    });
    const std::size_t first = firstWhere(normals.size(), [&](std::size_t i) { return !hasLength(i); });
    if (first == normals.size()) return;
    std::vector<glm::dvec3> mean(primitive.positions.size());
    for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
        const std::uint32_t* const corner = &primitive.indices[t];
        const glm::dvec3 a = primitive.positions[corner[0]];
        const glm::dvec3 area = glm::cross(glm::dvec3(primitive.positions[corner[1]]) - a,
                                           glm::dvec3(primitive.positions[corner[2]]) - a);
        for (int k = 0; k < 3; ++k) mean[corner[k]] += area;
    }
    for (std::size_t i = first; i < normals.size(); ++i) {
        if (hasLength(i)) continue;
        const double length = glm::length(mean[i]);
        normals[i] = length > 0 ? glm::vec3(mean[i] / length) : glm::vec3(0, 0, 1);
    }
}

void fixTangents(Primitive& primitive) {
    const auto fixed = [&](std::size_t i) {
        glm::dvec3 tangent(primitive.tangents[i]);
        if (!(glm::length(tangent) > 1e-20)) {
            const glm::dvec3 normal = primitive.normals.empty() ? glm::vec3(0, 0, 1) : primitive.normals[i];
            tangent =
                glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
        }
        return glm::vec4(glm::vec3(glm::normalize(tangent)), primitive.tangents[i].w < 0 ? -1 : 1);
    };
    forBlocks(primitive.tangents.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) primitive.tangents[i] = fixed(i);
    });
}

}  // namespace helio::gltf
