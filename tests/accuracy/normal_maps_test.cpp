/** @file
 * Normal maps: where they lean, that they lose no light, and that facets
 * (shaders/scattering/tilted_facets.glsl) are reciprocal and drawn as they are judged.
 */
#include "tests/accuracy/plates.hpp"
#include "tests/support/shader_harness.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;

/** A glTF normal map of one texel. */
int addTilt(Scene& scene, double tilt, double turn) {
    const double sine = std::sin(tilt * kPi / 180);
    const glm::dvec3 n(sine * std::cos(turn * kPi / 180), sine * std::sin(turn * kPi / 180),
                       std::cos(tilt * kPi / 180));
    const glm::vec3 texel = 0.5f * glm::vec3(n) + 0.5f;
    scene.images.push_back({"tilt", 1, 1, std::vector<float>{texel.x, texel.y, texel.z, 1}});
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    return int(scene.textures.size()) - 1;
}

class BothMappings : public testing::TestWithParam<NormalMapping> {};
INSTANTIATE_TEST_SUITE_P(Furnace, BothMappings, testing::Values(NormalMapping::Folded, NormalMapping::Facets),
                         [](const auto& mapping) {
                             return mapping.param == NormalMapping::Folded ? "Folded" : "Facets";
                         });

/** However steep the map, towards the viewer, across or away, a surface that loses no light shows as much as
 * is around it: what a tilted lobe sends under the surface is mirrored at it, or followed between facets. */
TEST_P(BothMappings, LoseNothingAtAnyTilt) {
    Plates p;
    Scene& scene = p.b.scene;
    Material facets = model(Scattering::Model::Conductor);
    facets.scattering->n = glm::vec3(0.01f);
    facets.scattering->k = glm::vec3(100);
    facets.scattering->multipleScattering = true;
    facets.scattering->alpha = glm::vec2(0.6f);
    Material white = gltf(glm::vec3(1), 0, 1);
    white.specular = 0;
    std::array materials = {white, model(Scattering::Model::Mirror), facets};
    for (const double tilt : {20.0, 45.0, 70.0, 85.0, 89.9}) {
        for (const double turn : {0.0, 90.0, 200.0}) {
            const int texture = addTilt(scene, tilt, turn);
            for (std::size_t i = 0; i < materials.size(); ++i) {
                materials[i].normalTexture.texture = texture;
                p.add(std::array{"white", "mirror", "facets"}[i] + std::string(" tilted by ") +
                          std::to_string(int(tilt)) + " towards " + std::to_string(int(turn)),
                      materials[i]);
            }
        }
    }
    scene.environment = Environment{glm::vec3(1), -1};
    for (const double angle : {0.0, 50.0, 85.0}) {
        Plates seen = p;
        seen.view(angle);
        const Traced image = seen.render(64, true, GetParam());
        EXPECT_EQ(image.rejected, 0u);
        Estimate rough;  // of all tilts
        for (std::size_t i = 0; i < p.names.size(); ++i) {
            const Estimate e = plate(image, i);
            if (i % 3 != 2) {
                expectMean(e, 1, 1e-4, p.names[i]);
                continue;
            }
            EXPECT_NEAR(e.mean, 1, 1e-3 + 4.5 * e.error) << p.names[i] << " at " << angle;
            const double share = 3.0 / double(p.names.size());
            rough.mean += share * e.mean;
            rough.error = std::hypot(rough.error, share * e.error);
        }
        EXPECT_NEAR(rough.mean, 1, 1e-3 + 4 * rough.error) << angle;
        EXPECT_LT(rough.error, 0.02) << angle;
    }
}

/** The node of a light from +z of irradiance 1, the scene's first. */
Node& addSun(Scene& scene) {
    PunctualLight sun;
    sun.type = PunctualLight::Type::Directional;
    sun.intensity = glm::vec3(1);
    scene.lights.push_back(sun);
    scene.roots.push_back(int(scene.nodes.size()));
    Node& node = scene.nodes.emplace_back();
    node.light = 0;
    return node;
}

/** Radiance towards a view at an angle of plates in a sun of irradiance cos, in the plane x = 0. */
Traced sunlit(const Plates& plates, double viewDegrees, double sunDegrees, NormalMapping mapping) {
    Plates p = plates;
    Scene& scene = p.b.scene;
    // view() looks from (0, -sin, cos).
    addSun(scene).rotation = glm::angleAxis(float(sunDegrees * kPi / 180), glm::vec3(1, 0, 0));
    p.view(viewDegrees);
    return p.render(256, true, mapping);
}

/** f(i, o) = f(o, i) in pictures: diffuse paint and rough metal under maps of any tilt, lit from where they
 * were seen and seen from where they were lit. Folded lobes fail this by more than a tenth. */
TEST(NormalMaps, FacetsAreReciprocalInPictures) {
    Plates p;
    Material white = gltf(glm::vec3(0.8f), 0, 1);
    white.specular = 0;
    std::array materials = {white, gltf(glm::vec3(0.9f), 1, 0.6f)};
    for (const double tilt : {20.0, 45.0, 70.0}) {
        for (const double turn : {80.0, 200.0, 270.0}) {
            const int texture = addTilt(p.b.scene, tilt, turn);
            for (Material& material : materials) {
                material.normalTexture.texture = texture;
                p.add("tilted by " + std::to_string(int(tilt)) + " towards " + std::to_string(int(turn)),
                      material);
            }
        }
    }
    double worst = 0, foldedWorst = 0;
    for (const auto [o, i] : {std::array{20.0, 70.0}, std::array{-65.0, 40.0}, std::array{-75.0, 80.0}}) {
        const double byI = 1 / std::cos(i * kPi / 180), byO = 1 / std::cos(o * kPi / 180);
        for (const NormalMapping mapping : {NormalMapping::Facets, NormalMapping::Folded}) {
            if (mapping == NormalMapping::Folded && foldedWorst > 0) continue;
            const Traced there = sunlit(p, o, i, mapping), back = sunlit(p, i, o, mapping);
            for (std::size_t k = 0; k < p.names.size(); ++k) {
                const Estimate a = plate(there, k), b = plate(back, k);
                const double error = std::hypot(a.error * byI, b.error * byO) + 2e-6;
                const double off = a.mean * byI - b.mean * byO;
                if (mapping == NormalMapping::Folded) {
                    foldedWorst = std::max(foldedWorst, std::abs(off) / std::max(a.mean * byI, b.mean * byO));
                    continue;
                }
                worst = std::max(worst, std::abs(off) / error);
                EXPECT_LT(std::abs(off), 4.5 * error)
                    << p.names[k] << ": " << a.mean * byI << " and " << b.mean * byO;
                EXPECT_LT(error, 0.04 * std::max(a.mean * byI, 0.1)) << p.names[k];
            }
        }
    }
    EXPECT_GT(foldedWorst, 0.1);
    std::printf("facets: |z| <= %.2f; folded: off by up to %.3f of the value\n", worst, foldedWorst);
}

/** Sampling a lamp, and leaving it to chance, give one picture, of mirrors too. */
TEST(NormalMaps, FacetsAreLitAlikeBothWays) {
    Plates p;
    Material white = gltf(glm::vec3(0.8f), 0, 1);
    white.specular = 0;
    std::array materials = {white, gltf(glm::vec3(0.9f), 1, 0.5f), model(Scattering::Model::Mirror)};
    for (const double tilt : {30.0, 65.0}) {
        const int texture = addTilt(p.b.scene, tilt, 60);
        for (Material& material : materials) {
            material.normalTexture.texture = texture;
            p.add("tilted by " + std::to_string(int(tilt)), material);
        }
    }
    const int lamp = p.b.material(glm::vec3(0), glm::vec3(3), true);
    p.b.quad({-9, 9, 1}, {15, 9, 1}, {15, 9, 25}, {-9, 9, 25}, lamp);
    p.view(35);
    const Traced sampled = p.render(128, true, NormalMapping::Facets),
                 chance = p.render(256, false, NormalMapping::Facets);
    for (std::size_t i = 0; i < p.names.size(); ++i) {
        const Estimate a = plate(sampled, i), c = plate(chance, i);
        EXPECT_LT(std::abs(a.mean - c.mean), 4 * std::hypot(a.error, c.error))
            << i << ": " << a.mean << " +- " << a.error << " and " << c.mean << " +- " << c.error;
        EXPECT_GT(c.mean, 0.05) << i;
        EXPECT_LT(c.error, 0.05 * c.mean) << i;
    }
}

/** Normal maps: red leans along the tangent (+u), green against v. Light from one direction tells which. */
TEST(NormalMaps, LeanAlongTheTextureAndLoseNothing) {
    Plates p;
    Scene& scene = p.b.scene;
    // (0.6, 0, 0.8) and (0, 0.6, 0.8).
    scene.images.push_back({"u", 1, 1, std::vector<float>{0.8f, 0.5f, 0.9f, 1}});
    scene.images.push_back({"v", 1, 1, std::vector<float>{0.5f, 0.8f, 0.9f, 1}});
    for (int image : {0, 1}) {
        Texture t;
        t.image = image;
        scene.textures.push_back(t);
    }
    Material m = gltf(glm::vec3(1), 0, 1);
    m.specular = 0;
    m.normalTexture.texture = 0;
    p.add("u", m);
    m.normalTexture.texture = 1;
    p.add("v", m);
    m.normalTexture.texture = 0;
    const int given = p.add("tangents given", m);
    Primitive& primitive = scene.meshes[std::size_t(given)].primitives[0];
    primitive.normals.assign(6, glm::vec3(0, 0, 1));
    primitive.tangents.assign(6, glm::vec4(0, -1, 0, 1));
    addSun(scene);
    const std::size_t sunNode = scene.nodes.size() - 1;
    p.view(10);
    // Light from (sin a, 0, cos a). Low light also reaches the lean normal by its mirror image under the
    // surface.
    for (double lift : {40 * kPi / 180, 75 * kPi / 180}) {
        scene.nodes[sunNode].rotation = glm::angleAxis(float(lift), glm::vec3(0, 1, 0));
        const Traced image = p.render(8);
        const glm::dvec3 l(std::sin(lift), 0, std::cos(lift));
        const auto truth = [&](const glm::dvec3& n) {
            return (std::max(0.0, glm::dot(n, l)) + std::max(0.0, glm::dot(n, glm::dvec3(l.x, l.y, -l.z)))) /
                   kPi;
        };
        expectMean(plate(image, 0), truth({0.6, 0, 0.8}), 1e-6, "u");
        expectMean(plate(image, 1), truth({0, 0.6, 0.8}), 1e-6, "v");
        expectMean(plate(image, 2), truth({0, -0.6, 0.8}), 1e-6, "tangents given");
    }
}

/** Light between facets of diffuse paint (alpha 0) or a GGX mirror, as a function of: a, the tilted normal's
 * tilt and azimuth in radians, alpha, a light's density; b, wo; c, a light's direction; d, a key. Gives the
 * direction in which light leaves, (weight, density, value of the light's direction). */
std::vector<glm::mat3> walk(const std::vector<glm::vec4>& cases, const std::vector<glm::vec3>& wo,
                            const std::vector<glm::vec3>& toLight) {
    static const Preamble preamble = {"#extension GL_EXT_control_flow_attributes : require",
                                      "shaders/scattering/ggx.glsl",
                                      "shaders/scattering/lambert.glsl",
                                      R"(#define BASE
struct SurfaceBsdf { mat3 frame; vec3 wo; float alpha; };
const bool HAS_LIGHT_THROUGH = false;
ScatterValue localValue(SurfaceBsdf s, vec3 wi) {
    vec3 h;
    if (s.alpha > 0.0) return ggxReflection(s.wo, wi, vec2(s.alpha), h);
    return lambertValue(vec3(1.0), s.wo, wi);
}
ScatterSample localDirection(SurfaceBsdf s, vec3 u) {
    if (s.alpha > 0.0) return unjudged(reflectedAbout(s.wo, ggxSampleNormal(s.wo, vec2(s.alpha), u.xy)));
    return unjudged(cosineHemisphere(u.xy));
})",
                                      "shaders/scattering/facet_walk.glsl",
                                      R"(#define WALK
mat3 walked(vec4 a, vec3 wo, vec3 toLight, uint key) {
    const vec3 normal = vec3(sin(a.x) * cos(a.y), sin(a.x) * sin(a.y), cos(a.x));
    const TiltedFacets f = tiltedFacets(vec3(0.0, 0.0, 1.0), normal);
    vec3 x, y;
    orthonormalBasis(f.tilted, x, y);
    SurfaceBsdf s = SurfaceBsdf(mat3(x, y, f.tilted), vec3(0.0), a.z);
    s.wo = seenByTilted(f, wo, unitFloat(hashUint(key))) * s.frame;
    s.wo.z = max(s.wo.z, 1e-6);
    const uvec3 bits = pcg3d(uvec3(key, 5u, 77u));
    const ScatterSample drawn = localDirection(s, vec3(unitFloat(bits.x), unitFloat(bits.y), 0.0));
    const FacetWalk w = walkFacets(s, f, false, hashUint(key), toLight, true, a.w, drawn);
    return mat3(w.direction, vec3(w.weight.x, w.density, w.lit.x), vec3(0.0));
})"};
    std::vector<std::uint32_t> keys(cases.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = std::uint32_t(i) * 0x9e3779b9u + 12345u;
    return runOnDevice<glm::mat3>(preamble, "walked(a, b, c, d)", cases, wo, toLight, keys);
}

glm::vec3 directionOf(double cosine, double azimuth) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/** Directions that leave are as many, each by its worth, as the values of directions say: two estimates of
 * the light in cells over the hemisphere, compared by chi-squared; both ways of finding a light together give
 * all of it. */
TEST(FacetWalk, IsDrawnAsJudged) {
    constexpr std::size_t samples = 1u << 16;
    constexpr int rows = 6, columns = 12, tests = 16;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    double least = 1, worst = 0;
    for (const double tilt : {15.0, 45.0, 70.0, 89.0}) {
        for (const double alpha : {0.0, 0.5}) {
            for (const double cosine : {0.8, 0.05}) {
                const double turn = 2 * kPi * uniform(random), azimuth = 2 * kPi * uniform(random);
                std::vector<glm::vec4> cases(samples, glm::vec4(tilt * kPi / 180, turn, alpha, 0));
                const std::vector<glm::vec3> wo(samples, directionOf(cosine, azimuth));
                std::vector<glm::vec3> light;
                for (std::size_t i = 0; i < samples; ++i)
                    light.push_back(directionOf(std::max(uniform(random), 1e-6), 2 * kPi * uniform(random)));
                const auto cell = [&](const glm::vec3& w) {
                    const double turns = std::atan2(double(w.y), double(w.x)) / (2 * kPi) + 0.5;
                    return std::min(int(w.z * rows), rows - 1) * columns +
                           std::min(int(turns * columns), columns - 1);
                };
                std::array<std::array<double, 4>, rows * columns> sums{};  // and of squares
                const auto walks = walk(cases, wo, light);
                for (std::size_t i = 0; i < samples; ++i) {
                    const double drawn = walks[i][1].x, lit = 2 * kPi * walks[i][1].z;
                    ASSERT_TRUE(std::isfinite(drawn) && std::isfinite(lit) && drawn >= 0 && lit >= 0);
                    ASSERT_TRUE(drawn == 0 || walks[i][0].z > 0);
                    auto& out = sums[std::size_t(cell(walks[i][0]))];
                    out[0] += drawn;
                    out[1] += drawn * drawn;
                    auto& in = sums[std::size_t(cell(light[i]))];
                    in[2] += lit;
                    in[3] += lit * lit;
                }
                double statistic = 0, all = 0;
                int cells = 0;
                for (const auto& sum : sums) {
                    const auto variance = [&](double total, double squares) {
                        return squares - total * total / samples;
                    };
                    all += sum[0] / samples;
                    const double spread = variance(sum[0], sum[1]) + variance(sum[2], sum[3]);
                    if (sum[0] < 20 || spread == 0) continue;
                    statistic += (sum[0] - sum[2]) * (sum[0] - sum[2]) / spread;
                    ++cells;
                }
                const double p = verify::chiSquaredPValue(statistic, cells);
                least = std::min(least, p);
                EXPECT_GT(p, 0.01 / tests) << tilt << " degrees, alpha " << alpha << ", from " << cosine;
                EXPECT_GT(cells, 20);
                EXPECT_NEAR(all, 1, alpha == 0 ? 1e-4 : 1) << tilt;

                const double density = 1 / (2 * kPi);
                for (glm::vec4& c : cases) c.w = float(density);
                verify::RunningStatistics both;
                for (const glm::mat3& w : walk(cases, wo, light)) {
                    const double share = w[1].x > 0 ? w[1].y / (w[1].y + density) : 0;
                    both.add(w[1].x * share + w[1].z / density);
                }
                const double error = std::sqrt(both.variance() / samples), z = (both.mean() - all) / error;
                worst = std::max(worst, std::abs(z));
                EXPECT_LT(std::abs(z), 4.5) << tilt << " degrees, alpha " << alpha << ", from " << cosine;
                EXPECT_LT(error, 0.01);
            }
        }
    }
    std::printf("least p %.4f of %d, both ways |z| <= %.2f\n", least, tests, worst);
}

/** f(i, o) = f(o, i) for directions and tilts at random. */
TEST(FacetWalk, IsReciprocal) {
    constexpr std::size_t samples = 1u << 14, pairs = 96;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<glm::vec4> cases;
    std::vector<glm::vec3> wo, wi;
    for (std::size_t k = 0; k < pairs; ++k) {
        const glm::vec4 c(uniform(random) * 80 * kPi / 180, 2 * kPi * uniform(random), k % 2 == 0 ? 0 : 0.6,
                          0);
        const glm::vec3 a = directionOf(0.05 + 0.95 * uniform(random), 2 * kPi * uniform(random));
        const glm::vec3 b = directionOf(0.05 + 0.95 * uniform(random), 2 * kPi * uniform(random));
        for (int way : {0, 1}) {
            cases.insert(cases.end(), samples, c);
            wo.insert(wo.end(), samples, way == 0 ? a : b);
            wi.insert(wi.end(), samples, way == 0 ? b : a);
        }
    }
    const auto walks = walk(cases, wo, wi);
    double worst = 0;
    for (std::size_t k = 0; k < pairs; ++k) {
        std::array<verify::RunningStatistics, 2> f;
        for (std::size_t i = 0; i < 2 * samples; ++i) {
            const std::size_t at = 2 * samples * k + i;
            f[i / samples].add(walks[at][1].z / wi[at].z);
        }
        const double error = std::sqrt((f[0].variance() + f[1].variance()) / samples) + 1e-6 * f[0].mean();
        const double z = (f[0].mean() - f[1].mean()) / error;
        worst = std::max(worst, std::abs(z));
        EXPECT_LT(std::abs(z), 4.5) << k << ": " << f[0].mean() << " and " << f[1].mean() << ", tilt "
                                    << cases[2 * samples * k].x;
    }
    std::printf("%zu pairs of directions, |z| <= %.2f\n", pairs, worst);
}

/** Grazing views, no tilt, normals along the surface and under it: all finite, and out of the surface. */
TEST(FacetWalk, ExtremesAreFinite) {
    std::vector<glm::vec4> cases;
    std::vector<glm::vec3> wo, wi;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const double tilt : {0.0, 1e-7, 1e-5, 1e-3, 89.99, 90.0, 120.0, 180.0})
        for (const double alpha : {0.0, 1e-3, 1.0})
            for (const double out : {1e-7, 1e-3, 0.5, 1.0})
                for (const double in : {1e-7, 1e-3, 0.5, 1.0})
                    for (int i = 0; i < 64; ++i) {
                        cases.emplace_back(tilt * kPi / 180, 2 * kPi * uniform(random), alpha,
                                           uniform(random));
                        wo.push_back(directionOf(out, 2 * kPi * uniform(random)));
                        wi.push_back(directionOf(in, 2 * kPi * uniform(random)));
                    }
    const auto walks = walk(cases, wo, wi);
    for (std::size_t i = 0; i < walks.size(); ++i) {
        const glm::vec3 w = walks[i][0], v = walks[i][1];
        ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v.x >= 0 && v.y >= 0 &&
                    v.z >= 0)
            << cases[i].x << " " << cases[i].z << ": " << v.x << " " << v.y << " " << v.z;
        ASSERT_NEAR(glm::length(w), 1, 1e-5);
        ASSERT_TRUE(v.x == 0 || w.z >= 0);
        ASSERT_LE(v.x, 1.001);
    }
}

}  // namespace
}  // namespace helio::test
