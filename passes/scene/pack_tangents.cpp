/** @file
 * Tangents where a mesh brings none: those of Mikkelsen's "Simulation of wrinkled surfaces revisited", 2008
 * (MikkTSpace), which glTF names. Corners of one position, normal and texture coordinate share a tangent, the
 * mean of their triangles' weighted by the corners' angles; corners whose texture is mirrored do not join the
 * others. Unlike the original, corners are joined wherever they coincide, also where their triangles share no
 * edge.
 *
 * glTF's v runs down the image and a normal map's green points up: the bitangent is cross(normal, tangent)
 * times the sign w, and points against v.
 */
#include "passes/scene/packed_scene.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

namespace helio::pack {
namespace {

using Key = std::array<std::uint32_t, 9>;
struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::uint64_t h = 0x9e3779b97f4a7c15ull;
        for (std::uint32_t word : key) h = (h ^ word) * 0xd6e8feb86659fd93ull, h ^= h >> 32;
        return std::size_t(h);
    }
};

Key keyOf(const glm::vec3& p, const glm::vec3& n, const glm::vec2& uv, bool mirrored) {
    const std::array<float, 8> values{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
    Key key{};
    // -0 equals 0.
    for (std::size_t i = 0; i < values.size(); ++i) key[i] = std::bit_cast<std::uint32_t>(values[i] + 0.0f);
    key[8] = mirrored ? 1 : 0;
    return key;
}

glm::dvec3 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : glm::dvec3(0);
}
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& n) {
    return unitOrZero(v - glm::dot(v, n) * n);
}

}  // namespace

std::vector<glm::vec4> tangents(const Primitive& primitive, int texcoordSet) {
    const std::vector<std::uint32_t>& indices = primitive.indices;
    std::vector<glm::vec4> result(indices.size(), glm::vec4(1, 0, 0, 1));
    // Tangents without normals are to be read over: flat triangles get new ones.
    if (!primitive.tangents.empty() && !primitive.normals.empty()) {
        for (std::size_t i = 0; i < indices.size(); ++i) result[i] = primitive.tangents[indices[i]];
        return result;
    }
    if (std::size_t(texcoordSet) >= primitive.texcoords.size()) return result;
    const std::vector<glm::vec2>& uvs = primitive.texcoords[std::size_t(texcoordSet)];

    std::unordered_map<Key, glm::dvec3, KeyHash> sums;
    std::vector<Key> keys(indices.size());
    std::vector<glm::dvec3> normals(indices.size());
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
        const std::uint32_t* index = indices.data() + t;
        std::array<glm::dvec3, 3> p, n;
        std::array<glm::dvec2, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = glm::dvec3(primitive.positions[index[k]]);
            uv[k] = glm::dvec2(uvs[index[k]]);
        }
        const glm::dvec3 face = unitOrZero(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k)
            n[k] = primitive.normals.empty() ? face : glm::dvec3(primitive.normals[index[k]]);
        const glm::dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
        const double area = a.x * b.y - a.y * b.x;
        const bool mirrored = area > 0;
        const glm::dvec3 along = (b.y * (p[1] - p[0]) - a.y * (p[2] - p[0])) * (area < 0 ? -1.0 : 1.0);
        for (std::size_t k = 0; k < 3; ++k) {
            keys[t + k] = keyOf(primitive.positions[index[k]], glm::vec3(n[k]), uvs[index[k]], mirrored);
            normals[t + k] = n[k];
            const glm::dvec3 left = across(p[(k + 1) % 3] - p[k], n[k]),
                             right = across(p[(k + 2) % 3] - p[k], n[k]);
            const double angle = std::acos(std::clamp(glm::dot(left, right), -1.0, 1.0));
            if (area != 0) sums[keys[t + k]] += across(along, n[k]) * angle;
        }
    }
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const auto found = sums.find(keys[i]);
        glm::dvec3 tangent = found == sums.end() ? glm::dvec3(0) : across(found->second, normals[i]);
        if (tangent == glm::dvec3(0)) {
            const glm::dvec3 n = normals[i];
            tangent = across(std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n);
        }
        result[i] = glm::vec4(glm::vec3(tangent), keys[i][8] == 1 ? -1.0f : 1.0f);
    }
    return result;
}

}  // namespace helio::pack
