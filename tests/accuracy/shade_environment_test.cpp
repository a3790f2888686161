// Diffuse light of a latitude-longitude image in the raster pipeline, against closed forms.
#include "engine/scene/samples/shapes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;

/** A white Lambertian sphere under a sky of this radiance by direction, in the image's frame. */
Scene whiteSphere(std::uint32_t width, const std::function<double(const glm::dvec3&)>& radiance) {
    Scene scene;
    addRoot(scene, "sphere",
            addMesh(scene, "sphere", sphereShape(24, addMaterial(scene, diffuse("white", glm::vec3(1))))));
    addCamera(scene, {1.5f, 2.0f, 2.5f}, {0, 0, 0}, 40);
    TextureImage image{"sky", width, width / 2, std::vector<float>()};
    auto& texels = std::get<std::vector<float>>(image.texels);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double turn = 2 * kPi * (0.5 - (x + 0.5) / width), angle = kPi * (y + 0.5) / image.height;
            const auto value = float(radiance(
                {std::sin(angle) * std::sin(turn), std::cos(angle), std::sin(angle) * std::cos(turn)}));
            texels.insert(texels.end(), {value, value * 0.5f, value * 0.25f, 1.0f});
        }
    scene.images.push_back(std::move(image));
    scene.environment = Environment{glm::vec3(1.0f), 0};
    return scene;
}

/** Largest distance of what the sphere's pixels show from `reflected(normal)`, which is at most about 1. */
double worst(const Scene& scene, const std::function<double(const glm::dvec3&)>& reflected,
             const char* aa = "none") {
    static Renderer renderer(deviceOptions());
    RenderOptions options;
    options.size = {64, 64};
    options.pipeline = Pipeline::Raster;
    options.antialiasing = antialiasing(aa);
    const RenderResult result = renderer.render(scene, options);
    EXPECT_EQ(takeValidationMessages(), std::vector<std::string>());
    double largest = 0;
    int pixels = 0;
    const auto at = [&](const char* channel, std::size_t i) {
        const int c = result.image.channel(channel);
        return double(result.image.data[i * result.image.channels.size() + std::size_t(c)]);
    };
    for (std::size_t i = 0; i < 64 * 64; ++i) {
        const glm::dvec3 normal(at("normal.X", i), at("normal.Y", i), at("normal.Z", i));
        if (glm::length(normal) < 0.5) continue;
        ++pixels;
        const double truth = reflected(normal);
        largest = std::max({largest, std::abs(at("R", i) - truth), std::abs(at("B", i) * 4 - truth)});
    }
    EXPECT_GT(pixels, 500);
    return largest;
}

TEST(ShadeEnvironment, ConstantImageIsTheConstantEnvironment) {
    EXPECT_LT(
        worst(whiteSphere(16, [](const glm::dvec3&) { return 0.7; }), [](const glm::dvec3&) { return 0.7; }),
        2e-4);
}

TEST(ShadeEnvironment, GradientOfAnyDirection) {
    // Radiance 1/2 + (a.d)/2 reflects as 1/2 + (a.n)/3.
    for (const glm::dvec3 a :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(-0.6, 0, 0.8)}) {
        const double error =
            worst(whiteSphere(256, [&](const glm::dvec3& d) { return 0.5 + 0.5 * glm::dot(a, d); }),
                  [&](const glm::dvec3& n) { return 0.5 + glm::dot(a, n) / 3; });
        fmt::print("gradient along ({}, {}, {}): worst error {:.2e}\n", a.x, a.y, a.z, error);
        EXPECT_LT(error, 1.5e-3);
    }
}

TEST(ShadeEnvironment, SmallSunAtAnyHeight) {
    // A disc of 3 degrees that gives a facing surface irradiance pi: the reflection is the cosine.
    for (double height : {0.0, 0.3, 0.9}) {
        const double radius = 3 * kPi / 180;
        const glm::dvec3 sun =
            glm::normalize(glm::dvec3(std::cos(1.1) * std::sqrt(1 - height * height), height,
                                      std::sin(1.1) * std::sqrt(1 - height * height)));
        const double radiance = 1 / (std::sin(radius) * std::sin(radius));
        const double error = worst(
            whiteSphere(
                1024,
                [&](const glm::dvec3& d) { return glm::dot(sun, d) > std::cos(radius) ? radiance : 0.0; }),
            [&](const glm::dvec3& n) { return std::max(glm::dot(sun, n), 0.0); });
        fmt::print("sun at height {}: worst error {:.2e}\n", height, error);
        EXPECT_LT(error, 0.03);  // at the terminator, a step of the table wide
    }
}

TEST(ShadeEnvironment, TurnsWithTheRotation) {
    Scene scene = whiteSphere(256, [](const glm::dvec3& d) { return 0.5 + 0.5 * d.x; });
    scene.environment->rotation = glm::angleAxis(float(kPi / 2), glm::vec3(0, 1, 0));  // +X to -Z
    EXPECT_LT(worst(scene, [](const glm::dvec3& n) { return 0.5 - n.z / 3; }), 1.5e-3);
}

TEST(ShadeEnvironment, MultisamplingShadesAlike) {
    // Inside the sphere; pixels at its edge mix with the sky.
    const Scene scene = whiteSphere(16, [](const glm::dvec3&) { return 0.7; });
    EXPECT_LT(worst(
                  scene, [](const glm::dvec3&) { return 0.7; }, "msaa4"),
              2e-4);
}

/** A sphere of one material under a smooth sky with a broad sun, 512 x 256. */
Scene glossySphere(const Material& material, bool constant) {
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.6, 0.7, 0.5));
    Scene scene = whiteSphere(constant ? 4 : 512, [&](const glm::dvec3& d) {
        if (constant) return 0.8;
        const double disc = std::exp(40 * (glm::dot(sun, d) - 1));
        return 0.3 + 0.25 * d.y + 0.15 * std::sin(3 * d.x) + 6 * disc;
    });
    scene.materials[0] = material;
    return scene;
}

struct GlossError {
    double rms, bias;  ///< of the mean radiance over the sphere
};

/** Raster against the path tracer's direct light of the environment, over the sphere's inner pixels. */
GlossError glossError(const Scene& scene) {
    static Renderer renderer(deviceOptions());
    RenderOptions options;
    options.size = {32, 32};
    options.maxDepth = 1;
    options.samples = 128;
    const RenderResult path = renderer.render(scene, options);
    options.pipeline = Pipeline::Raster;
    options.maxDepth = -1;
    options.antialiasing = antialiasing("ssaa4");
    const RenderResult raster = renderer.render(scene, options);
    EXPECT_EQ(takeValidationMessages(), std::vector<std::string>());
    double squares = 0, sum = 0, mean = 0;
    int pixels = 0;
    const auto at = [](const RenderResult& r, const char* channel, std::size_t i) {
        return double(r.image.data[i * r.image.channels.size() + std::size_t(r.image.channel(channel))]);
    };
    for (std::size_t i = 0; i < 32 * 32; ++i) {
        const double x = double(i % 32) - 15.5, y = double(i / 32) - 15.5;
        if (std::hypot(x, y) > 12 || !(at(path, "depth.Z", i) > 0)) continue;
        ++pixels;
        for (const char* channel : {"R", "G", "B"}) {
            const double scale = channel[0] == 'R' ? 1 : channel[0] == 'G' ? 2 : 4;
            const double truth = scale * at(path, channel, i), got = scale * at(raster, channel, i);
            squares += (got - truth) * (got - truth);
            sum += got - truth;
            mean += truth;
        }
    }
    EXPECT_GT(pixels, 300);
    return {std::sqrt(squares / (3 * pixels)) / (mean / (3 * pixels)), sum / mean};
}

Material glossy(float metallic, float roughness) {
    Material material;
    material.baseColor = {0.9f, 0.6f, 0.3f, 1.0f};
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

TEST(ShadeEnvironment, GlossUnderAConstantSkyIsTheAlbedo) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.6f}) {
            const GlossError error = glossError(glossySphere(glossy(metallic, roughness), true));
            fmt::print("metallic {} roughness {}: bias {:+.4f}, RMS {:.4f} (noise of the paths in it)\n",
                       metallic, roughness, error.bias, error.rms);
            EXPECT_LT(std::abs(error.bias), 0.004);
            EXPECT_LT(error.rms, 0.02);
        }
}

TEST(ShadeEnvironment, SplitSumsAgainstPaths) {
    // What a split sum costs: the lobe's stretch at grazing angles is left out, most of all where it is wide.
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.1f, 0.3f, 0.6f}) {
            const GlossError error = glossError(glossySphere(glossy(metallic, roughness), false));
            fmt::print("metallic {} roughness {}: bias {:+.4f}, RMS {:.4f} of the mean\n", metallic,
                       roughness, error.bias, error.rms);
            EXPECT_LT(std::abs(error.bias), 0.06);
            EXPECT_LT(error.rms, 0.15);
        }
}

}  // namespace
}  // namespace helio::test
