#include "passes/scene/packed_scene.hpp"

#include <cmath>
#include <limits>

namespace helio::pack {
namespace {

/** The next float below or above: a box in floats that holds one in doubles. */
glm::vec3 roundedDown(const glm::dvec3& v) {
    glm::vec3 r(v);
    for (int c = 0; c < 3; ++c)
        if (double(r[c]) > v[c]) r[c] = std::nextafter(r[c], -std::numeric_limits<float>::infinity());
    return r;
}

}  // namespace

PlacedShape shapeOf(const glm::vec3* vectors, std::uint32_t shape) {
    return {Shape::Kind(shape - 1), glm::dvec3(vectors[0]), glm::dvec3(vectors[1]), glm::dvec3(vectors[2]),
            false};
}

std::vector<glm::vec3> treeCorners(std::span<const glm::vec3> positions, std::span<const Surface> surfaces) {
    std::vector<glm::vec3> corners(positions.begin(), positions.end());
    for (std::size_t g = 0; g < surfaces.size(); ++g) {
        if (surfaces[g].shape == 0) continue;
        const Scene::Bounds box = shapeBounds(shapeOf(&positions[g * 3], surfaces[g].shape));
        // The third corner would add nothing to the box of the other two.
        corners[g * 3] = corners[g * 3 + 2] = roundedDown(box.lower);
        corners[g * 3 + 1] = -roundedDown(-box.upper);
    }
    return corners;
}

std::vector<glm::vec3> surfaceTriangles(std::span<const glm::vec3> positions,
                                        std::span<const Surface> surfaces) {
    std::vector<glm::vec3> corners;
    glm::vec3 lower(std::numeric_limits<float>::infinity()), upper(-lower);
    for (const glm::vec3& p : treeCorners(positions, surfaces)) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const double extent = glm::length(glm::dvec3(upper) - glm::dvec3(lower));
    for (std::size_t g = 0; g < surfaces.size(); ++g) {
        const glm::vec3* const at = &positions[g * 3];
        if (surfaces[g].shape == 0) {
            corners.insert(corners.end(), at, at + 3);
            continue;
        }
        const auto on = trianglesOn(shapeOf(at, surfaces[g].shape), extent > 0 ? extent : 1.0);
        corners.insert(corners.end(), on.begin(), on.end());
    }
    corners.insert(corners.end(), positions.begin() + std::ptrdiff_t(surfaces.size() * 3), positions.end());
    return corners;
}

}  // namespace helio::pack
