// Blinn and Phong's model in the raster pipeline, at its three rates.
#include "tests/accuracy/shade_runner.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/shader_harness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace helio::test {
namespace {

const Preamble kModel = {"#define BLINN_PHONG 1", "shaders/raster/blinn_phong.glsl"};

double norm(double p) {
    return (p + 2) * (p + 4) / (8 * std::numbers::pi * (std::exp2(-p / 2) + p));
}

/** The model in double: on kd / pi and on ks. */
glm::dvec2 model(const glm::dvec3& normal, const glm::dvec3& l, const glm::dvec3& v, double p) {
    const glm::dvec3 n = glm::normalize(normal);
    const double cosine = glm::dot(n, l);
    if (!(cosine > 0)) return glm::dvec2(0);
    const double h = glm::dot(n, glm::normalize(l + v));
    return {cosine, norm(p) * std::pow(std::max(h, 0.0), p) * cosine};
}

glm::dvec3 unit(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

TEST(BlinnPhong, IsItsFormula) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<glm::vec3> n, l, v;
    std::vector<float> p;
    for (int i = 0; i < 200000; ++i) {
        n.emplace_back(unit(random));
        l.emplace_back(unit(random));
        // Half of them near the peak.
        const glm::dvec3 mirrored = glm::reflect(-glm::dvec3(l.back()), glm::dvec3(n.back()));
        v.emplace_back(i % 2 == 0 ? unit(random) : glm::normalize(mirrored + 0.1 * unit(random)));
        p.push_back(float(std::exp2(10 * uniform(random) - 2)));
    }
    const auto got = runOnDevice<glm::vec2>(
        kModel, "BlinnPhongLight r = blinnPhongLight(a, b, c, d); return vec2(r.diffuse, r.gloss);", n, l, v,
        p);
    double diffuse = 0, gloss = 0;
    std::size_t dark = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const glm::dvec2 wanted = model(n[i], l[i], v[i], double(p[i]));
        diffuse = std::max(diffuse, std::abs(double(got[i].x) - wanted.x));
        // What a float's last place of the half vector moves the lobe by: p tan(angle) of it.
        const double c =
            glm::dot(glm::normalize(glm::dvec3(n[i])), glm::normalize(glm::dvec3(l[i]) + glm::dvec3(v[i])));
        const double slack = 1 + double(p[i]) * std::sqrt(std::max(1 - c * c, 0.0)) / std::max(c, 1e-6);
        const double scale = norm(double(p[i])) * std::pow(std::max(c, 0.0), double(p[i])) * slack + 1e-30;
        gloss = std::max(gloss, std::abs(double(got[i].y) - wanted.y) / scale);
        if (glm::dot(glm::dvec3(n[i]), glm::dvec3(l[i])) < -1e-6) {
            ++dark;
            ASSERT_EQ(got[i].x, 0.0f);
            ASSERT_EQ(got[i].y, 0.0f);
        }
    }
    std::printf(
        "             diffuse within %.1e, gloss within %.1e of the lobe; %zu from behind, all dark\n",
        diffuse, gloss, dark);
    EXPECT_LT(diffuse, 2e-7);
    EXPECT_LT(gloss, 2e-6);
    EXPECT_GT(dark, 50000u);
}

TEST(BlinnPhong, PeaksWhereTheHalfVectorIsTheNormalAndHalvesWhereItShould) {
    for (float p : {1.0f, 10.0f, 100.0f, 1000.0f}) {
        // Light and eye turn apart about the half vector, which stays at angle t from the normal (in the
        // plane across theirs, so that n.l is the same share cos(t) of that at the peak).
        const double half = std::acos(std::exp2(-1.0 / double(p)));
        std::vector<glm::vec3> n, l, v;
        for (double t : {0.0, half, 0.3 * half, 1.1 * half}) {
            n.emplace_back(std::sin(t), std::cos(t), 0);
            l.emplace_back(0, std::cos(0.5), std::sin(0.5));
            v.emplace_back(0, std::cos(0.5), -std::sin(0.5));
        }
        const std::vector<float> gloss = runOnDevice<float>(
            kModel, "blinnPhongLight(a, b, c, d).gloss / blinnPhongLight(a, b, c, d).diffuse", n, l, v,
            std::vector<float>(n.size(), p));
        EXPECT_NEAR(gloss[1] / gloss[0], 0.5, 0.5 * 2e-6 * (1 + std::sqrt(double(p)))) << p;
        EXPECT_NEAR(gloss[0] / norm(double(p)), 1, 2e-6) << p;
        EXPECT_GT(gloss[0], gloss[2]);
        EXPECT_GT(gloss[1], gloss[3]);
    }
}

TEST(BlinnPhong, ReflectsNoMoreThanItsFactor) {
    // Albedo from above: the integral of gloss over the directions of light, by the midpoint rule in the
    // height.
    for (float p : {0.5f, 5.0f, 50.0f, 500.0f}) {
        constexpr int count = 20000;
        std::vector<glm::vec3> n(count, glm::vec3(0, 0, 1)), l;
        for (int i = 0; i < count; ++i) {
            const double z = (i + 0.5) / count;
            l.emplace_back(std::sqrt(1 - z * z), 0, z);
        }
        const std::vector<float> gloss = runOnDevice<float>(kModel, "blinnPhongLight(a, b, a, c).gloss", n, l,
                                                            std::vector<float>(count, p));
        double sum = 0;
        for (float g : gloss) sum += double(g) * 2 * std::numbers::pi / count;
        EXPECT_NEAR(sum, 1, 3e-5) << p;
    }
}

/** A directional light of irradiance 1 from the unit vector `towards`. */
void addDirectional(Scene& scene, const glm::dvec3& towards) {
    const glm::dvec3 z = glm::normalize(towards);
    const glm::dvec3 x =
        glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
    PunctualLight light;
    light.type = PunctualLight::Type::Directional;
    addLight(scene, light,
             glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                        glm::dvec4(0, 0, 0, 1)));
}

/** That, and surroundings of radiance kAmbient. */
constexpr float kAmbient = 0.125f;
void addSky(Scene& scene, const glm::dvec3& towards) {
    addDirectional(scene, towards);
    scene.environment = Environment{glm::vec3(kAmbient), -1};
}

Material glossy(double p) {
    Material m;
    m.baseColor = {0.25f, 0.5f, 0.75f, 1};
    m.metallic = 0.25f;
    m.roughness = float(std::pow(2 / (p + 2), 0.25));
    return m;
}

/** What the material's factors are: kd and ks per channel, and p. */
struct Factors {
    glm::dvec3 kd, ks;
    double p;
};
Factors factorsOf(const Material& m) {
    const double f0 = 0.04, metallic = double(m.metallic), alpha = double(m.roughness) * double(m.roughness);
    const glm::dvec3 color(m.baseColor);
    return {color * (1 - metallic) * (1 - f0), glm::mix(glm::dvec3(f0), color, metallic),
            2 / (alpha * alpha) - 2};
}

TEST(Rates, AreAllTheSameOnAPlaneUnderDistantLight) {
    Scene scene;
    addPrimitive(scene, quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), glossy(20));
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.5, 0.3, 1));
    addSky(scene, towards);
    const RasterView view = frontView(16, 1);
    const Factors f = factorsOf(glossy(20));
    const glm::dvec2 light = model({0, 0, 1}, towards, {0, 0, 1}, f.p);
    const glm::dvec3 wanted =
        f.kd * (light.x / std::numbers::pi) + f.ks * light.y + (f.kd + f.ks) * double(kAmbient);
    for (Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
        const ShadedImage image = shade(scene, view, false, shading);
        for (const glm::vec4& c : image.color)
            for (int i = 0; i < 3; ++i) ASSERT_NEAR(c[i] / wanted[i], 1, 4e-6) << int(shading);
    }
}

/** The unit sphere of so many cuts, with its own normals. */
Scene ball(int level, const Material& material, const glm::dvec3& towards) {
    Primitive p;
    p.positions = octasphere(level);
    for (std::uint32_t i = 0; i < p.positions.size(); ++i) {
        p.normals.push_back(glm::normalize(p.positions[i]));
        p.indices.push_back(i);
    }
    Scene scene;
    // Turned, so that no edge lies along the grid of pixels.
    const double a = 0.3, b = 0.2;
    glm::dmat4 turn(1.0);
    turn[0] = {std::cos(a), std::sin(a), 0, 0};
    turn[1] = {-std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b), 0};
    turn[2] = {std::sin(a) * std::sin(b), -std::cos(a) * std::sin(b), std::cos(b), 0};
    addPrimitive(scene, p, material, turn);
    addSky(scene, towards);
    return scene;
}

/** Mean difference from the true sphere's picture within 0.75 of its middle. */
double ballError(int level, Shading shading) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.4, 0.5, 0.9));
    constexpr std::uint32_t side = 96;
    const ShadedImage image = shade(ball(level, glossy(6), towards), frontView(side, 1), false, shading);
    const Factors f = factorsOf(glossy(6));
    double sum = 0;
    int count = 0;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const double px = (x + 0.5) * 2 / side - 1, py = 1 - (y + 0.5) * 2 / side, r2 = px * px + py * py;
            if (r2 > 0.75 * 0.75) continue;
            const glm::dvec2 light = model({px, py, std::sqrt(1 - r2)}, towards, {0, 0, 1}, f.p);
            const double wanted = f.kd.g * (light.x / std::numbers::pi + double(kAmbient)) +
                                  f.ks.g * (light.y + double(kAmbient));
            sum += std::abs(double(image.color[image.at(x, y)].g) - wanted);
            ++count;
        }
    return sum / count;
}

TEST(Rates, ErrorOnASphereFallsWithItsOrder) {
    for (const auto& [shading, order, name] : {std::tuple{Shading::Flat, 1.0, "flat"},
                                               {Shading::Gouraud, 2.0, "Gouraud"},
                                               {Shading::Phong, 2.0, "Phong"}}) {
        const double coarse = ballError(3, shading), fine = ballError(5, shading);
        const double slope = std::log2(coarse / fine) / 2;
        std::printf("             %-8s error %.2e, %.2e with a quarter of the side: order %.3f\n", name,
                    coarse, fine, slope);
        EXPECT_NEAR(slope, order, 0.15) << name;
    }
    EXPECT_LT(ballError(4, Shading::Phong), ballError(4, Shading::Gouraud));
    EXPECT_LT(ballError(4, Shading::Gouraud), ballError(4, Shading::Flat));
}

TEST(Rates, AHighlightInsideATriangleIsMissedByCorners) {
    // A bulging triangle, its normals leaning outwards: the highlight is in its middle alone.
    Primitive p;
    p.positions = {{-2, -1, 0}, {2, -1, 0}, {0, 2, 0}};
    for (const glm::vec3& corner : p.positions)
        p.normals.push_back(glm::normalize(corner + glm::vec3(0, 0, 2)));
    p.indices = {0, 1, 2};
    Scene scene;
    const Material m = glossy(80);
    addPrimitive(scene, p, m);
    addSky(scene, {0, 0, 1});
    const RasterView view = frontView(64, 2.2);
    const Factors f = factorsOf(m);
    const double peak = f.kd.g / std::numbers::pi + f.ks.g * norm(f.p);  // n = l = v = h
    const double ambient = (f.kd.g + f.ks.g) * double(kAmbient);
    const auto brightest = [&](Shading shading) {
        const ShadedImage image = shade(scene, view, false, shading);
        double most = 0;
        for (std::size_t i = 0; i < image.color.size(); ++i)
            if (image.ids[i].x >= 0) most = std::max(most, double(image.color[i].g) - ambient);
        return most;
    };
    // The pixel nearest to the middle is within half a pixel of it.
    EXPECT_NEAR(brightest(Shading::Phong) / peak, 1, 0.02);
    double corners = 0;
    for (const glm::vec3& n : p.normals) {
        const glm::dvec2 light = model(n, {0, 0, 1}, {0, 0, 1}, f.p);
        corners = std::max(corners, f.kd.g * light.x / std::numbers::pi + f.ks.g * light.y);
    }
    EXPECT_LE(brightest(Shading::Gouraud), corners * (1 + 1e-5));
    EXPECT_LT(corners, 0.2 * peak);
    EXPECT_NEAR(brightest(Shading::Flat) / peak, 1, 1e-5);  // its plane faces the light
}

TEST(Rates, DiffuseScenesInAnyOrderOfTriangles) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.4, 0.5, 0.9));
    const RasterView view = frontView(40, 1.1);
    const Scene scene = ball(2, lambert(glm::vec3(0.5f)), towards);
    const ShadedImage image = shade(scene, view, false, Shading::Gouraud);
    EXPECT_EQ(image.color, shade(scene, view, true, Shading::Gouraud).color);
    // It has no gloss.
    double most = 0;
    for (std::size_t i = 0; i < image.color.size(); ++i)
        if (image.ids[i].x >= 0) most = std::max(most, double(image.color[i].g));
    EXPECT_LE(most, 0.5 * (1 / std::numbers::pi + double(kAmbient)) * (1 + 1e-6));
    EXPECT_GT(most, 0.95 * 0.5 * (1 / std::numbers::pi + double(kAmbient)));
}

}  // namespace
}  // namespace helio::test
