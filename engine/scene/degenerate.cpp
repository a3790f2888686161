#include "engine/scene/degenerate.hpp"

#include "engine/scene/notes.hpp"
#include "engine/scene/parallel.hpp"

#include <fmt/format.h>

#include <cmath>

namespace helio {
namespace {

/** What a unit cube may become: below, single precision loses even the sides. */
constexpr double smallestVolume = 1e-90;

/** What products of a triangle's edges must exceed for single precision to hold them. */
constexpr double smallestArea = 0x1p-126;

bool hasArea(const Primitive& primitive, std::size_t triangle) {
    const std::uint32_t* const corner = &primitive.indices[triangle * 3];
    const glm::dvec3 a = primitive.positions[corner[0]];
    const glm::dvec3 area = glm::cross(glm::dvec3(primitive.positions[corner[1]]) - a,
                                       glm::dvec3(primitive.positions[corner[2]]) - a);
    return glm::any(glm::greaterThan(glm::abs(area), glm::dvec3(smallestArea)));
}

std::size_t trianglesWithoutArea(const Primitive& primitive) {
    return countWhere(primitive.indices.size() / 3, [&](std::size_t t) { return !hasArea(primitive, t); });
}

}  // namespace

void warnOfDegenerates(Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) count += trianglesWithoutArea(primitive);
    }
    if (count > 0)
        warn(scene,
             fmt::format("{} triangle{} no area and cannot be seen", count, count == 1 ? " has" : "s have"));
    std::size_t flat = 0;
    int first = -1;
    for (const Instance& instance : scene.instances()) {
        if (std::abs(glm::determinant(glm::dmat3(instance.transform))) > smallestVolume) continue;
        if (flat++ == 0) first = instance.node;
    }
    if (flat > 0) {
        warn(scene,
             fmt::format("{} instance{} (the first is node {}) by a transform without inverse: flat, or "
                         "not to be seen",
                         flat, flat == 1 ? " is placed" : "s are placed", first));
    }
}

}  // namespace helio
