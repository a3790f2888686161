#include "engine/scene/normals.hpp"

#include <heliograph/error.hpp>
#include <heliograph/surfaces.hpp>

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace helio {
namespace {

/** A place, told apart by its bits; -0 is 0. */
struct Place {
    std::array<std::uint32_t, 3> bits;
    explicit Place(const glm::vec3& p) {
        for (int i = 0; i < 3; ++i) bits[std::size_t(i)] = std::bit_cast<std::uint32_t>(p[i] + 0.0f);
    }
    bool operator==(const Place&) const = default;
};
struct PlaceHash {
    std::size_t operator()(const Place& place) const {
        std::uint64_t h = 0x9e3779b97f4a7c15ull;
        for (std::uint32_t word : place.bits) h = (h ^ word) * 0xd6e8feb86659fd93ull, h ^= h >> 32;
        return std::size_t(h);
    }
};

struct Sum {
    glm::dvec3 weighted{0.0};
    double weight = 0;
    glm::dvec3 any{0.0};  ///< of one of the triangles
};

using Sums = std::unordered_map<Place, Sum, PlaceHash>;

/** Adds a triangle's unit normal to its corners. Everything in double: products of floats fit. */
void addTriangle(const std::array<glm::vec3, 3>& corners, NormalWeight weight, Sums& sums) {
    const std::array<glm::dvec3, 3> p{corners[0], corners[1], corners[2]};
    const glm::dvec3 area = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double size = glm::length(area);
    if (!(size > 0.0)) return;
    const glm::dvec3 unit = area / size;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 left = p[(k + 1) % 3] - p[k], right = p[(k + 2) % 3] - p[k];
        double share = 1;
        if (weight == NormalWeight::Area) share = size;
        // The arc tangent keeps its digits where arc cosine loses them.
        if (weight == NormalWeight::Angle) share = std::atan2(size, glm::dot(left, right));
        Sum& sum = sums[Place(corners[k])];
        sum.weighted += share * unit;
        sum.weight += share;
        sum.any = unit;
    }
}

glm::vec3 normalOf(const Sum& sum) {
    const double length = glm::length(sum.weighted);
    // What is left of normals that cancel is rounding.
    if (length > 1e-12 * sum.weight) return glm::vec3(sum.weighted / length);
    return sum.any == glm::dvec3(0.0) ? glm::vec3(0, 0, 1) : glm::vec3(sum.any);
}

}  // namespace

void smoothNormals(std::span<Primitive* const> primitives, NormalWeight weight, const std::string& file,
                   std::size_t mesh) {
    Sums sums;
    for (const Primitive* primitive : primitives)
        for (std::size_t t = 0; t + 2 < primitive->indices.size(); t += 3) {
            std::array<glm::vec3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t index = primitive->indices[t + k];
                if (index >= primitive->positions.size())
                    throw InputError(file, fmt::format("mesh {}", mesh),
                                     fmt::format("vertex {} does not exist", index),
                                     fmt::format("there are {}", primitive->positions.size()));
                corners[k] = primitive->positions[index];
            }
            addTriangle(corners, weight, sums);
        }
    for (Primitive* primitive : primitives) {
        primitive->normals.clear();
        primitive->normals.reserve(primitive->positions.size());
        for (const glm::vec3& position : primitive->positions) {
            const auto found = sums.find(Place(position));
            primitive->normals.push_back(normalOf(found == sums.end() ? Sum() : found->second));
        }
        for (MorphTarget& target : primitive->targets) target.normals.clear();
    }
}

void smoothNormals(Scene& scene, NormalWeight weight) {
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        std::vector<Primitive*> all;
        for (Primitive& primitive : scene.meshes[m].primitives) all.push_back(&primitive);
        smoothNormals(all, weight, scene.name, m);
    }
}

void flatNormals(Scene& scene) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.normals.clear();
            primitive.tangents.clear();
            for (MorphTarget& target : primitive.targets) {
                target.normals.clear();
                target.tangents.clear();
            }
        }
}

}  // namespace helio
