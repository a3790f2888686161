#include "tests/bench/traversal/rays.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace helio::bench {
namespace {

struct Bounds {
    glm::vec3 lower{1e30f}, upper{-1e30f};
};

/** Where a ray arrived: the point moved off the surface, and the normal on the ray's side. */
struct Arrival {
    glm::vec3 point, normal;
};

Arrival arrivalOf(const Ray& ray, const RayHit& hit, std::span<const glm::vec3> corners) {
    const glm::vec3* c = &corners[std::size_t(hit.slot) * 3];
    const glm::dvec3 across = glm::cross(glm::dvec3(c[1] - c[0]), glm::dvec3(c[2] - c[0]));
    glm::vec3 normal(across / std::max(glm::length(across), 1e-300));
    if (glm::dot(normal, ray.direction) > 0) normal = -normal;
    const glm::vec3 point = ray.origin + hit.distance * ray.direction;
    const float size = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    return {point + normal * (4e-6f * (size + hit.distance)), normal};
}

class Scatterer {
public:
    glm::vec3 cosineAround(const glm::vec3& n) {
        const float r = std::sqrt(uniform()), phi = 2 * std::numbers::pi_v<float> * uniform();
        const glm::vec3 other = std::abs(n.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        const glm::vec3 u = glm::normalize(glm::cross(n, other)), v = glm::cross(n, u);
        return glm::normalize(r * std::cos(phi) * u + r * std::sin(phi) * v + std::sqrt(1 - r * r) * n);
    }
    float uniform() { return std::generate_canonical<float, 24>(random_); }

private:
    std::mt19937 random_{12345};
};

}  // namespace

std::vector<RaySet> raySets(const test::EmbreeScene& scene, std::span<const glm::vec3> corners,
                            std::uint32_t width, std::uint32_t height) {
    Bounds box;
    for (const glm::vec3& p : corners) {
        box.lower = glm::min(box.lower, p);
        box.upper = glm::max(box.upper, p);
    }
    const glm::vec3 middle = 0.5f * (box.lower + box.upper), half = 0.5f * (box.upper - box.lower);
    const float radius = glm::length(half);
    const glm::vec3 eye = middle + 1.2f * radius * glm::normalize(glm::vec3(0.5f, 0.45f, 0.9f));
    const glm::vec3 forward = glm::normalize(middle - eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, forward);
    Scatterer scatterer;

    std::vector<RaySet> sets = {{"primary", RayQuestion::Closest, {}},
                                {"bounce 1", RayQuestion::Closest, {}},
                                {"bounce 2", RayQuestion::Closest, {}},
                                {"shadow", RayQuestion::Any, {}}};
    // Tiles of 8 x 8 pixels, in them blocks of 4 x 2: the path tracer's order.
    for (std::uint32_t tile = 0; tile < (width / 8) * (height / 8); ++tile)
        for (std::uint32_t k = 0; k < 64; ++k) {
            const std::uint32_t x = tile % (width / 8) * 8 + (k & 3) + (k >> 3 & 1) * 4;
            const std::uint32_t y = tile / (width / 8) * 8 + (k >> 2 & 1) + (k >> 4) * 2;
            const float u =
                0.45f * ((2 * (float(x) + 0.5f)) / float(width) - 1) * float(width) / float(height);
            const float v = 0.45f * (1 - (2 * (float(y) + 0.5f)) / float(height));
            sets[0].rays.push_back(
                {.origin = eye, .direction = glm::normalize(forward + u * right + v * up)});
        }
    const glm::vec3 light = middle + glm::vec3(0.7f * radius, 1.6f * radius, 0.5f * radius);
    for (std::size_t bounce = 0; bounce < 2; ++bounce) {
        const std::vector<Ray>& arriving = sets[bounce].rays;
        std::vector<RayHit> hits(arriving.size());
        scene.run(arriving, RayQuestion::Closest, hits);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (hits[i].slot < 0) continue;
            const Arrival at = arrivalOf(arriving[i], hits[i], corners);
            sets[bounce + 1].rays.push_back(
                {.origin = at.point, .direction = scatterer.cosineAround(at.normal)});
            if (bounce > 0) continue;
            const glm::vec3 target =
                light + 0.1f * radius * glm::vec3(scatterer.uniform() - 0.5f, 0, scatterer.uniform() - 0.5f);
            sets[3].rays.push_back({.origin = at.point, .limit = 1.0f, .direction = target - at.point});
        }
    }
    return sets;
}

}  // namespace helio::bench
