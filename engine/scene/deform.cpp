#include "engine/scene/deform.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace helio {
namespace {

/** Vertices of a primitive in double. */
struct Vertices {
    std::vector<glm::dvec3> positions, normals, tangents;
    std::vector<std::uint8_t> isMirrored;  ///< by the skin; empty for nowhere
};

template <class Work>
void forEach(std::size_t count, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
}

void add(std::vector<glm::dvec3>& to, const std::vector<glm::vec3>& offsets, double weight) {
    if (offsets.size() != to.size()) return;
    forEach(to.size(), [&](std::size_t i) { to[i] += weight * glm::dvec3(offsets[i]); });
}

Vertices morphedVertices(const Primitive& primitive, std::span<const float> weights) {
    Vertices v;
    v.positions.assign(primitive.positions.begin(), primitive.positions.end());
    v.normals.assign(primitive.normals.begin(), primitive.normals.end());
    v.tangents.assign(primitive.tangents.begin(), primitive.tangents.end());
    for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
        if (weights[t] == 0) continue;
        add(v.positions, primitive.targets[t].positions, weights[t]);
        add(v.normals, primitive.targets[t].normals, weights[t]);
        add(v.tangents, primitive.targets[t].tangents, weights[t]);
    }
    return v;
}

/** The matrix of a vertex: its joints', by their weights over the sum of these. */
glm::dmat4 blended(const Primitive& primitive, std::span<const glm::dmat4> joints, std::size_t vertex) {
    glm::dmat4 sum(0.0);
    double total = 0;
    for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
        const glm::u16vec4& joint = primitive.joints[set][vertex];
        const glm::dvec4 weight = primitive.weights[set][vertex];
        for (int k = 0; k < 4; ++k) {
            if (weight[k] == 0) continue;
            sum += weight[k] * joints[joint[k]];
            total += weight[k];
        }
    }
    return total > 0 ? sum / total : joints[primitive.joints[0][vertex].x];
}

/** Cofactors are the inverse transpose times the determinant, and exist for a singular matrix too. */
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& fallback) {
    const double size = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return size > 0 && std::isfinite(size) ? glm::normalize(v / size) : fallback;
}

template <class MatrixOf>
void transform(Vertices& v, const MatrixOf& matrixOf) {
    v.isMirrored.resize(v.positions.size());
    forEach(v.positions.size(), [&](std::size_t i) {
        const glm::dmat4 matrix = matrixOf(i);
        const glm::dmat3 linear(matrix);
        v.isMirrored[i] = glm::determinant(linear) < 0;
        v.positions[i] = glm::dvec3(matrix * glm::dvec4(v.positions[i], 1.0));
        if (!v.normals.empty()) {
            const double sign = v.isMirrored[i] ? -1 : 1;
            v.normals[i] = unitOr(sign * (cofactors(linear) * v.normals[i]), v.normals[i]);
        }
        if (!v.tangents.empty()) v.tangents[i] = unitOr(linear * v.tangents[i], v.tangents[i]);
    });
}

/** Triangles that are mirrored turn around, so that their front stays outside. */
void turnMirrored(const std::vector<std::uint8_t>& isMirrored, std::vector<std::uint32_t>& indices) {
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
        const int mirrored = isMirrored[indices[t]] + isMirrored[indices[t + 1]] + isMirrored[indices[t + 2]];
        if (mirrored >= 2) std::swap(indices[t + 1], indices[t + 2]);
    }
}

glm::vec3 rounded(const glm::dvec3& v) {
    constexpr double largest = std::numeric_limits<float>::max();
    for (int c = 0; c < 3; ++c) {
        if (!(std::abs(v[c]) <= largest)) throw std::range_error("a vertex leaves the range of float");
    }
    return v;
}

Primitive rounded(const Primitive& from, const Vertices& v, const glm::dvec3& origin) {
    Primitive to;
    to.texcoords = from.texcoords;
    to.colors = from.colors;
    to.indices = from.indices;
    to.material = from.material;
    to.variantMaterials = from.variantMaterials;
    for (const glm::dvec3& position : v.positions) to.positions.push_back(rounded(position - origin));
    for (std::size_t i = 0; i < v.normals.size(); ++i)
        to.normals.push_back(unitOr(v.normals[i], glm::dvec3(from.normals[i])));
    for (std::size_t i = 0; i < v.tangents.size(); ++i) {
        const glm::vec3 tangent = unitOr(v.tangents[i], glm::dvec3(from.tangents[i]));
        const float side = v.isMirrored.empty() || !v.isMirrored[i] ? 1.0f : -1.0f;
        to.tangents.emplace_back(tangent, from.tangents[i].w * side);
    }
    if (!v.isMirrored.empty()) turnMirrored(v.isMirrored, to.indices);
    return to;
}

/** The middle of the box around all vertices: offsets from it lose the least to rounding. */
glm::dvec3 middle(const std::vector<Vertices>& primitives) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
    for (const Vertices& v : primitives) {
        for (const glm::dvec3& position : v.positions) {
            lower = glm::min(lower, position);
            upper = glm::max(upper, position);
        }
    }
    return lower.x <= upper.x ? 0.5 * lower + 0.5 * upper : glm::dvec3(0.0);
}

}  // namespace

DeformedMesh morphed(const Mesh& mesh, std::span<const float> weights) {
    DeformedMesh result;
    result.mesh.name = mesh.name;
    for (const Primitive& primitive : mesh.primitives) {
        result.mesh.primitives.push_back(
            rounded(primitive, morphedVertices(primitive, weights), result.origin));
    }
    return result;
}

DeformedMesh skinned(const Mesh& mesh, std::span<const float> weights, std::span<const glm::dmat4> joints,
                     const glm::dmat4& unskinned) {
    std::vector<Vertices> vertices;
    for (const Primitive& primitive : mesh.primitives) {
        Vertices& v = vertices.emplace_back(morphedVertices(primitive, weights));
        if (primitive.joints.empty()) {
            transform(v, [&](std::size_t) { return unskinned; });
        } else {
            transform(v, [&](std::size_t i) { return blended(primitive, joints, i); });
        }
    }
    DeformedMesh result;
    result.mesh.name = mesh.name;
    result.origin = middle(vertices);
    for (std::size_t p = 0; p < vertices.size(); ++p) {
        result.mesh.primitives.push_back(rounded(mesh.primitives[p], vertices[p], result.origin));
        vertices[p] = {};
    }
    return result;
}

}  // namespace helio
