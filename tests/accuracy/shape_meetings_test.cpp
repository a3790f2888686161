// Where rays meet spheres and tori, in the numbers that break textbook formulas: against more digits, against
// steps that pass nothing over, and against eigenvalues.
#include "tests/support/shader_harness.hpp"

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

namespace helio::test {
namespace {

glm::vec3 randomDirection(std::mt19937& random) {
    std::uniform_real_distribution<float> both(-1, 1);
    for (;;) {
        const glm::vec3 v(both(random), both(random), both(random));
        const float squared = glm::dot(v, v);
        if (squared > 1e-4f && squared < 1) return v / std::sqrt(squared);
    }
}

using Real = long double;
using Vector = glm::tvec3<Real>;

/** Both distances to a sphere, by the miss distance: nothing cancels in 64 bits of mantissa. */
bool exactRoots(const glm::vec3& o, const glm::vec3& d, const glm::vec4& s, Real& low, Real& high,
                Real& miss) {
    const Vector from = Vector(o) - Vector(s), along(d);
    const Real squared = glm::dot(along, along), middle = -glm::dot(from, along) / squared;
    const Vector nearest = from + middle * along;
    miss = std::sqrt(glm::dot(nearest, nearest));
    const Real discriminant = (Real(s.w) - miss) * (Real(s.w) + miss);
    if (discriminant < 0) return false;
    const Real half = std::sqrt(discriminant / squared), power = glm::dot(from, from) - Real(s.w) * Real(s.w);
    const Real larger = middle < 0 ? middle - half : middle + half, other = power / (squared * larger);
    low = middle < 0 ? larger : other;
    high = middle < 0 ? other : larger;
    return true;
}

TEST(ShapeMeetings, SpheresAreMetAtTheirExactDistance) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
    const auto direction = [&] { return randomDirection(random); };
    enum Kind { Far, Grazing, Inside, On, kinds };
    constexpr const char* names[] = {"1e4 to 1e6 away", "grazing", "from inside", "from on it"};
    constexpr std::size_t each = 200'000;
    std::vector<glm::vec3> origins, directions;
    std::vector<glm::vec4> spheres;
    for (int kind = 0; kind < kinds; ++kind)
        for (std::size_t i = 0; i < each; ++i) {
            const float radius = kind == Far ? 1.0f : std::exp2(12 * both(random));
            const glm::vec3 centre = kind == Far ? glm::vec3(0.0f) : 4.0f * radius * direction();
            const glm::vec3 way = direction(), side = glm::normalize(glm::cross(way, direction()));
            const float miss = kind == Grazing ? 1.0f - 0.01f * both(random) * both(random) : unit(random);
            const float distance = kind == Far ? std::pow(10.0f, 4 + 2 * unit(random)) : 100 * unit(random);
            glm::vec3 origin = centre + radius * (miss * side - distance * way);
            if (kind == Inside) origin = centre + 0.99f * radius * unit(random) * direction();
            if (kind == On) origin = centre + radius * direction();
            origins.push_back(origin);
            directions.push_back(way);
            spheres.emplace_back(centre, radius);
        }
    const auto got = runOnDevice<glm::vec2>("shaders/shared/sphere.glsl",
                                            "SphereMeeting m = meetSphere(a, b, c.xyz, c.w); "
                                            "return m.meets ? vec2(m.low, m.high) : vec2(-1e30);",
                                            origins, directions, spheres);
    for (int kind = 0; kind < kinds; ++kind) {
        Real worst = 0, worstSmall = 0;
        std::size_t judged = 0, wrong = 0, met = 0;
        for (std::size_t i = std::size_t(kind) * each; i < std::size_t(kind + 1) * each; ++i) {
            Real low = 0, high = 0, miss = 0;
            const bool meets = exactRoots(origins[i], directions[i], spheres[i], low, high, miss);
            const Real radius = spheres[i].w, depth = 1 - miss / radius;
            // Nearer the rim than this, float coordinates of the chord's middle do not say on which side it
            // lies.
            if (std::abs(depth) < 5e-7L) continue;
            ++judged;
            wrong += (got[i].x != -1e30f) != meets ? 1 : 0;
            if (!meets) continue;
            ++met;
            const Real chord = (high - low) / 2;
            for (const auto& [value, truth] :
                 {std::pair(Real(got[i].x), low), std::pair(Real(got[i].y), high)}) {
                // Where the chord itself is only known so well, no distance along it can be better.
                const Real bound =
                    1e-6L * std::abs(truth) + 2e-7L * radius * radius / chord * (kind == Far ? 0 : 1);
                worst = std::max(worst, std::abs(value - truth) / bound);
                if (kind == Far) worstSmall = std::max(worstSmall, std::abs(value - truth) / std::abs(truth));
            }
        }
        fmt::print("{}: {} judged, {} met, {} decided wrongly, worst {:.3g} of the bound{}\n", names[kind],
                   judged, met, wrong, double(worst),
                   kind == Far ? fmt::format(", {:.2g} of t", double(worstSmall)) : "");
        EXPECT_EQ(wrong, 0u) << names[kind];
        EXPECT_LT(worst, 1) << names[kind];
        EXPECT_GT(met, each / 3) << names[kind];
    }
}

/** Distance from a torus about Z whose ring has the radius 1. */
double torusDistance(const glm::dvec3& p, double tube) {
    return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - tube;
}

/** The first meeting beyond 0, by steps as long as the distance: none is passed over. `closest`: least
 * distance from the surface at which the ray turned away from it. Negative where there is none. */
double marched(const glm::dvec3& o, const glm::dvec3& d, double tube, double& closest) {
    const double side = torusDistance(o, tube) < 0 ? -1 : 1;
    double t = 0, before = 1e9;
    closest = 1e9;
    for (int i = 0; i < 20000 && t < 12; ++i) {
        const double distance = side * torusDistance(o + t * d, tube);
        if (distance < 1e-11) return t;
        if (before < distance) closest = std::min(closest, before);
        before = distance;
        t += std::max(distance, 1e-11);
    }
    return -1;
}

/** The same by the eigenvalues of the quartic's companion matrix, as numpy.roots does. */
double byEigenvalues(const glm::dvec3& o, const glm::dvec3& d, double tube) {
    const double od = glm::dot(o, d), q = glm::dot(o, o) + 1 - tube * tube;
    const glm::dvec2 o2(o), d2(d);
    const double c3 = 4 * od, c2 = 2 * q + 4 * od * od - 4 * glm::dot(d2, d2),
                 c1 = 4 * od * q - 8 * glm::dot(o2, d2), c0 = q * q - 4 * glm::dot(o2, o2);
    Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
    companion.row(0) << -c3, -c2, -c1, -c0;
    for (int i = 0; i < 3; ++i) companion(i + 1, i) = 1;
    double first = -1;
    for (const std::complex<double>& root : companion.eigenvalues())
        if (std::abs(root.imag()) < 1e-7 && root.real() > 0 && (first < 0 || root.real() < first))
            first = root.real();
    return first;
}

TEST(ShapeMeetings, NoRayMissesATorus) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
    const auto direction = [&] { return randomDirection(random); };
    constexpr std::size_t count = 1'000'000;
    std::vector<glm::vec3> origins, directions;
    std::vector<float> tubes;
    for (std::size_t i = 0; i < count; ++i) {
        const float tube = i % 3 == 0 ? 0.05f : (i % 3 == 1 ? 0.25f : 0.9f);
        // From outside, from the hole and from within; towards somewhere near the tube.
        origins.push_back((i % 5 == 0 ? 0.9f + tube : 4.0f) * unit(random) * direction());
        const glm::vec3 ring = glm::normalize(
            glm::vec3(both(random), both(random), 1e-3f) * glm::vec3(1, 1, 0) + glm::vec3(1e-6f, 0, 0));
        const glm::vec3 towards = ring + 1.3f * tube * direction() - origins.back();
        directions.push_back(glm::normalize(towards));
        tubes.push_back(tube);
    }
    const auto got =
        runOnDevice<float>("shaders/shared/torus.glsl",
                           "TorusMeeting m = meetTorus(a, b, vec3(0.0), vec3(0.0, 0.0, 1.0), 1.0, c, 0.0); "
                           "return m.meets ? m.distance : -1.0;",
                           origins, directions, tubes);
    std::vector<double> truths(count), turned(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        truths[i] = marched(glm::dvec3(origins[i]), glm::normalize(glm::dvec3(directions[i])),
                            double(tubes[i]), turned[i]);
    });
    std::size_t met = 0, grazing = 0, missed = 0, invented = 0, against = 0;
    double worst = 0, worstRoots = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(directions[i])), o(origins[i]);
        const double tube = tubes[i], truth = truths[i];
        const glm::dvec3 at = o + std::max(truth, 0.0) * d;
        const glm::dvec3 ring = glm::normalize(glm::dvec3(at.x, at.y, 0));
        const double cosine = truth < 0 ? 1 : std::abs(glm::dot(glm::normalize(at - ring), d));
        // Within 2e-6 of touching, coordinates in floats do not say whether it does.
        const bool touches = turned[i] < 2e-6 || cosine < 2e-3 * std::sqrt(1 / tube) ||
                             std::abs(torusDistance(o, tube)) < 2e-6;
        if (touches) {
            ++grazing;
            continue;
        }
        missed += truth >= 0 && got[i] < 0 ? 1 : 0;
        invented += truth < 0 && got[i] >= 0 ? 1 : 0;
        if (truth < 0 || got[i] < 0) continue;
        ++met;
        worst = std::max(worst, std::abs(double(got[i]) - truth) * std::min(1.0, cosine * 10));
        if (i % 40 == 0) {
            ++against;
            worstRoots = std::max(worstRoots, std::abs(byEigenvalues(o, d, tube) - double(got[i])) *
                                                  std::min(1.0, cosine * 10));
        }
    }
    fmt::print(
        "{} rays: {} met, {} missed, {} invented, {} too near to touching; worst error {:.2g}; of {} against "
        "eigenvalues {:.2g}\n",
        count, met, missed, invented, grazing, worst, against, worstRoots);
    EXPECT_EQ(missed, 0u);
    EXPECT_EQ(invented, 0u);
    EXPECT_LT(worst, 1e-5);
    EXPECT_LT(worstRoots, 1e-5);
    EXPECT_GT(met, count / 2);
    EXPECT_LT(grazing, count / 100);
}

}  // namespace
}  // namespace helio::test
