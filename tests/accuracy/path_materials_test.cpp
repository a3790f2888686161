/** @file
 * Materials as the path tracer shows them, against closed forms and against the scattering library in double.
 * Plates side by side in one plane do not see each other: under a constant sky of radiance 1 each shows its
 * albedo.
 */
#include "engine/core/shared.hpp"
#include "tests/accuracy/plates.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;
/** Mean over the numbers that draw visible normals of a reflectance by cosine to the normal. */
double facetAlbedo(double cosine, glm::dvec2 alpha, const std::function<double(double)>& reflectance) {
    const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    constexpr int n = 384;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const glm::dvec3 h =
                shared64::ggxSampleNormal(wo, alpha, glm::dvec2((i + 0.5L) / n, (k + 0.5L) / n));
            const glm::dvec3 wi = shared64::reflectedAbout(wo, h);
            if (!(wi.z > 0)) continue;
            const double o = shared64::ggxStretch(wo, alpha), l = shared64::ggxStretch(wi, alpha);
            sum += reflectance(glm::dot(wo, h)) * wi.z * (wo.z + o) / (wi.z * o + wo.z * l);
        }
    return sum / (double(n) * n);
}
/** Bound of glTF's specular albedo: the fit of shaders/scattering/gltf.glsl, in double. */
double specularBound(double cosine, double alpha, double f0) {
    const double x = cosine, y = alpha;
    const double above = 0.9345L - 2.323L * x + 2.229L * y - 3.748L * x * y + 1.424L * x * x -
                         0.7684L * y * y + 1.436L * x * x * y + 0.2913L * x * y * y + 0.6286L * x * x * y * y;
    const double below = 1 + 0.2281L * x + 15.94L * y - 55.83L * x * y + 13.08L * x * x + 41.26L * y * y +
                         54.9L * x * x * y + 300.2L * x * y * y - 285.1L * x * x * y * y;
    const double grazing = std::max(1.035L * above / below, (1 - 10 * y) * std::pow(1 - x, 5.0L));
    return f0 + (1 - f0) * std::clamp(grazing, double(0), double(1));
}
/** Albedo of glTF's diffuse part: what the half vector's reflectance and the specular lobe's bounds from both
 * sides leave, over cosine-weighted directions. */
double diffuseAlbedo(double cosine, double f0, double alpha) {
    const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    constexpr int n = 256;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const glm::dvec3 wi = shared64::cosineHemisphere(glm::dvec2((i + 0.5L) / n, (k + 0.5L) / n));
            const glm::dvec3 h = glm::normalize(wo + wi);
            sum += 1 - std::max(shared64::fresnelSchlick(f0, double(1), glm::dot(wo, h)),
                                specularBound(std::min(wo.z, wi.z), alpha, f0));
        }
    return sum / (double(n) * n);
}

TEST(GltfMaterials, PlatesShowTheirAlbedo) {
    Plates p;
    const float env = 1;
    p.add("default: rough white metal", Material{});
    p.add("metal", gltf({0.9f, 0.5f, 0.1f}, 1, 0.5f));
    p.add("mirror-like metal", gltf(glm::vec3(0.8f), 1, 0));
    p.add("plastic", gltf({0.6f, 0.6f, 0.6f}, 0, 0.4f));
    p.add("smooth plastic", gltf(glm::vec3(0.6f), 0, 0));
    Material lambert = gltf(glm::vec3(0.7f), 0, 1);
    lambert.specular = 0;
    p.add("Lambert", lambert);
    Material glow = gltf(glm::vec3(0.25f), 0, 1);
    glow.unlit = true;
    p.add("unlit", glow);
    Material brushed = gltf(glm::vec3(1), 1, 0.3f);
    brushed.anisotropyStrength = 0.8f;
    brushed.anisotropyRotation = 0.6f;
    p.add("brushed", brushed);
    Material pane = gltf(glm::vec3(0.5f), 0, 0);
    pane.transmission = 1;
    p.add("pane", pane);
    Material frosted = pane;
    frosted.roughness = 0.5f;
    p.add("frosted pane", frosted);
    p.b.scene.environment = Environment{glm::vec3(env), -1};
    p.view(50);
    const Traced image = p.render(256);
    EXPECT_EQ(image.rejected, 0u);
    const double c = std::cos(50 * kPi / 180);
    const auto schlick = [](double f0) {
        return [=](double cosine) { return shared64::fresnelSchlick(f0, double(1), cosine); };
    };
    const auto one = [](double) { return double(1); };
    const glm::dvec2 a04(0.16L), a05(0.25L);
    expectMean(plate(image, 0), facetAlbedo(c, glm::dvec2(1), one), 4e-3L, p.names[0]);
    for (int channel = 0; channel < 3; ++channel) {
        const double f0 = double(std::array{0.9f, 0.5f, 0.1f}[std::size_t(channel)]);
        expectMean(plate(image, 1, channel), facetAlbedo(c, a05, schlick(f0)), 4e-3L, p.names[1]);
    }
    expectMean(plate(image, 2), shared64::fresnelSchlick(double(0.8f), double(1), c), 1e-4L, p.names[2]);
    const double base = double(0.6f), f0 = 0.04L;
    expectMean(plate(image, 3), facetAlbedo(c, a04, schlick(f0)) + base * diffuseAlbedo(c, f0, a04.x), 4e-3L,
               p.names[3]);
    expectMean(plate(image, 4), shared64::fresnelSchlick(f0, double(1), c) + base * diffuseAlbedo(c, f0, 0),
               4e-3L, p.names[4]);
    expectMean(plate(image, 5), double(0.7f), 1e-4L, p.names[5]);
    expectMean(plate(image, 6), 0.25L, 1e-6L, p.names[6]);
    // The azimuth between the view and the turned tangent.
    const double s = std::sqrt(1 - c * c), turned = double(0.6f);
    const double wide = double(0.09f) + (1 - double(0.09f)) * double(0.8f) * double(0.8f);
    const glm::dvec3 wo(-s * std::sin(turned), -s * std::cos(turned), c);
    double sum = 0;
    constexpr int n = 384;
    const glm::dvec2 alpha(wide, double(0.09f));
    for (int i = 0; i < n * n; ++i) {
        const glm::dvec3 h =
            shared64::ggxSampleNormal(wo, alpha, glm::dvec2((i / n + 0.5L) / n, (i % n + 0.5L) / n));
        const glm::dvec3 wi = shared64::reflectedAbout(wo, h);
        const double o = shared64::ggxStretch(wo, alpha), l = shared64::ggxStretch(wi, alpha);
        if (wi.z > 0) sum += wi.z * (wo.z + o) / (wi.z * o + wo.z * l);
    }
    expectMean(plate(image, 7), sum / (n * n), 4e-3L, p.names[7]);
    const double r = shared64::fresnelSchlick(f0, double(1), c);
    expectMean(plate(image, 8), r + (1 - r) * 0.5L, 4e-3L, p.names[8]);
    // What goes through a frosted one is half of what its facets do not reflect.
    const double through = facetAlbedo(c, a05, one) - facetAlbedo(c, a05, schlick(f0));
    expectMean(plate(image, 9), facetAlbedo(c, a05, schlick(f0)) + 0.5L * through, 4e-3L, p.names[9]);
}

TEST(GltfMaterials, DefaultMaterialFromAboveIsOneMinusLnTwo) {
    Plates p;
    p.add("default", Material{});
    p.b.scene.environment = Environment{glm::vec3(1), -1};
    p.view(0);
    expectMean(plate(p.render(1024), 0), 1 - std::numbers::ln2, 4e-3L, "default");
}

/** A smooth coat over black reflects by the angle to its own normal, which a map tilts across the view: 60
 * degrees to the plate's normal are 64 to one that leans by 30. */
TEST(GltfMaterials, CoatsHaveANormalOfTheirOwn) {
    Plates p;
    Material coated = gltf(glm::vec3(0), 0, 1);
    coated.specular = 0;
    coated.clearcoat = 1;
    p.add("coat", coated);
    Scene& scene = p.b.scene;
    scene.images.push_back({"tilt", 1, 1, std::vector<float>{0.75f, 0.5f, 0.5f + std::sqrt(0.1875f), 1}});
    Texture tilt;
    tilt.image = 0;
    scene.textures.push_back(tilt);
    coated.clearcoatNormalTexture.texture = 0;
    p.add("coat that leans by 30 degrees", coated);
    scene.environment = Environment{glm::vec3(1), -1};
    p.view(60);
    const Traced image = p.render(1024);
    const auto reflected = [](double cosine) { return 0.04L + 0.96L * std::pow(1 - cosine, 5); };
    expectMean(plate(image, 0), reflected(0.5L), 3e-3L, p.names[0]);
    expectMean(plate(image, 1), reflected(0.5L * std::sqrt(0.75L)), 3e-3L, p.names[1]);
}

/** What loses no light is invisible: smooth and rough glass, mirrors, made-up facets, tilted normals. */
TEST(Furnace, LosslessMaterialsVanish) {
    Plates p;
    p.add("mirror", model(Scattering::Model::Mirror));
    p.add("pane", model(Scattering::Model::ThinDielectric));
    Material facets = model(Scattering::Model::Conductor);
    facets.scattering->n = glm::vec3(0.01f);
    facets.scattering->k = glm::vec3(100);
    facets.scattering->multipleScattering = true;
    for (float alpha : {0.2f, 0.6f, 1.0f}) {
        facets.scattering->alpha = glm::vec2(alpha);
        p.add("facets " + std::to_string(alpha), facets);
    }
    p.add("blinn", model(Scattering::Model::BlinnPhong));
    Material oren = model(Scattering::Model::OrenNayar);
    oren.scattering->roughness = 0.8f;
    p.add("oren", oren);
    // A map tilted by 53 degrees along the tangent.
    Scene& scene = p.b.scene;
    scene.images.push_back({"tilt", 1, 1, std::vector<float>{0.9f, 0.5f, 0.8f, 1}});
    Texture tilt;
    tilt.image = 0;
    scene.textures.push_back(tilt);
    Material tilted = gltf(glm::vec3(1), 0, 1);
    tilted.specular = 0;
    tilted.normalTexture.texture = 0;
    p.add("tilted Lambert", tilted);
    scene.environment = Environment{glm::vec3(1), -1};
    for (double angle : {0.0L, 60.0L, 80.0L}) {
        Plates seen = p;
        seen.view(angle);
        const Traced image = seen.render(256);
        EXPECT_EQ(image.rejected, 0u);
        for (std::size_t i : {0u, 1u, 7u}) expectMean(plate(image, i), 1, 1e-4L, p.names[i]);
        for (std::size_t i : {2u, 3u, 4u}) {
            const Estimate e = plate(image, i);
            EXPECT_NEAR(e.mean, 1, 1e-3L + 4 * e.error) << p.names[i] << " at " << angle;
            EXPECT_LT(e.error, 6e-3L);
        }
        if (angle == 0) {
            expectMean(plate(image, 6), 1 / (1 + (0.5L - 2 / (3 * kPi)) * double(0.8f)), 1e-4L, "oren");
            Estimate e = plate(image, 5);  // exponent 0
            EXPECT_NEAR(e.mean, 1, 4 * e.error);
        }
    }
}

/** Glass spheres, faceted: light goes round inside, all of it gets out. */
TEST(Furnace, GlassSpheresVanish) {
    for (bool frosted : {false, true}) {
        SceneBuilder b;
        Material glass;
        if (frosted) {
            // What facets lose is made up for on both sides.
            glass = model(Scattering::Model::Dielectric);
            glass.scattering->alpha = glm::vec2(0.5f);
            glass.scattering->multipleScattering = true;
        } else {
            glass = gltf(glm::vec3(1), 0, 0);
            glass.transmission = 1;
            glass.thickness = 1;
        }
        b.scene.materials.push_back(glass);
        b.sphere({0, 0, 0}, 1, 3, false, 0);
        b.scene.environment = Environment{glm::vec3(1), -1};
        b.camera({0, 0, 6}, {0, 0, 0}, 0.4f);
        PathTraceOptions options;
        options.size = {24, 24};
        options.sampler = SamplerKind::Independent;
        const Traced image = trace(b.scene, options, 64);
        EXPECT_EQ(image.rejected, 0u);
        expectMean(estimate(image, 0, [](std::size_t) { return true; }), 1, frosted ? 6e-3L : 2e-3L,
                   frosted ? "frosted" : "glTF");
    }
}

/** A slab of glass before a lamp of radiance 1: (1 - R)/(1 + R) from above; and what absorption leaves. */
TEST(Glass, SlabLetsThroughWhatTheSeriesSays) {
    for (bool absorbs : {false, true}) {
        SceneBuilder b;
        Material glass = gltf(glm::vec3(1), 0, 0);
        glass.transmission = 1;
        glass.thickness = 1;
        if (absorbs) {
            glass.ior = 1.0f;
            glass.attenuationDistance = 0.5f;
            glass.attenuationColor = {0.25f, 0.5f, 1.0f};
        }
        b.scene.materials.push_back(glass);
        b.quad({-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}, 0);  // towards the camera
        b.quad({-2, -2, 0}, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0}, 0);  // away from it
        const int lamp = b.material({0, 0, 0}, {1, 1, 1});
        b.quad({-90, -90, -1}, {90, -90, -1}, {90, 90, -1}, {-90, 90, -1}, lamp);
        b.camera({0, 0, 50}, {0, 0, 0}, 0.01f);
        PathTraceOptions options;
        options.size = {16, 16};
        options.sampler = SamplerKind::Independent;
        const Traced image = trace(b.scene, options, 256);
        for (int channel = 0; channel < 3; ++channel) {
            const Estimate e = estimate(image, channel, [](std::size_t) { return true; });
            const double left =
                absorbs ? std::pow(double(glass.attenuationColor[channel]), 2.0L) : 0.923076923L;
            expectMean(e, left, 2e-3L, absorbs ? "absorbing" : "clear");
        }
    }
}

/** Seen from under water the sky is in a cone of 97.2133 degrees, at n^2 of its radiance but for reflection.
 */
TEST(Glass, SnellsWindow) {
    SceneBuilder b;
    Material water = model(Scattering::Model::Dielectric);
    water.scattering->n = glm::vec3(1.333f);
    b.scene.materials.push_back(water);
    const float far = 1000;
    b.quad({-far, 0, far}, {far, 0, far}, {far, 0, -far}, {-far, 0, -far}, 0);
    const int bottom = b.material(glm::vec3(0));
    b.quad({-far, -50, far}, {-far, -50, -far}, {far, -50, -far}, {far, -50, far}, bottom);
    b.scene.environment = Environment{glm::vec3(1), -1};
    const float fov = 2.2f;
    b.camera({0, -10, 0}, {0, 0, 0}, fov, {0, 0, 1});
    PathTraceOptions options;
    options.size = {1, 2048};
    options.maxDepth = 4;
    const Traced image = trace(b.scene, options, 64);
    std::size_t first = image.height, last = 0;
    for (std::size_t y = 0; y < image.height; ++y)
        if (image.mean[y].x > 0) {
            first = std::min(first, y);
            last = y;
        }
    const auto angle = [&](double row) {
        return std::atan((1 - 2 * row / image.height) * std::tan(double(fov) / 2)) * 180 / kPi;
    };
    EXPECT_NEAR(angle(double(first)) - angle(double(last + 1)), 97.213252783L, 0.1L);
    const double r = shared64::fresnelDielectric(double(1), 1 / double(1.333f));
    EXPECT_NEAR(image.mean[image.height / 2].x, (1 - r) * double(1.333f) * double(1.333f), 0.1L);
}

/** Alpha: a blended plate shows itself by alpha and what is behind by the rest, a mask all or nothing; both
 * weaken a lamp's light likewise. */
TEST(Alpha, BlendsMasksAndShadows) {
    Plates p;
    Material veil = gltf(glm::vec3(0), 0, 1);
    veil.specular = 0;
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor = {0, 0, 0, 0.25f};
    p.add("veil", veil);
    Material hole = veil;
    hole.alphaMode = AlphaMode::Mask;
    p.add("hole", hole);
    hole.alphaCutoff = 0.2f;
    p.add("solid", hole);
    p.b.scene.environment = Environment{glm::vec3(1), -1};
    p.view(20);
    const Traced image = p.render(512);
    expectMean(plate(image, 0), 0.75L, 6e-3L, "veil");
    expectMean(plate(image, 1), 1, 1e-6L, "hole");
    expectMean(plate(image, 2), 0, 1e-6L, "solid");
    EXPECT_EQ(image.hits.instance[kPlate / 2 * image.width + 4], 0);
    EXPECT_EQ(image.hits.instance[kPlate / 2 * image.width + kPlate + 4], -1);
    EXPECT_EQ(image.hits.instance[kPlate / 2 * image.width + 2 * kPlate + 4], 2);

    // A lamp over a floor through two veils of 0.25: 0.75^2 of its light.
    SceneBuilder b;
    const int white = b.material(glm::vec3(1));
    b.quad({-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}, white);
    b.scene.materials.push_back(veil);
    for (float y : {1.0f, 2.0f}) b.quad({-3, y, 3}, {3, y, 3}, {3, y, -3}, {-3, y, -3}, 1);
    b.pointLight({0, 4, 0}, glm::vec3(16));
    b.camera({12, 1, 0}, {0, 0, 0}, 0.001f);
    PathTraceOptions options;
    options.size = {8, 8};
    options.sampler = SamplerKind::Independent;
    options.maxDepth = 1;
    const Traced lit = trace(b.scene, options, 64);
    const Estimate e = estimate(lit, 0, [](std::size_t) { return true; });
    EXPECT_NEAR(e.mean, 0.75L * 0.75L / kPi, 2e-4L);
}

/** A lamp that alpha makes half transparent gives as much less, whether it is sampled or met by chance, its
 * alpha being a factor and a texture, blended or a mask. */
TEST(Alpha, LampsAreWeakenedAlikeBothWays) {
    for (bool isMask : {false, true}) {
        SceneBuilder b;
        const int white = b.material(glm::vec3(1));
        b.quad({-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}, white);
        Material lamp = gltf(glm::vec3(0), 0, 1);
        lamp.specular = 0;
        lamp.emission = glm::vec3(2);
        lamp.doubleSided = true;
        lamp.alphaMode = isMask ? AlphaMode::Mask : AlphaMode::Blend;
        lamp.baseColor.a = 0.75f;
        // A hard edge along the middle.
        b.scene.images.push_back({"alpha", 2, 1, std::vector<float>{1, 1, 1, 0.125f, 1, 1, 1, 0.75f}});
        Texture t;
        t.image = 0;
        t.magFilter = Filter::Nearest;
        b.scene.textures.push_back(t);
        lamp.baseColorTexture.texture = 0;
        b.scene.materials.push_back(lamp);
        const int instance = b.quad({-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}, 1);
        b.scene.meshes[std::size_t(instance)].primitives[0].texcoords = {
            {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}}};
        b.camera({0, 1, 12}, {0, 0, 0}, 0.001f);
        PathTraceOptions options;
        options.size = {8, 8};
        options.sampler = SamplerKind::Independent;
        options.maxDepth = 1;
        const auto all = [](std::size_t) { return true; };
        const Estimate sampled = estimate(trace(b.scene, options, 256), 0, all);
        options.nextEventEstimation = false;
        const Estimate chance = estimate(trace(b.scene, options, 1024), 0, all);
        // Four corners of a unit square at height 2: E = L * form factor * pi, white floor.
        const double a = 0.5L, r = std::sqrt(1 + a * a);
        const double factor = 4 * (2 * a / r * std::atan(a / r)) / (2 * kPi);
        const double share = isMask ? 0.5 : 0.75 * 0.4375;
        const double truth = 2 * factor * share;
        EXPECT_LT(std::abs(sampled.mean - truth), 4 * sampled.error)
            << isMask << ": " << sampled.mean << " +- " << sampled.error << ", not " << truth;
        EXPECT_LT(std::abs(chance.mean - truth), 4 * chance.error)
            << isMask << ": " << chance.mean << " +- " << chance.error << ", not " << truth;
        EXPECT_LT(std::max(sampled.error, chance.error), 0.02L * truth);
    }
}

/** Sampling lamps, and leaving them to chance, give one picture for every material. */
TEST(NextEvent, AgreesWithChanceForEveryMaterial) {
    Plates p;
    p.add("metal", gltf({0.9f, 0.7f, 0.3f}, 1, 0.3f));
    p.add("plastic", gltf(glm::vec3(0.5f), 0, 0.5f));
    Material coated = gltf(glm::vec3(0.5f), 0.5f, 0.8f);
    coated.clearcoat = 1;
    coated.clearcoatRoughness = 0.3f;
    p.add("coated", coated);
    Material cloth = gltf(glm::vec3(0.3f), 0, 0.9f);
    cloth.sheenColor = {0.8f, 0.5f, 0.2f};
    cloth.sheenRoughness = 0.5f;
    p.add("cloth", cloth);
    Material film = gltf(glm::vec3(0.6f), 1, 0.4f);
    film.iridescence = 1;
    p.add("film", film);
    Material pane = gltf(glm::vec3(0.8f), 0, 0.5f);
    pane.transmission = 1;
    p.add("frosted pane", pane);
    for (Scattering::Model kind : {Scattering::Model::OrenNayar, Scattering::Model::Conductor,
                                   Scattering::Model::Phong, Scattering::Model::Dielectric}) {
        Material m = model(kind);
        m.scattering->alpha = glm::vec2(0.3f);
        m.scattering->roughness = 0.5f;
        m.scattering->exponent = 20;
        m.scattering->beckmann = kind == Scattering::Model::Conductor;
        p.add("model " + std::to_string(int(kind)), m);
    }
    // Lamps on both sides; their own light that plates reflect to each other is in both pictures.
    const int lamp = p.b.material(glm::vec3(0), glm::vec3(3), true);
    p.b.quad({-2, 4, 3}, {12, 4, 3}, {12, 1, 5}, {-2, 1, 5}, lamp);
    p.b.quad({-2, 4, -3}, {12, 4, -3}, {12, 1, -5}, {-2, 1, -5}, lamp);
    p.view(35);
    const Traced sampled = p.render(256), chance = p.render(1024, false);
    for (std::size_t i = 0; i < p.names.size(); ++i)
        for (int channel : {0, 2}) {
            const Estimate a = plate(sampled, i, channel), c = plate(chance, i, channel);
            const double z = (a.mean - c.mean) / std::hypot(a.error, c.error);
            EXPECT_LT(std::abs(z), 4) << p.names[i] << ": " << a.mean << " +- " << a.error << " and "
                                      << c.mean << " +- " << c.error;
            EXPECT_LT(c.error, 0.05L * c.mean + 2e-3L) << p.names[i];
        }
}

}  // namespace
}  // namespace helio::test
