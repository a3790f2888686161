/** @file
 * What every scattering model must be, on the device and to the extremes of its parameters: finite, not
 * negative, reciprocal, no more light out than in, and sampled as its density says.
 */
#include "tests/accuracy/scattering_lobes.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace helio::test {
namespace {

class EveryLobe : public testing::TestWithParam<std::string> {};

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/** Directions over the hemisphere; some nearly grazing, some nearly along the normal. */
glm::vec3 randomDirection(std::mt19937& random, bool below) {
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const float choice = uniform(random), u = uniform(random);
    const float cosine = choice < 0.15f  ? std::pow(10.0f, -7.0f * u)
                         : choice < 0.3f ? 1.0f - std::pow(10.0f, -1.0f - 6.0f * u)
                                         : std::max(u, 1e-7f);
    const glm::vec3 w = directionAt(cosine, 6.2831853f * uniform(random));
    return below && uniform(random) < 0.5f ? glm::vec3(w.x, w.y, -w.z) : w;
}

/** f is compared without its cosine, relative to its size. Near a lobe's peak, where a rounding of the
 * directions moves the half vector by 1e-7 of a width of alpha, values may differ by that much. */
TEST_P(EveryLobe, IsFinitePositiveAndReciprocal) {
    const Lobe& model = lobe(GetParam());
    std::mt19937 random(7);
    constexpr std::size_t perCase = 17000;
    std::vector<glm::mat4> p;
    std::vector<glm::vec3> wo, wi;
    for (const LobeCase& c : model.cases) {
        for (std::size_t i = 0; i < perCase; ++i) {
            p.push_back(c.p);
            wo.push_back(randomDirection(random, false));
            wi.push_back(randomDirection(random, model.below));
        }
    }
    const auto there = runOnDevice<glm::vec4>(
        model.lines(), "ScatterValue v = VALUE(a, b, c); return vec4(v.value, v.density);", p, wo, wi);
    for (std::size_t i = 0; i < there.size(); ++i) {
        const glm::vec4& v = there[i];
        ASSERT_TRUE(finite(v) && std::isfinite(v.w) && v.x >= 0 && v.y >= 0 && v.z >= 0 && v.w >= 0)
            << model.cases[i / perCase].name << " value " << v.x << " " << v.y << " " << v.z << " density "
            << v.w << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
        // What sampling never finds would be missing in a picture: the density covers the value.
        ASSERT_TRUE(v.w > 0 || std::max({v.x, v.y, v.z}) < 1e-20f)
            << model.cases[i / perCase].name << " value " << v.x << " " << v.y << " " << v.z
            << " without density; wo.z " << wo[i].z << " wi.z " << wi[i].z;
    }
    if (!model.reciprocal) return;
    // A ray the other way sees the interface from the other side: both directions are turned over and the
    // ratio of the indices inverted; radiance then scales by the squares of the indices.
    const std::string back =
        "bool through = c.z < 0.0; mat4 q = a; float eta = " + std::string(model.below ? model.eta : "1.0") +
        "; vec3 x = through ? -c : c, y = through ? -b : b; " +
        (model.below
             ? (model.name.starts_with("dielectric") ? "if (through && q[1].w > 0.0) q[1].w = 1.0 / q[1].w; "
                                                     : "if (through && q[3].x < 0.5) q[1].z = 1.0 / q[1].z; ")
             : "") +
        "ScatterValue v = VALUE(q, x, y); float squared = through ? eta * eta : 1.0;"
        // p[0].xyz through twice is symmetric; indices: f(wo, wi) / eta_o^2... = f(wi, wo) / eta_i^2...
        "return vec4(v.value / squared, v.density);";
    std::string body = back;
    if (model.below) {
        // The macro takes its case by name.
        std::string eta = model.eta;
        for (std::size_t at; (at = eta.find("p[")) != std::string::npos;) eta.replace(at, 2, "a[");
        body.replace(body.find(model.eta), model.eta.size(), eta);
    }
    const auto reversed = runOnDevice<glm::vec4>(model.lines(), body, p, wo, wi);
    std::size_t violations = 0, compared = 0;
    double worst = 0;
    std::size_t worstAt = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
        const double alpha = std::max(
            1e-4, double(std::min(p[i][1].x > 0 ? p[i][1].x : 1.0f, p[i][1].y > 0 ? p[i][1].y : 1.0f)));
        // Rounded directions: 1e-7 of the half vector's slope, of the length it is made from, and of the
        // cosines to it.
        const glm::dvec3 o(wo[i]), in(wi[i]);
        const double ratio = in.z > 0                               ? 1.0
                             : model.name.starts_with("dielectric") ? double(p[i][1].w)
                             : p[i][3].x > 0.5f                     ? 1.0
                                                                    : double(p[i][1].z);
        const glm::dvec3 sum = in.z < 0 && ratio == 1.0 ? o + glm::dvec3(in.x, in.y, -in.z) : o + ratio * in;
        const double length = glm::length(sum);
        const double facing =
            std::min(std::abs(glm::dot(o, sum)), std::abs(glm::dot(in, sum))) / std::max(length, 1e-12);
        if (std::min({std::abs(in.z), o.z, facing}) < 1e-3 || length < 1e-2) continue;
        // Reflectance rises with infinite slope towards the critical angle.
        const double inside = model.name.starts_with("dielectric") ? double(p[i][1].w) : double(p[i][1].z);
        if (model.below && in.z > 0 && inside < 1 && std::abs(facing * facing + inside * inside - 1) < 5e-3)
            continue;
        const double tolerance = 1e-5 + 2e-6 / alpha + 2e-6 / facing;
        ++compared;
        for (int c = 0; c < 3; ++c) {
            const double f = double(there[i][c]) / std::abs(double(wi[i].z));
            const double g = double(reversed[i][c]) / std::abs(double(wo[i].z));
            const double difference = std::abs(f - g) / std::max({std::abs(f), std::abs(g), 1e-3});
            if (difference > tolerance) ++violations;
            if (difference / tolerance > worst) {
                worst = difference / tolerance;
                worstAt = i;
            }
        }
    }
    EXPECT_GT(compared, there.size() / 2);
    EXPECT_EQ(violations, 0u) << "worst " << worst << " tolerances in " << model.cases[worstAt / perCase].name
                              << " wo.z " << wo[worstAt].z << " wi.z " << wi[worstAt].z << " there "
                              << there[worstAt].x << " back " << reversed[worstAt].x;
}

/** Means of the weights over a grid of 96^2 stratified numbers: the albedo, with light that goes through
 * scaled back to power. */
TEST_P(EveryLobe, ReflectsNoMoreThanItGets) {
    const Lobe& model = lobe(GetParam());
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    constexpr int side = 96;
    std::vector<glm::mat4> p;
    std::vector<glm::vec3> wo, u;
    for (const LobeCase& c : model.cases)
        for (float cosine : kCosines)
            for (int i = 0; i < side; ++i)
                for (int k = 0; k < side; ++k) {
                    p.push_back(c.p);
                    wo.push_back(directionAt(cosine, 0.7f));
                    u.emplace_back((float(i) + uniform(random)) / side, (float(k) + uniform(random)) / side,
                                   uniform(random));
                }
    std::string eta = model.eta;
    for (std::size_t at; (at = eta.find("p[")) != std::string::npos;) eta.replace(at, 2, "a[");
    const auto samples =
        runOnDevice<glm::mat3>(model.lines(),
                               "ScatterSample s = SAMPLE(a, b, c); float eta = " + eta +
                                   "; float power = s.direction.z < 0.0 ? eta * eta : 1.0;"
                                   "return mat3(s.direction, s.weight * power, vec3(s.density));",
                               p, wo, u);
    const std::size_t each = std::size_t(side) * side;
    for (std::size_t c = 0; c < model.cases.size(); ++c)
        for (std::size_t k = 0; k < kCosines.size(); ++k) {
            verify::RunningStatistics albedo;
            for (std::size_t i = 0; i < each; ++i) {
                const glm::mat3& s = samples[(c * kCosines.size() + k) * each + i];
                ASSERT_TRUE(finite(s[0]) && finite(s[1]) && std::isfinite(s[2].x))
                    << model.cases[c].name << " cosine " << kCosines[k];
                ASSERT_NEAR(glm::length(s[0]), 1.0f, 2e-5f)
                    << model.cases[c].name << " cosine " << kCosines[k];
                ASSERT_TRUE(s[1].x >= 0 && s[1].y >= 0 && s[1].z >= 0) << model.cases[c].name;
                albedo.add(double(std::max({s[1].x, s[1].y, s[1].z})));
            }
            // Rounding of a narrow lobe's density cancels in the weight but for the masking.
            if (model.conserves) {
                EXPECT_LE(albedo.mean(), 1.0 + 1e-5 + 5 * albedo.standardError())
                    << model.cases[c].name << " cosine " << kCosines[k];
            } else {
                EXPECT_LE(albedo.mean(), 3.1) << model.cases[c].name << " cosine " << kCosines[k];
            }
        }
}

/** Chi-squared of sampled directions against the density. Cells are rings around the mirrored (or refracted)
 * direction, their radii growing by a constant factor, so that lobes of any width are resolved. */
TEST_P(EveryLobe, SamplesFollowTheirDensity) {
    const Lobe& model = lobe(GetParam());
    constexpr int rings = 36, sectors = 12, sub = 16;
    constexpr std::size_t count = 30000;
    constexpr double least = 3e-5, most = std::numbers::pi;
    const auto radius = [&](int ring) {
        return ring == 0 ? 0.0 : least * std::pow(most / least, double(ring) / rings);
    };
    const std::vector<float> cosines = {0.95f, 0.4f, 0.1f};
    std::vector<glm::mat4> cellP, sampleP;
    std::vector<glm::vec4> cellWo, cellRange;
    std::vector<glm::vec3> sampleWo, u;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::string eta = model.eta;
    for (std::size_t at; (at = eta.find("p[")) != std::string::npos;) eta.replace(at, 2, "a[");
    const int charts = model.below ? 2 : 1;
    for (const LobeCase& c : model.cases)
        for (float cosine : cosines) {
            const glm::vec3 wo = directionAt(cosine, 1.1f);
            for (int chart = 0; chart < charts; ++chart)
                for (int r = 0; r < rings; ++r)
                    for (int s = 0; s < sectors; ++s) {
                        cellP.push_back(c.p);
                        cellWo.emplace_back(wo, float(chart));
                        cellRange.emplace_back(radius(r), radius(r + 1), 2 * std::numbers::pi * s / sectors,
                                               2 * std::numbers::pi * (s + 1) / sectors);
                    }
            for (std::size_t i = 0; i < count; ++i) {
                sampleP.push_back(c.p);
                sampleWo.push_back(wo);
                u.emplace_back(uniform(random), uniform(random), uniform(random));
            }
        }
    // The chart's axis: the mirrored direction, or the refracted one (grazing where there is none).
    const std::string axis = "float eta = " + eta +
                             "; vec3 axis = vec3(-b.xy, b.z); if (b.w > 0.5) { vec2 t = -b.xy / eta; float "
                             "tt = min(dot(t, t), 0.9999); "
                             "axis = vec3(normalize(t + 1e-9) * sqrt(tt), -sqrt(1.0 - tt)); }";
    const std::string integrate =
        axis +
        "vec3 x, y; orthonormalBasis(axis, x, y); float sum = 0.0; bool whole = true;"
        "float side = b.w > 0.5 ? -1.0 : 1.0;"
        "float margin = ((c.y - c.x) + sin(c.y) * (c.w - c.z)) / " +
        std::to_string(sub) +
        ".0;"
        "for (int i = 0; i < " +
        std::to_string(sub * sub) +
        "; ++i) {"
        "float r = mix(c.x, c.y, (float(i / " +
        std::to_string(sub) + ") + 0.5) / " + std::to_string(sub) + ".0), f = mix(c.z, c.w, (float(i % " +
        std::to_string(sub) + ") + 0.5) / " + std::to_string(sub) +
        ".0);"
        "float s, t, sf, tf; realSinCos(r, s, t); realSinCos(f, sf, tf);"
        "vec3 wi = x * (s * tf) + y * (s * sf) + axis * t;"
        "whole = whole && wi.z * side > margin;"
        "if (whole) sum += s * VALUE(a, b.xyz, wi).density; }"
        "return !whole ? -1.0 : sum * (c.y - c.x) * (c.w - c.z) / " +
        std::to_string(sub * sub) + ".0;";
    const auto mass = runOnDevice<float>(model.lines(), integrate, cellP, cellWo, cellRange);
    const auto samples = runOnDevice<glm::vec4>(
        model.lines(), "ScatterSample s = SAMPLE(a, b, c); return vec4(s.direction, s.density);", sampleP,
        sampleWo, u);
    const auto axes = runOnDevice<glm::vec3>(model.lines(), axis + " return axis;", cellP, cellWo);
    const std::size_t cells = std::size_t(charts) * rings * sectors;
    const std::size_t runs = model.cases.size() * cosines.size();
    const double level = verify::sidakLevel(0.01, runs * lobes().size());
    std::size_t tested = 0;
    for (std::size_t run = 0; run < runs; ++run) {
        std::vector<double> expected(cells + 1), observed(cells + 1);
        double total = 0, mirrors = 0;
        // What the horizon cuts is one cell with what is rejected.
        for (std::size_t i = 0; i < cells; ++i)
            if (mass[run * cells + i] > 0) total += expected[i] = double(mass[run * cells + i]) * count;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec4& s = samples[run * count + i];
            if (s.w < 0) mirrors += 1;
            // Density 0: below the surface, rejected.
            std::size_t cell = cells;
            if (s.w > 0) {
                const std::size_t chart = charts == 2 && s.z < 0 ? 1 : 0;
                const glm::dvec3 z(axes[run * cells + chart * rings * sectors]);
                // The basis of orthonormalBasis, in double.
                const double sign = z.z < 0 ? -1 : 1, a = -1 / (sign + z.z), b = z.x * z.y * a;
                const glm::dvec3 x(1 + sign * z.x * z.x * a, sign * b, -sign * z.x),
                    y(b, sign + z.y * z.y * a, -z.y), w(s.x, s.y, s.z);
                const double across = std::hypot(glm::dot(w, x), glm::dot(w, y));
                const double r = std::atan2(across, glm::dot(w, z));
                double phi = std::atan2(glm::dot(w, y), glm::dot(w, x));
                if (phi < 0) phi += 2 * std::numbers::pi;
                int ring = 0;
                while (ring + 1 < rings && r >= radius(ring + 1)) ++ring;
                const int sector = std::min(sectors - 1, int(phi / (2 * std::numbers::pi) * sectors));
                cell = (chart * rings + std::size_t(ring)) * sectors + std::size_t(sector);
                if (mass[run * cells + cell] < 0) cell = cells;
            }
            observed[cell] += 1;
        }
        const std::string where = model.cases[run / cosines.size()].name + " cosine " +
                                  std::to_string(cosines[run % cosines.size()]);
        if (mirrors == count || total == 0) continue;
        EXPECT_LE(total, count * 1.002) << where << ": the density's integral is above 1";
        expected[cells] = std::max(0.0, double(count) - total);
        // What integration leaves uncertain at the horizon is far below a cell's own noise.
        const auto result = verify::chiSquaredTest(observed, expected, 25);
        EXPECT_GT(result.pValue, level)
            << where << ": chi^2 " << result.statistic << " of " << result.degrees << " degrees; rejected "
            << observed[cells] << " expected " << expected[cells];
        ++tested;
    }
    EXPECT_GT(tested, 0u);
}

std::vector<std::string> lobeNames() {
    std::vector<std::string> names;
    for (const Lobe& model : lobes()) names.push_back(model.name);
    return names;
}
INSTANTIATE_TEST_SUITE_P(Lobes, EveryLobe, testing::ValuesIn(lobeNames()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace helio::test
