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

}  // namespace
}  // namespace helio::test
