#include "passes/scene/light_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio::pack {
namespace {

bool hasPlace(const LightSource& light) {
    return light.shape != LightSource::Shape::Directional && light.shape != LightSource::Shape::Environment;
}

/** Of one light or the mean over several: how much of its strength goes towards a direction. */
double towards(const LightSource& light, const glm::dvec3& direction) {
    const double cosine = glm::dot(light.normal, direction);
    switch (light.shape) {
        case LightSource::Shape::Point:
            return 1.0;
        case LightSource::Shape::Spot: {
            const double cone = std::clamp(cosine * light.coneScale + light.coneOffset, 0.0, 1.0);
            return cone * cone;
        }
        default:
            break;
    }
    if (light.bothFaces) return std::abs(cosine);
    // A mean normal shorter than 1 stands for lights that face various ways.
    return std::max(cosine, 0.0) + 0.25 * std::max(0.0, 1.0 - glm::length(light.normal));
}

LightSource together(const LightSource& a, const LightSource& b) {
    LightSource sum;
    const double strength = a.strength + b.strength;
    const double share = strength > 0 ? a.strength / strength : 0.5;
    const auto normal = [](const LightSource& light) {
        const bool faces = light.shape == LightSource::Shape::Surface && !light.bothFaces;
        return faces ? light.normal : glm::dvec3(0.0);
    };
    sum.strength = strength;
    sum.power = a.power + b.power;
    sum.normal = glm::mix(normal(b), normal(a), share);
    sum.centre = glm::mix(b.centre, a.centre, share);
    sum.radius = std::max(glm::distance(sum.centre, a.centre) + a.radius,
                          glm::distance(sum.centre, b.centre) + b.radius);
    return sum;
}

}  // namespace

LightTree::LightTree(std::span<const LightSource> lights) : order_(lights.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    const auto placed = std::stable_partition(order_.begin(), order_.end(),
                                              [&](std::uint32_t i) { return !hasPlace(lights[i]); });
    const auto without = std::uint32_t(placed - order_.begin());
    nodes_.reserve(2 * lights.size());
    for (std::uint32_t i = 0; i < without; ++i) roots_.push_back(leaf(lights, i));
    if (without < lights.size()) roots_.push_back(build(lights, without, std::uint32_t(lights.size())));
}

std::int32_t LightTree::leaf(std::span<const LightSource> lights, std::uint32_t place) {
    nodes_.push_back({place, place + 1, -1, -1, lights[order_[place]]});
    return std::int32_t(nodes_.size()) - 1;
}

std::int32_t LightTree::build(std::span<const LightSource> lights, std::uint32_t first, std::uint32_t end) {
    if (end - first == 1) return leaf(lights, first);
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
    for (std::uint32_t i = first; i < end; ++i) {
        lower = glm::min(lower, lights[order_[i]].centre);
        upper = glm::max(upper, lights[order_[i]].centre);
    }
    const glm::dvec3 extent = upper - lower;
    const glm::length_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                               : extent.y >= extent.z                       ? 1
                                                                            : 2;
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = lights[a].centre[axis], y = lights[b].centre[axis];
                         return x != y ? x < y : a < b;
                     });
    const auto place = std::int32_t(nodes_.size());
    nodes_.emplace_back();
    const std::int32_t left = build(lights, first, middle), right = build(lights, middle, end);
    nodes_[std::size_t(place)] = {
        first, end, left, right, together(nodes_[std::size_t(left)].bound, nodes_[std::size_t(right)].bound)};
    return place;
}

double estimatedIrradiance(const LightSource& light, const SurfaceSample& at,
                           const AxisIrradiance& environment) {
    constexpr double floor = 0.02;
    if (light.shape == LightSource::Shape::Environment) {
        double sum = 0;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const double n = at.normal[axis];
            sum += n * n * environment[std::size_t(axis) * 2 + (n < 0 ? 1 : 0)];
        }
        return sum + floor * light.strength;
    }
    if (light.shape == LightSource::Shape::Directional)
        return light.strength * (std::max(0.0, -glm::dot(at.normal, light.normal)) + floor);
    const glm::dvec3 way = light.centre - at.position;
    const double squared = glm::dot(way, way), distance = std::sqrt(squared);
    const glm::dvec3 direction = distance > 0 ? way / distance : at.normal;
    // Nearer than its own size a light no longer grows with nearness; and part of it may be over the horizon
    // where its centre is not.
    const double reach = squared + light.radius * light.radius;
    const double spread = light.radius / std::max(std::sqrt(reach), 1e-300);
    const double cosine = std::max(0.0, glm::dot(at.normal, direction) + 0.5 * spread) / (1.0 + 0.5 * spread);
    const double emitted = std::min(1.0, towards(light, -direction) + 0.5 * spread);
    return light.strength / std::max(reach, 1e-300) * (emitted * cosine + floor);
}

}  // namespace helio::pack
