// Where photons that could make caustics set out to.
#include "passes/scene/material_layout.hpp"
#include "passes/scene/packed_scene.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace helio::pack {
namespace {

/** Slots listed at most. */
constexpr std::size_t kMostTargets = 65536;

/** 0 for what has no end, and for tori: photons find those alone that they meet on their way. */
double targetArea(const glm::vec3* corners, std::uint32_t shape) {
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    if (shape == 0) return 0.5 * glm::length(glm::cross(b - a, c - a));
    switch (Shape::Kind(shape - 1)) {
        case Shape::Kind::Sphere:
            return 4.0 * glm::pi<double>() * glm::dot(b, b);
        case Shape::Kind::Disc:
            return glm::pi<double>() * glm::length(glm::cross(b, c));
        case Shape::Kind::Quad:
            return 4.0 * glm::length(glm::cross(b, c));
        case Shape::Kind::Plane:
        case Shape::Kind::Torus:
            break;
    }
    return 0.0;
}

}  // namespace

PhotonTargets photonTargets(const Scene& scene, std::span<const glm::vec3> positions,
                            std::span<const Surface> surfaces, std::span<const std::uint32_t> order,
                            const PackedScene& packed) {
    PhotonTargets targets;
    if (!packed.areaLights && packed.environmentMap.empty()) return targets;
    std::vector<bool> throws(scene.materials.size() + 1, false), receives = throws;
    for (std::size_t i = 0; i < throws.size(); ++i) {
        const Material material = i < scene.materials.size() ? scene.materials[i] : Material{};
        throws[i] = throwsCaustics(material);
        receives[i] = !throws[i] && hasWideLobes(material);
    }
    bool received = false;
    glm::dvec3 lower(1e300), upper(-1e300);
    std::vector<double> sums;
    double sum = 0;
    for (const std::uint32_t g : order) {
        const Surface& surface = surfaces[g];
        received |= receives[surface.material];
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 corner(positions[g * 3 + std::size_t(surface.shape > 0 ? 0 : k)]);
            const glm::dvec3 round(surface.shape > 0 ? glm::length(glm::dvec3(positions[g * 3 + 1])) +
                                                           glm::length(glm::dvec3(positions[g * 3 + 2]))
                                                     : 0.0);
            lower = glm::min(lower, corner - round);
            upper = glm::max(upper, corner + round);
        }
        if (throws[surface.material]) sum += targetArea(positions.data() + g * 3, surface.shape);
        sums.push_back(sum);
    }
    const double extent = 2.0 * glm::length(upper - lower);
    if (!received || !(sum > 0.0) || !std::isfinite(float(sum)) || !std::isfinite(float(extent)) ||
        !(float(sum) > 0.0f))
        return targets;
    targets.area = float(sum);
    targets.extent = float(extent);
    // Evenly over the area: every target stands for the same part of it.
    const std::size_t count = std::min(kMostTargets, 8 * order.size());
    std::size_t slot = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = (double(i) + 0.5) / double(count) * sum;
        while (slot + 1 < sums.size() && sums[slot] <= at) ++slot;
        targets.slots.push_back(std::uint32_t(slot));
    }
    return targets;
}

}  // namespace helio::pack
