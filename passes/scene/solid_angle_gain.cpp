#include "passes/scene/solid_angle_gain.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace helio::pack {
namespace {

constexpr std::size_t kMostReceivers = 256, kMostLights = 32, kMostTriangles = 1 << 16;
constexpr int kSteps = 4;  ///< points of a light along each edge
/** That of shaders/scene/solid_angle_light.glsl. */
constexpr double kLeastSolidAngle = 0.05;

struct Receiver {
    glm::dvec3 position, normal;
};

/** Points spread evenly over the surfaces' area; of very many triangles, over some of them. */
std::vector<Receiver> receiversOn(std::span<const glm::vec3> positions,
                                  const std::function<bool(std::size_t)>& receives) {
    std::vector<double> sums;
    double area = 0;
    const auto normal = [&](std::size_t i) {
        const glm::dvec3 a(positions[3 * i]);
        return glm::cross(glm::dvec3(positions[3 * i + 1]) - a, glm::dvec3(positions[3 * i + 2]) - a);
    };
    const std::size_t step = (positions.size() / 3 + kMostTriangles - 1) / kMostTriangles;
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < positions.size() / 3; i += step) {
        if (!receives(i)) continue;
        taken.push_back(i);
        sums.push_back(area += glm::length(normal(i)));
    }
    std::vector<Receiver> result;
    if (!(area > 0.0) || !std::isfinite(area)) return result;
    for (std::size_t k = 0; k < kMostReceivers; ++k) {
        const double at = area * (double(k) + 0.5) / double(kMostReceivers);
        const auto found = std::ranges::upper_bound(sums, at);
        const std::size_t place = std::min(std::size_t(found - sums.begin()), taken.size() - 1);
        const std::size_t i = taken[place];
        const double before = place == 0 ? 0.0 : sums[place - 1];
        // Within the triangle by where in its share the point falls, folded to both axes.
        const double u = (at - before) / std::max(sums[place] - before, 1e-300);
        const double v = std::fmod(double(k) * 0.618033988749895, 1.0);
        const double root = std::sqrt(std::clamp(u, 0.0, 1.0));
        const glm::dvec3 a(positions[3 * i]), b(positions[3 * i + 1]), c(positions[3 * i + 2]);
        result.push_back(
            {a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v), glm::normalize(normal(i))});
    }
    return result;
}

/** Of one light at one place: the irradiance, and the second moments of its estimates by one sample. */
struct Moments {
    double irradiance = 0, byArea = 0, bySolidAngle = 0;
};

Moments momentsOf(const FlatLight& light, const Receiver& receiver) {
    const glm::dvec3 across = glm::cross(light.edge1, light.edge2);
    const double length = glm::length(across);
    const glm::dvec3 normal = across / length;
    const double area = light.isTriangle ? 0.5 * length : length;
    double solidAngle = 0, received = 0, squares = 0, squaresBySolidAngle = 0;
    int points = 0;
    // A light that cannot be large from here: its middle tells what it brings.
    const double reach = glm::length(light.edge1) + glm::length(light.edge2);
    const double gap = glm::length(light.corner - receiver.position) - reach;
    const int steps = gap > 0.0 && area < kLeastSolidAngle * gap * gap ? 1 : kSteps;
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < steps; ++k) {
            const double x = (i + 0.5) / steps, y = (k + 0.5) / steps;
            if (light.isTriangle && x + y > 1.0) continue;
            const glm::dvec3 to = light.corner + light.edge1 * x + light.edge2 * y - receiver.position;
            const double squared = glm::dot(to, to), distance = std::sqrt(squared);
            ++points;
            const double leaving = -glm::dot(normal, to) / distance;
            const double shown = light.bothFaces ? std::abs(leaving) : std::max(leaving, 0.0);
            if (!(shown > 0.0) || !(squared > 0.0)) continue;
            const double arriving = std::abs(glm::dot(receiver.normal, to)) / distance;
            const double angle = shown / squared;
            solidAngle += angle;
            received += arriving * angle;
            squares += arriving * angle * arriving * angle;
            squaresBySolidAngle += arriving * arriving * angle;
        }
    }
    const double each = area / points;
    Moments m;
    m.irradiance = light.radiance * received * each;
    const double l2 = light.radiance * light.radiance;
    m.byArea = l2 * squares * each * area;
    m.bySolidAngle =
        solidAngle * each < kLeastSolidAngle ? m.byArea : l2 * squaresBySolidAngle * each * solidAngle * each;
    return m;
}

}  // namespace

SolidAngleGain solidAngleGain(std::span<const FlatLight> lights, std::span<const glm::vec3> positions,
                              const std::function<bool(std::size_t)>& receives) {
    SolidAngleGain gain;
    if (lights.empty()) return gain;
    const std::vector<Receiver> places = receiversOn(positions, receives);
    // Where there are many, some stand for all.
    const std::size_t step = (lights.size() + kMostLights - 1) / kMostLights;
    for (const Receiver& place : places) {
        double total = 0;
        SolidAngleGain here;
        for (std::size_t i = 0; i < lights.size(); i += step) {
            const Moments m = momentsOf(lights[i], place);
            if (!(m.irradiance > 0.0) || !std::isfinite(m.byArea)) continue;
            total += m.irradiance;
            (lights[i].isTriangle ? here.triangles : here.rectangles) +=
                (m.byArea - m.bySolidAngle) / m.irradiance;
        }
        if (!(total > 0.0)) continue;
        gain.rectangles += here.rectangles / total / double(places.size());
        gain.triangles += here.triangles / total / double(places.size());
    }
    return gain;
}

}  // namespace helio::pack
