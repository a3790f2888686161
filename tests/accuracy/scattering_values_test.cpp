/** @file Scattering models on the device against closed forms and published tables. */
#include "engine/core/shared.hpp"
#include "tests/accuracy/scattering_lobes.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;
const Preamble kFresnel = "shaders/scattering/fresnel.glsl";

/** Gauss-Legendre nodes and weights on (0, 1). */
void gaussLegendre(int n, std::vector<double>& x, std::vector<double>& w) {
    x.resize(std::size_t(n));
    w.resize(std::size_t(n));
    for (int i = 0; i < n; ++i) {
        double z = std::cos(kPi * (i + 0.75L) / (n + 0.5L)), derivative = 1;
        for (int step = 0; step < 20; ++step) {
            double p = 1, before = 0;
            for (int j = 0; j < n; ++j) {
                const double last = before;
                before = p;
                p = ((2 * j + 1) * z * before - j * last) / (j + 1);
            }
            derivative = n * (z * p - before) / (z * z - 1);
            z -= p / derivative;
        }
        x[std::size_t(i)] = (1 - z) / 2;
        w[std::size_t(i)] = 1 / ((1 - z * z) * derivative * derivative);
    }
}

float cosineOf(double degrees) {
    return float(std::cos(degrees * kPi / 180));
}

TEST(Fresnel, DielectricIsTheClosedFormOverAllAnglesAndIndices) {
    std::vector<float> cosines, etas;
    for (float eta :
         {1.0f, 1.0000001f, 1.001f, 1.3f, 1.5f, 3.0f, 100.0f, 0.9999999f, 0.75f, 0.6666667f, 1 / 3.0f})
        for (float c : floatsSpaced(0.0f, 1.0f, 4001)) {
            cosines.push_back(c);
            etas.push_back(eta);
        }
    const auto r = runOnDevice<float>(kFresnel, "fresnelDielectric(a, b)", cosines, etas);
    double worst = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
        const double exact =
            etas[i] == 1.0f ? 0.0 : verify::fresnelDielectric(double(cosines[i]), double(etas[i])).average();
        // Within an angle's own rounding of the critical one the reflectance rises with infinite slope.
        // Towards the critical angle the reflectance rises with infinite slope: a rounding of g^2 counts.
        const double g = std::sqrt(
            std::abs(double(cosines[i]) * double(cosines[i]) + double(etas[i]) * double(etas[i]) - 1.0L));
        const double rounding =
            etas[i] < 1.0f ? 1.8e-7L / (double(etas[i]) * std::max(g, double(1e-4L))) : 0.0;
        worst = std::max(worst, std::abs(double(r[i]) - exact));
        ASSERT_NEAR(double(r[i]), exact, 2e-6L + rounding) << "cosine " << cosines[i] << " eta " << etas[i];
    }
    RecordProperty("worst", std::to_string(worst));
}

TEST(Fresnel, PublishedValuesOfGlass) {
    // Angle, (Rs + Rp)/2 at n = 1.5; Brewster's angle with Rp = 0, where the average is half of Rs.
    const std::vector<std::pair<double, double>> table = {
        {0, 0.04L},          {30, 0.0415226260L}, {45, 0.0502399110L},
        {60, 0.0891867128L}, {85, 0.6127996453L}, {56.309932474L, 0.147928994083L / 2}};
    std::vector<float> cosines;
    for (const auto& [angle, r] : table) cosines.push_back(cosineOf(angle));
    const auto r = runOnDevice<float>(kFresnel, "fresnelDielectric(a, 1.5)", cosines);
    for (std::size_t i = 0; i < table.size(); ++i)
        EXPECT_NEAR(double(r[i]), table[i].second, 2e-6L) << table[i].first;
    // The critical angle: all is reflected beyond, not before.
    const auto total = runOnDevice<float>(kFresnel, "fresnelDielectric(a, 1.0 / 1.5)",
                                          std::vector{cosineOf(41.81L), cosineOf(41.82L), 0.0f});
    EXPECT_LT(total[0], 1.0f);
    EXPECT_EQ(total[1], 1.0f);
    EXPECT_EQ(total[2], 1.0f);
}

TEST(Fresnel, IsTheSameFromBothSides) {
    // The refracted cosine is rounded; near grazing light outside it decides the angle.
    std::vector<float> c = floatsSpaced(0.05f, 1.0f, 2000);
    const auto difference = runOnDevice<float>(
        kFresnel,
        "float t; float r = fresnelDielectric(a, 1.5, t); return r - fresnelDielectric(t, 1.0 / 1.5);", c);
    for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_NEAR(difference[i], 0.0f, 2e-6f * std::max(1.0f, 0.3f / c[i])) << c[i];
}

TEST(Fresnel, ConductorIsTheClosedForm) {
    const auto r = runOnDevice<float>(kFresnel, "fresnelConductor(a, 0.2, 3.9)", std::vector{1.0f, 0.5f});
    EXPECT_NEAR(double(r[0]), 0.951951952L, 2e-6L);
    EXPECT_NEAR(double(r[1]), (0.9762484424L + 0.9155163212L) / 2, 2e-6L);
    for (const auto& [n, k] : std::vector<std::pair<float, float>>{{0.05f, 2.0f},
                                                                   {0.2f, 3.9f},
                                                                   {1.1f, 2.6f},
                                                                   {3.0f, 0.0f},
                                                                   {1.5f, 1e-4f},
                                                                   {0.9f, 0.0f},
                                                                   {5.0f, 20.0f}}) {
        const std::vector<float> c = floatsSpaced(0.0f, 1.0f, 1001);
        const auto got = runOnDevice<float>(kFresnel, "fresnelConductor(a, b, c)", c,
                                            std::vector<float>(c.size(), n), std::vector<float>(c.size(), k));
        for (std::size_t i = 0; i < c.size(); ++i) {
            const double exact = verify::fresnelConductor(double(c[i]), double(n), double(k)).average();
            const double t =
                double(n) * double(n) - double(k) * double(k) - 1.0L + double(c[i]) * double(c[i]);
            const double rounding = k == 0 ? 1.2e-7L / std::max(std::sqrt(std::abs(t)), double(1e-4L)) : 0.0;
            ASSERT_NEAR(double(got[i]), exact, 2e-6L + rounding) << n << " " << k << " cosine " << c[i];
        }
    }
}

TEST(Fresnel, SchlicksLargestErrors) {
    struct Case {
        float eta;
        double error, angle;
    };
    for (const Case& c : {Case{1.33f, 0.059923738L, 83.79L}, Case{1.5f, 0.035692637L, 84.97L},
                          Case{2.0f, 0.044405336L, 85.17L}}) {
        std::vector<float> cosines;
        for (int i = 0; i <= 9000; ++i) cosines.push_back(cosineOf(0.01L * i));
        const auto error =
            runOnDevice<float>(kFresnel, "fresnelSchlickDielectric(a, b) - fresnelDielectric(a, b)", cosines,
                               std::vector<float>(cosines.size(), c.eta));
        std::size_t worst = 0;
        for (std::size_t i = 0; i < error.size(); ++i)
            if (std::abs(error[i]) > std::abs(error[worst])) worst = i;
        EXPECT_NEAR(std::abs(double(error[worst])), c.error, 1e-5L) << c.eta;
        EXPECT_NEAR(0.01L * double(worst), c.angle, 0.03L) << c.eta;
        // From the dense side it is the same function of the angle outside, and 1 beyond the critical angle.
        const auto inside = runOnDevice<float>(
            kFresnel,
            "float t; fresnelDielectric(a, b, t); return fresnelSchlickDielectric(t, 1.0 / b) - "
            "fresnelSchlickDielectric(a, b);",
            std::vector{1.0f, 0.7f, 0.3f}, std::vector<float>(3, c.eta));
        for (float d : inside) EXPECT_NEAR(d, 0.0f, 1e-5f);
    }
}

TEST(Fresnel, CosineWeightedAverages) {
    // Outside to inside, inside to outside.
    const std::vector<std::array<double, 3>> table = {{1.3L, 0.061131825L, 0.444456701L},
                                                      {1.33L, 0.065930849L, 0.471949149L},
                                                      {1.5L, 0.091777959L, 0.596345760L},
                                                      {2.0L, 0.160596637L, 0.790149159L},
                                                      {2.4L, 0.210181302L, 0.862878698L}};
    std::vector<double> x, w;
    gaussLegendre(256, x, w);
    for (const auto& row : table)
        for (int side = 0; side < 2; ++side) {
            const double eta = side == 0 ? row[0] : 1 / row[0];
            // Split at the critical angle, and t = s^2 away from it: the reflectance has a root's slope
            // there.
            const double split = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
            std::vector<float> cosines;
            for (double t : x) cosines.push_back(float(split + (1 - split) * t * t));
            const auto r = runOnDevice<float>(kFresnel, "fresnelDielectric(a, b)", cosines,
                                              std::vector<float>(cosines.size(), float(eta)));
            double average = split * split;
            for (std::size_t i = 0; i < x.size(); ++i)
                average += 2 * double(r[i]) * double(cosines[i]) * (1 - split) * 2 * x[i] * w[i];
            EXPECT_NEAR(average, row[std::size_t(side + 1)], 2e-6L) << row[0] << " side " << side;
        }
}

/** Directional albedo of a lobe's case by the midpoint rule about the mirrored direction on the device, one
 * ring of directions per invocation. */
double albedoOf(const Lobe& model, const glm::mat4& p, float cosine, int rings = 2048) {
    std::vector<glm::mat4> ps(std::size_t(rings), p);
    std::vector<glm::vec3> wo(std::size_t(rings), directionAt(cosine, 0.0f));
    std::vector<float> ring;
    for (int i = 0; i < rings; ++i) ring.push_back((float(i) + 0.5f) / float(rings));
    // Polar angle from z is quarter turn times a smooth map that puts more rings at grazing angles.
    const auto sums = runOnDevice<float>(model.lines(),
                                         "float t = c * (2.0 - c), jacobian = 2.0 * (1.0 - c) * HALF_PI; "
                                         "float s, z; realSinCos(t * HALF_PI, s, z);"
                                         "float sum = 0.0; for (int k = 0; k < 2048; ++k) { float x, y; "
                                         "sinCosTurns((float(k) + 0.5) / 2048.0, y, x);"
                                         "vec3 wi = vec3(s * x, s * y, z); sum += VALUE(a, b, wi).value.x; }"
                                         "return sum * (TWO_PI / 2048.0) * s * jacobian;",
                                         ps, wo, ring);
    double total = 0;
    for (float s : sums) total += double(s);
    return total / rings;
}

TEST(Microfacets, GgxAlbedoIsTheTable) {
    const std::vector<float> cosines = {1.0f, 0.8f, 0.5f, 0.2f, 0.05f};
    const std::vector<std::pair<float, std::vector<double>>> table = {
        {0.1f, {0.98831L, 0.98457L, 0.96921L, 0.90456L, 0.91176L}},
        {0.5f, {0.68785L, 0.68205L, 0.69825L, 0.78993L, 0.91255L}},
        {1.0f, {0.3068528L, 0.35126L, 0.45069L, 0.64165L, 0.84777L}}};
    for (const auto& [alpha, row] : table) {
        glm::mat4 p(0.0f);
        p[1] = {alpha, alpha, 0, 0};
        for (std::size_t i = 0; i < cosines.size(); ++i)
            EXPECT_NEAR(albedoOf(lobe("ggx"), p, cosines[i]), row[i], alpha == 1.0f && i == 0 ? 1e-5L : 2e-5L)
                << "alpha " << alpha << " cosine " << cosines[i];
    }
}

TEST(Microfacets, SeparableSmithIsTheTable) {
    Lobe model = lobe("ggx");
    model.preamble[1] =
        "#define VALUE(p, wo, wi) ScatterValue(vec3(wi.z > 0.0 ? ggxNormals(normalize(wo + wi), p[1].xy) * "
        "ggxShadowingSeparable(wo, wi, p[1].xy) : 0.0), 0.0)";
    const std::vector<float> cosines = {1.0f, 0.8f, 0.5f, 0.2f, 0.05f};
    const std::vector<std::pair<float, std::vector<double>>> table = {
        {0.5f, {0.68785L, 0.67964L, 0.68601L, 0.73898L, 0.79228L}},
        {1.0f, {0.30685L, 0.34095L, 0.40914L, 0.51142L, 0.58448L}}};
    for (const auto& [alpha, row] : table) {
        glm::mat4 p(0.0f);
        p[1] = {alpha, alpha, 0, 0};
        for (std::size_t i = 0; i < cosines.size(); ++i)
            EXPECT_NEAR(albedoOf(model, p, cosines[i]), row[i], 2e-5L)
                << "alpha " << alpha << " " << cosines[i];
    }
}

/** The integrals of D cos, and of the density of visible normals, over the normals: both are 1. Normals are
 * taken by slope / alpha, whose radius maps to (0, 1) by r / (1 - r). */
TEST(Microfacets, NormalsIntegrateToOne) {
    std::vector<double> x, w;
    gaussLegendre(192, x, w);
    for (const LobeCase& c : lobe("ggx").cases)
        for (float beckmann : {0.0f, 1.0f}) {
            glm::mat4 p = c.p;
            p[1].z = beckmann;
            std::vector<glm::mat4> ps(x.size(), p);
            std::vector<float> r;
            for (double t : x) r.push_back(float(t));
            for (float cosine : {1.0f, 0.7f, 0.1f}) {
                std::vector<glm::vec3> wo(x.size(), directionAt(cosine, 0.4f));
                // dh = cos^3 d(slope): d(slope) = alpha.x alpha.y radius d(radius) d(angle).
                const auto sums = runOnDevice<glm::vec2>(
                    lobe("ggx").lines(),
                    "float radius = c / (1.0 - c); vec2 sum = vec2(0.0); Microfacets m = "
                    "Microfacets(a[1].xy, a[1].z > 0.5);"
                    "for (int k = 0; k < 2048; ++k) { float s, t; sinCosTurns((float(k) + 0.5) / 2048.0, s, "
                    "t);"
                    "vec3 h = normalize(vec3(radius * t * m.alpha.x, radius * s * m.alpha.y, 1.0));"
                    "float solid = h.z * h.z * h.z; sum += vec2(facetNormals(m, h) * h.z, "
                    "facetVisibleNormals(m, b, h)) * solid; }"
                    "return sum * (TWO_PI / 2048.0) * m.alpha.x * m.alpha.y * radius / ((1.0 - c) * (1.0 - "
                    "c));",
                    ps, wo, r);
                double normals = 0, visible = 0;
                for (std::size_t i = 0; i < x.size(); ++i) {
                    normals += double(sums[i].x) * w[i];
                    visible += double(sums[i].y) * w[i];
                }
                EXPECT_NEAR(normals, 1.0, 1e-5L) << c.name << " Beckmann " << beckmann;
                // At grazing angles half of the circle faces away: a kink in the angle's integrand.
                EXPECT_NEAR(visible, 1.0, 1e-4L)
                    << c.name << " cosine " << cosine << " Beckmann " << beckmann;
            }
        }
}

/** Quarter turns of wo, wi and the widths change nothing; equal widths do not see the azimuth. */
TEST(Microfacets, AnisotropyTurnsWithTheTangent) {
    std::vector<glm::vec3> wo, wi;
    for (int i = 0; i < 4000; ++i) {
        wo.push_back(directionAt(0.01f + 0.98f * float(i % 63) / 63.0f, 0.1f * float(i)));
        wi.push_back(directionAt(0.01f + 0.98f * float(i % 89) / 89.0f, 0.37f * float(i)));
    }
    for (const char* kind : {"false", "true"}) {
        const std::string f = "facetValue(Microfacets(vec2(0.1, 0.5), " + std::string(kind) +
                              "), a, b).value.x - facetValue(Microfacets(vec2(0.5, 0.1), " + kind +
                              "), vec3(-a.y, a.x, a.z), vec3(-b.y, b.x, b.z)).value.x";
        for (float d : runOnDevice<float>(lobe("ggx").lines(), f, wo, wi)) ASSERT_EQ(d, 0.0f);
    }
    // The textbook isotropic form, whose 1 - cos^2 loses digits: agreement to what those leave.
    const auto relative =
        runOnDevice<float>(lobe("ggx").lines(),
                           "vec3 h = normalize(a + b); float c2 = h.z * h.z, d = c2 * (0.25 - 1.0) + 1.0;"
                           "return ggxNormals(h, vec2(0.5)) / (0.25 / (PI * d * d)) - 1.0;",
                           wo, wi);
    for (float d : relative) ASSERT_NEAR(d, 0.0f, 1e-5f);
}

TEST(Phong, NormsMakeTheAlbedoOneFromAbove) {
    struct Case {
        float n;
        double norm;
    };
    for (const Case& c : {Case{1, 0.3496155L}, Case{10, 0.6663684L}, Case{100, 4.2207891L}}) {
        const auto norm =
            runOnDevice<float>("shaders/scattering/phong.glsl", "blinnPhongNorm(a)", std::vector{c.n});
        EXPECT_NEAR(double(norm[0]), c.norm, 1e-6L * c.norm);
        glm::mat4 p(0.0f);
        p[0] = {1, 1, 1, c.n};
        EXPECT_NEAR(albedoOf(lobe("blinnPhong"), p, 1.0f, 8192), 1.0, 1e-5L) << c.n;
        EXPECT_NEAR(albedoOf(lobe("phong"), p, 1.0f, 8192), 1.0, 1e-5L) << c.n;
    }
}

TEST(Diffuse, AlbedoIsTheFactor) {
    glm::mat4 p(0.0f);
    p[0] = {0.7f, 0.7f, 0.7f, 0.0f};
    for (float cosine : kCosines) {
        EXPECT_NEAR(albedoOf(lobe("lambert"), p, cosine), 0.7L, 1e-6L);
        EXPECT_NEAR(albedoOf(lobe("orenNayar"), p, cosine), 0.7L, 1e-6L);
    }
    // Fujii's closed form: a from above, 1 at grazing.
    p[0].w = 0.5f;
    const double a = 1 / (1 + (0.5L - 2 / (3 * kPi)) * 0.5L);
    EXPECT_NEAR(albedoOf(lobe("orenNayar"), p, 1.0f), 0.7L * a, 2e-6L);
    EXPECT_NEAR(albedoOf(lobe("orenNayar"), p, 1e-5f), 0.7L, 2e-5L);
}

/** A slab of two smooth interfaces, all orders of reflection between them: sums of the sampled weights' own
 * chances along both ways, by the series. */
TEST(Dielectric, SlabLetsThroughWhatTheSeriesSays) {
    struct Case {
        double angle, transmitted;
    };
    for (const Case& c : {Case{0, 0.923076923L}, Case{60, 0.836232463L}}) {
        const auto t = runOnDevice<float>(
            {"shaders/scattering/dielectric.glsl"},
            "vec3 wo = vec3(sqrt(1.0 - a * a), 0.0, a); Microfacets m = Microfacets(vec2(0.0), false);"
            "ScatterSample enter = dielectricSample(1.5, m, false, wo, vec3(0.0, 0.0, 0.99999));"
            "vec3 inside = -enter.direction; inside.z = -inside.z;"
            "inside = vec3(inside.xy, abs(inside.z)); float cosine; float r = fresnelDielectric(a, 1.5, "
            "cosine);"
            "ScatterSample leave = dielectricSample(1.0 / 1.5, m, false, inside, vec3(0.0, 0.0, 0.99999));"
            "float r2 = fresnelDielectric(inside.z, 1.0 / 1.5);"
            // n^2 cancels on the way out; the rest is a geometric series.
            "return (1.0 - r) * enter.weight.x * leave.weight.x * (1.0 - r2) / (1.0 - r2 * r2);",
            std::vector{cosineOf(c.angle)});
        EXPECT_NEAR(double(t[0]), c.transmitted, 1e-6L) << c.angle;
    }
    const auto pane =
        runOnDevice<float>({"shaders/scattering/dielectric.glsl"},
                           "1.0 - paneReflectance(fresnelDielectric(a, 1.5))", std::vector{1.0f});
    EXPECT_NEAR(double(pane[0]), 0.923076923L, 1e-6L);
}

/** Snell's law and radiance: under a sky of 1, radiance within is n^2; and the cone through which all of the
 * sky is seen. */
TEST(Dielectric, RefractsBySnellAndScalesRadiance) {
    std::vector<float> cosines = floatsSpaced(0.01f, 1.0f, 500);
    const auto sine = runOnDevice<glm::vec2>(
        {"shaders/scattering/dielectric.glsl"},
        "vec3 wo = vec3(0.0, sqrt((1.0 - a) * (1.0 + a)), a); Microfacets m = Microfacets(vec2(0.0), false);"
        "ScatterSample s = dielectricSample(1.333, m, false, wo, vec3(0.0, 0.0, 0.9999999));"
        "return vec2(length(s.direction.xy) * 1.333 - length(wo.xy), s.weight.x * 1.333 * 1.333);",
        cosines);
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        ASSERT_NEAR(sine[i].x, 0.0f, 1e-6f) << cosines[i];
        ASSERT_NEAR(sine[i].y, 1.0f, 1e-6f) << cosines[i];
    }
    // Seen from under water: half of 97.2133 degrees.
    const auto edge = runOnDevice<float>(
        kFresnel, "fresnelDielectric(a, 1.0 / 1.333)",
        std::vector{cosineOf(97.2132527832496L / 2 - 0.01L), cosineOf(97.2132527832496L / 2 + 0.01L)});
    EXPECT_LT(edge[0], 1.0f);
    EXPECT_EQ(edge[1], 1.0f);
}

TEST(Dielectric, TransmittanceIsWhatReflectionLeaves) {
    const auto sum = runOnDevice<float>(
        kFresnel, "float t; float r = fresnelDielectric(a, b, t); return r + fresnelTransmittance(a, t, b);",
        floatsSpaced(0.05f, 1.0f, 200), std::vector<float>(200, 1.5f));
    for (const float total : sum) ASSERT_NEAR(total, 1.0f, 1e-6f);
}

TEST(Dielectric, PanesMirrorOrLetThroughInLine) {
    const std::vector<float> cosines = floatsSpaced(0.05f, 1.0f, 100);
    const auto x = runOnDevice<glm::vec4>(
        {"shaders/scattering/dielectric.glsl"},
        "vec3 wo = vec3(0.0, sqrt((1.0 - a) * (1.0 + a)), a);"
        "float r = paneReflectance(fresnelDielectric(a, 1.5));"
        "vec3 up = paneSample(1.5, vec3(1.0), wo, vec3(0.5, 0.5, r - 1e-3)).direction;"
        "vec3 down = paneSample(1.5, vec3(1.0), wo, vec3(0.5, 0.5, r + 1e-3)).direction;"
        "return vec4(r, length(up - vec3(0.0, -wo.y, a)), length(down + wo), 0.0);",
        cosines);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = verify::fresnelDielectric(double(cosines[i]), 1.5).average();
        ASSERT_NEAR(double(x[i].x), 2 * r / (1 + r), 1e-6L) << cosines[i];
        ASSERT_EQ(x[i].y, 0.0f) << cosines[i];
        ASSERT_EQ(x[i].z, 0.0f) << cosines[i];
    }
}

TEST(Conductor, SmoothOnesMirrorByFresnelsEquations) {
    const std::vector<float> cosines = floatsSpaced(0.05f, 1.0f, 100);
    const auto weight = runOnDevice<glm::vec4>(
        {"shaders/scattering/conductor.glsl"},
        "vec3 wo = vec3(0.0, sqrt((1.0 - a) * (1.0 + a)), a); Microfacets m = Microfacets(vec2(0.0), false);"
        "ScatterSample s = conductorSample(vec3(0.2), vec3(3.1), m, wo, vec3(0.5));"
        "return vec4(s.weight.x, length(s.direction - vec3(0.0, -wo.y, a)), s.density, 0.0);",
        cosines);
    for (std::size_t i = 0; i < weight.size(); ++i) {
        const double r = verify::fresnelConductor(double(cosines[i]), double(0.2f), double(3.1f)).average();
        ASSERT_NEAR(double(weight[i].x), r, 2e-6L) << cosines[i];
        ASSERT_EQ(weight[i].y, 0.0f) << cosines[i];
        ASSERT_LT(weight[i].z, 0.0f) << cosines[i];
    }
}

/** By Fujii's formula with the angles themselves, at azimuths that mirroring would change. */
TEST(Diffuse, OrenNayarTurnsWithTheAzimuthBetween) {
    std::vector<float> azimuths = floatsSpaced(0.0f, 6.28f, 64);
    const auto got =
        runOnDevice<float>({"shaders/scattering/oren_nayar.glsl"},
                           "vec3 wo = vec3(0.6 * 0.28, 0.6 * 0.96, 0.8), wi = vec3(0.8 * b, 0.6);"
                           "return orenNayarValue(vec3(1.0), 0.7, wo, wi).value.x;",
                           azimuths, [&] {
                               std::vector<glm::vec2> turned;
                               for (const float phi : azimuths)
                                   turned.emplace_back(std::cos(phi), std::sin(phi));
                               return turned;
                           }());
    for (std::size_t i = 0; i < got.size(); ++i) {
        const double between = double(azimuths[i]) - std::acos(double(0.28f));
        const double across = double(0.6f) * double(0.8f) * std::cos(between);
        const double a = 1 / (1 + (0.5 - 2 / (3 * kPi)) * double(0.7f));
        const double f = a / kPi * (1 + double(0.7f) * (across > 0 ? across / double(0.8f) : across));
        ASSERT_NEAR(double(got[i]), f * double(0.6f), 1e-6L) << azimuths[i];
    }
}

/** The device against the same source in double: what single precision costs a glTF-like lobe. */
TEST(Microfacets, SinglePrecisionKeepsNarrowLobes) {
    std::vector<glm::vec3> wo;
    std::vector<float> alpha;
    for (float a : {1e-4f, 1e-3f, 0.01f, 0.1f, 1.0f})
        for (int i = 0; i < 400; ++i) {
            wo.push_back(directionAt(1e-3f + 0.999f * float(i) / 400.0f, 0.3f));
            alpha.push_back(a);
        }
    // The sampled normal's own density, as the sampler's input sees it.
    const auto got = runOnDevice<glm::vec4>(
        lobe("ggx").lines(),
        "vec3 h = ggxSampleNormal(a, vec2(b), vec2(0.3, 0.6)); return vec4(h, ggxNormals(h, vec2(b)));", wo,
        alpha);
    for (std::size_t i = 0; i < wo.size(); ++i) {
        const glm::dvec2 widths(double(alpha[i]));
        const glm::dvec3 h =
            shared64::ggxSampleNormal(glm::dvec3(wo[i]), widths, glm::dvec2(double(0.3f), double(0.6f)));
        const double density = shared64::ggxNormals(h, widths);
        ASSERT_NEAR(double(got[i].w) / density, 1.0, 1e-4L) << "alpha " << alpha[i] << " cosine " << wo[i].z;
    }
}

}  // namespace
}  // namespace helio::test
