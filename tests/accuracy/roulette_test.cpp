// Russian roulette: the same mean at every chance, with the variance and the cost that theory gives.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace helio::test {
namespace {

constexpr float kAlbedo = 0.25f;

/** A closed room that emits 1. */
Scene furnace() {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(kAlbedo), glm::vec3(1.0f));
    b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
    b.camera({0.1f, 0.2f, 0.3f}, {0.4f, 0.1f, -1}, 1.2f);
    return b.scene;
}

/** A room of mirrors in which paths are reflected 190 times between two walls until they meet a glowing one:
 * from the middle to where they lie 380 half distances of the walls further, for 1.9 along them. */
constexpr int kReflections = 190;
Scene hallOfMirrors() {
    SceneBuilder b;
    const int mirror = b.material(glm::vec3(1.0f)), glow = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
    b.scene.materials[std::size_t(mirror)].scattering = Scattering{.model = Scattering::Model::Mirror};
    b.room({-1, -1, -1}, {1, 1, 1}, {mirror, mirror, mirror, mirror, glow, mirror});
    b.camera({0, 0, 0.9f}, {1, 0, 0.9f - 1.9f / (2 * kReflections)}, 2e-6f);
    return b.scene;
}

struct Measured {
    double mean = 0, error = 0;
    double variance = 0;  ///< of one path
    double bounces = 0;   ///< rays of a path after the camera's
};
Measured measure(const std::function<void(RenderOptions&)>& set, std::uint32_t samples = 4096,
                 const Scene& scene = furnace()) {
    RenderOptions o;
    o.size = {16, 16};
    o.samples = samples;
    o.sampler = SamplerKind::Independent;
    o.nextEventEstimation = false;
    set(o);
    const RenderResult result = renderer().render(scene, o);
    Measured m;
    const auto c = std::size_t(result.image.channel("variance.R"));
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            m.mean += double(result.image.at(x, y, 0)) / 256;
            m.variance += double(result.image.at(x, y, c)) / 256 * o.samples;
        }
    m.error = std::sqrt(m.variance / (256.0 * o.samples));
    m.bounces = double(result.rays.bounce) / double(result.rays.camera);
    return m;
}

/** With a fixed chance P, light of a path in a furnace of albedo a is X = 1 + a Y, Y the sum of (a / P)^k
 * over k from 0 to N, and N at least k with the chance P^k: E X = 1 / (1 - a), E Y^2 the sum of (a / P)^(j +
 * k) P^max(j, k). The first scattering is spared, so that 1 + P + P^2 + ... rays follow the camera's. */
TEST(Roulette, FixedChancesHaveTheMeanTheVarianceAndTheCostOfTheory) {
    const double a = double(kAlbedo);
    for (const double chance : {0.2, 0.5, 0.9}) {
        double squares = 0;
        for (int j = 0; j < 300; ++j)
            for (int k = 0; k < 300; ++k)
                squares += std::pow(a / chance, j + k) * std::pow(chance, std::max(j, k));
        const double variance = a * a * (squares - 1 / ((1 - a) * (1 - a)));
        const Measured m = measure([&](RenderOptions& o) { o.survival = chance; });
        const double z = (m.mean - 1 / (1 - a)) / m.error;
        fmt::print(
            "chance {}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}; variance {:.5f}, theory {:.5f}; {:.4f} "
            "bounces, theory {:.4f}\n",
            chance, m.mean, m.error, 1 / (1 - a), z, m.variance, variance, m.bounces, 1 / (1 - chance));
        EXPECT_LT(std::abs(z), 4.0);
        EXPECT_LT(m.error, 0.001);
        EXPECT_NEAR(m.variance / variance, 1.0, 0.03);
        EXPECT_NEAR(m.bounces * (1 - chance), 1.0, 0.01);
    }
}

/** By throughput: the constant changes the noise and the rays, not the mean; one so large that nothing ends
 * within the depth leaves no noise at all. */
TEST(Roulette, ConstantsChangeNoMean) {
    const double truth = 1 / (1 - double(kAlbedo));
    double rays = 0;
    for (const double constant : {0.5, 1.0, 3.0, 30.0}) {
        const Measured m = measure([&](RenderOptions& o) { o.roulette = constant; }, 1024);
        const double z = (m.mean - truth) / m.error;
        fmt::print("constant {}: {:.6f} +- {:.6f}, z {:+.2f}, {:.4f} bounces\n", constant, m.mean, m.error, z,
                   m.bounces);
        EXPECT_LT(std::abs(z), 4.0);
        EXPECT_GT(m.bounces, rays);
        rays = m.bounces;
    }
    const Measured all = measure([](RenderOptions& o) { o.roulette = 1e9, o.maxDepth = 8; }, 16);
    EXPECT_NEAR(all.mean, truth * (1 - std::pow(double(kAlbedo), 9)), 1e-6);
    EXPECT_LT(all.variance, 1e-12);
    EXPECT_EQ(all.bounces, 8.0);
    EXPECT_THROW(measure([](RenderOptions& o) { o.survival = 1.5; }), InputError);
    EXPECT_THROW(measure([](RenderOptions& o) { o.roulette = 0; }), InputError);
}

/** Throughput does not fall between mirrors: past 64 scatterings one path in a hundred ends at each, and the
 * others stand for it. A path reaches the lamp with the chance p = .99^126 and brings 1 / p; the scatterings
 * of one are 64 and the sum of .99^k over k from 1 to 126. */
TEST(Roulette, PathsBetweenMirrorsEndAndLoseNothing) {
    const double reaches = std::pow(0.99, kReflections - 64);
    const double bounces = 64 + 0.99 * (1 - reaches) / 0.01, variance = 1 / reaches - 1;
    const Measured m = measure([](RenderOptions&) {}, 256, hallOfMirrors());
    const double z = (m.mean - 1) / m.error;
    fmt::print(
        "mirrors: {:.4f} +- {:.4f}, z {:+.2f}; variance {:.3f}, theory {:.3f}; {:.2f} bounces, theory "
        "{:.2f}\n",
        m.mean, m.error, z, m.variance, variance, m.bounces, bounces);
    EXPECT_LT(std::abs(z), 4.0);
    EXPECT_NEAR(m.variance / variance, 1.0, 0.05);
    EXPECT_NEAR(m.bounces, bounces, 1.0);  // standard error .2
    // A chance that is given holds alone.
    const Measured all = measure([](RenderOptions& o) { o.survival = 1; }, 4, hallOfMirrors());
    EXPECT_EQ(all.bounces, double(kReflections));
    EXPECT_NEAR(all.mean, 1.0, 1e-6);
}

}  // namespace
}  // namespace helio::test
