// The denoiser on pictures whose truth is known, and on renders.
#include "passes/denoise/denoise.hpp"

#include "tests/support/device.hpp"
#include "tests/support/error_scenes.hpp"
#include "tests/support/scene_films.hpp"

#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <random>

namespace helio::test {
namespace {

using Truth = std::function<double(std::uint32_t x, std::uint32_t y)>;

/** A film of 16 samples per pixel of normal noise, and the guides of a wall that fills the picture. */
struct Picture {
    FilmImages film;
    DenoiseGuides guides;
    std::vector<double> truth;

    Picture(std::uint32_t size, const Truth& brightness, double noise) {
        const std::size_t floats = std::size_t(size) * size * 4;
        film = {size, size, std::vector<float>(floats), std::vector<float>(floats),
                std::vector<float>(floats)};
        std::mt19937 random(7);
        std::normal_distribution<> normal;
        for (std::size_t pixel = 0; pixel < floats / 4; ++pixel) {
            truth.push_back(brightness(std::uint32_t(pixel % size), std::uint32_t(pixel / size)));
            const double a = noise * normal(random) / std::sqrt(8.0),
                         b = noise * normal(random) / std::sqrt(8.0);
            for (std::size_t c = 0; c < 3; ++c) {
                film.mean[4 * pixel + c] = float(truth.back() + 0.5 * (a + b));
                film.difference[4 * pixel + c] = float(0.5 * (a - b));
                film.variance[4 * pixel + c] = float(noise * noise / 16);
            }
            film.mean[4 * pixel + 3] = 16;
            film.difference[4 * pixel + 3] = 1;
            guides.geometry.emplace_back(0, 0, 1, 5);
            guides.albedo.emplace_back(0.5f, 0.5f, 0.5f, 1);
        }
    }
    double error(const std::function<double(std::size_t)>& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const double e = value(i) - truth[i];
            sum += e * e / (truth[i] * truth[i] + 0.01) / double(truth.size());
        }
        return sum;
    }
    double errorBefore() const {
        return error([&](std::size_t i) { return double(film.mean[4 * i]); });
    }
    double errorOf(const Denoised& denoised) const {
        return error([&](std::size_t i) { return double(denoised.picture[i].x); });
    }
};

Denoised filtered(const Picture& picture) {
    return denoise(device(), picture.film, picture.guides, estimateError(picture.film));
}

TEST(Denoise, AConstantStaysToTheLastBit) {
    const Picture picture(
        37, [](auto, auto) { return 0.1; }, 0);
    const Denoised denoised = filtered(picture);
    for (const glm::vec4& pixel : denoised.picture) EXPECT_EQ(pixel.x, float(0.1));
    EXPECT_EQ(denoised.error.relmse, 0);
}

TEST(Denoise, NoiseFallsTheMeanStaysAndTheErrorIsMeasured) {
    const Picture picture(
        64, [](std::uint32_t x, std::uint32_t) { return 0.5 + 0.005 * x; }, 0.4);
    const Denoised denoised = filtered(picture);
    EXPECT_LT(picture.errorOf(denoised), 0.2 * picture.errorBefore());
    double mean = 0, before = 0;
    for (std::size_t i = 0; i < picture.truth.size(); ++i) {
        mean += denoised.picture[i].x;
        before += picture.film.mean[4 * i];
    }
    EXPECT_NEAR(mean / before, 1, 2e-3);
    EXPECT_NEAR(denoised.undenoised / picture.errorBefore(), 1, 0.1);
    // Of about 4096 pixels' differences, each of the variance before.
    EXPECT_NEAR(denoised.error.relmse, picture.errorOf(denoised), 0.1 * picture.errorBefore());
}

TEST(Denoise, TheMeasureIsTrueWhereFewSamplesTellTheNoise) {
    // Four samples a pixel, whose variance is their own: a filter that opened where the halves happen to
    // differ would be measured as better than it is.
    constexpr std::size_t size = 192, half = 2;
    Picture picture(
        std::uint32_t(size), [](auto, auto) { return 1.0; }, 0.1);
    std::mt19937 random(11);
    std::normal_distribution<> normal(1.0, 0.1);
    for (std::size_t i = 0; i < 4 * size * size; i += 4)
        for (std::size_t c = i; c < i + 3; ++c) {
            double sum = 0, squares = 0, difference = 0;
            for (std::size_t k = 0; k < 2 * half; ++k) {
                const double x = normal(random);
                sum += x;
                squares += x * x;
                difference += (k % 2 == 0 ? x : -x) / (2.0 * half);
            }
            constexpr double n = 2 * half;
            picture.film.mean[c] = float(sum / n);
            picture.film.mean[i + 3] = float(n);
            picture.film.difference[c] = float(difference);
            picture.film.variance[c] = float((squares - sum * sum / n) / (n * (n - 1)));
        }
    const Denoised denoised = filtered(picture);
    double truth = 0;
    for (const glm::vec4& pixel : denoised.picture)
        for (const float x : {pixel.x, pixel.y, pixel.z})
            truth += (x - 1) * (x - 1) / 1.01 / double(3 * size * size);
    printf("four samples: relMSE %.4g, denoised %.4g, measured %.4g (%.4g to %.4g)\n", denoised.undenoised,
           truth, denoised.error.relmse, denoised.error.low, denoised.error.high);
    EXPECT_LT(truth, 0.2 * denoised.undenoised);
    EXPECT_NEAR((denoised.error.relmse - truth) / denoised.undenoised, 0, 0.012);
    // Less than 8 samples; and were they enough, the interval is as wide as the error.
    EXPECT_FALSE(denoised.error.reliable);
    EXPECT_FALSE(denoise(device(), picture.film, picture.guides, {.reliable = true}).error.reliable);
}

TEST(Denoise, AnEdgeIsKept) {
    const Picture picture(
        64, [](std::uint32_t x, std::uint32_t) { return x < 32 ? 1.0 : 0.2; }, 0.2);
    const Denoised denoised = filtered(picture);
    double left = 0, right = 0;
    for (std::size_t y = 0; y < 64; ++y) {
        left += denoised.picture[64 * y + 31].x / 64;
        right += denoised.picture[64 * y + 32].x / 64;
    }
    EXPECT_NEAR(left, 1.0, 0.02);
    EXPECT_NEAR(right, 0.2, 0.02);
    EXPECT_LT(picture.errorOf(denoised), 0.3 * picture.errorBefore());
}

TEST(Denoise, NormalsKeepAnEdgeThatNoiseHides) {
    Picture picture(
        64, [](std::uint32_t x, std::uint32_t) { return x < 32 ? 0.5 : 0.6; }, 0.8);
    for (std::size_t i = 0; i < picture.guides.geometry.size(); ++i)
        if (i % 64 >= 32) picture.guides.geometry[i] = {1, 0, 0, 5};
    const Denoised denoised = filtered(picture);
    double step = 0;
    for (std::size_t y = 0; y < 64; ++y)
        for (std::size_t x = 0; x < 4; ++x)
            step += double(denoised.picture[64 * y + 32 + x].x - denoised.picture[64 * y + 31 - x].x) / 256;
    // Without the normals the filter, which reaches 62 pixels far, leaves a third of it.
    EXPECT_NEAR(step, 0.1, 0.035);
}

TEST(Denoise, LeavesWhatItWouldHarm) {
    // A texture that no guide shows, its contrast below the noise of a half: the filter takes it for noise.
    const Picture picture(
        64, [](std::uint32_t x, std::uint32_t y) { return (x + y) % 2 == 0 ? 1.3 : 0.7; }, 0.8);
    const Denoised denoised = filtered(picture);
    EXPECT_LT(picture.errorOf(denoised), 1.02 * picture.errorBefore());
    const Picture fine(
        64, [](std::uint32_t x, std::uint32_t y) { return (x + y) % 2 == 0 ? 1.1 : 0.9; }, 0.1);
    const Denoised left = filtered(fine);
    EXPECT_LT(fine.errorOf(left), 1.02 * fine.errorBefore());
    // What is left as it was is measured as well as the picture before, and believed where that is.
    EXPECT_TRUE(left.error.reliable);
    EXPECT_LT(left.error.low, fine.errorOf(left));
    EXPECT_GT(left.error.high, fine.errorOf(left));
    EXPECT_FALSE(denoise(device(), fine.film, fine.guides, {.reliable = false}).error.reliable);
}

TEST(Denoise, WhatIsNotFiniteDoesNotSpread) {
    Picture picture(
        32, [](auto, auto) { return 0.5; }, 0.2);
    picture.film.mean[4 * 100] = NAN;
    picture.film.variance[4 * 300 + 1] = INFINITY;
    picture.film.difference[4 * 500 + 2] = NAN;
    picture.film.mean[4 * 700] = INFINITY;
    const Denoised denoised = filtered(picture);
    EXPECT_TRUE(std::isfinite(denoised.error.relmse));
    for (std::size_t i = 0; i < denoised.picture.size(); ++i) {
        if (i == 100 || i == 700) continue;
        EXPECT_NEAR(denoised.picture[i].x, 0.5, 0.3) << i;
        EXPECT_TRUE(std::isfinite(denoised.picture[i].y) && std::isfinite(denoised.picture[i].z)) << i;
    }
}

class DenoiseScene : public testing::TestWithParam<const char*> {};

TEST_P(DenoiseScene, EveryPictureComesNearerToTheTruthAndTheErrorIsMeasured) {
    constexpr int seeds = 3;
    const std::string name = GetParam();
    SceneFilms films(device(), errorScene(name), {32, 32});
    MeanImage mean;
    mean.add(films.render(1024, 1000));
    const std::vector<double> truth = mean.mean();
    for (const std::uint32_t samples : {4u, 16u, 64u}) {
        double before = 0, after = 0, measured = 0;
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            const FilmImages film = films.render(samples, seed);
            const Denoised denoised = films.denoised(film);
            const double plain = relativeError(film, truth),
                         left = relativeError(&denoised.picture.data()->x, truth);
            EXPECT_LT(left, plain) << name << ", " << samples << " samples, seed " << seed;
            before += plain / seeds;
            after += left / seeds;
            measured += denoised.error.relmse / seeds;
            if (denoised.error.reliable) {
                EXPECT_NEAR(std::log(denoised.error.relmse / left), 0, std::log(1.4))
                    << name << ", " << samples;
            }
        }
        printf("%s, %u samples: relMSE %.4g, denoised %.4g, measured %.4g\n", name.c_str(), samples, before,
               after, measured);
        // Rare bright samples decide on caustics and small lamps: nothing measures what none has met.
        if (samples >= 16 && name != "caustic" && name != "lights500") {
            EXPECT_NEAR(std::log(measured / after), 0, 0.4) << name << ", " << samples << " samples";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DenoiseScene,
                         testing::Values("lights500", "caustic", "garden", "lacquer", "cornell"));

TEST(Denoise, ARendersErrorFallsAndItSaysSo) {
    Renderer renderer(deviceOptions());
    for (const char* name : {"sample:cornell", "sample:glass"}) {
        const Scene scene = load(name);
        RenderOptions options;
        options.size = {48, 48};
        options.samples = 512;
        options.seed = 99;
        const ImageF truth = renderer.render(scene, options).image;
        options.samples = 8;
        options.denoise = options.errorMap = true;
        const RenderResult result = renderer.render(scene, options);
        ASSERT_TRUE(result.denoised.has_value());
        const double before = compareImages(result.image, truth).relmse;
        const double after = compareImages(result.denoised->image, truth).relmse;
        printf("%s: relMSE %.4g, denoised %.4g (measured %.4g, %.4g)\n", name, before, after,
               result.denoised->undenoised, result.denoised->error.relmse);
        EXPECT_LT(after, 0.8 * before) << name;
        EXPECT_GT(result.denoised->strength, 0.2);
        const nlohmann::json statistics = nlohmann::json::parse(result.json());
        EXPECT_TRUE(statistics["denoised"]["biased"]);
        EXPECT_FALSE(statistics["denoised"]["reliable"]) << name;  // lamps in view, caustics, 8 samples
        EXPECT_LT(statistics["denoised"]["low"], statistics["denoised"]["relmse"]);
        EXPECT_GT(statistics["denoised"]["high"], statistics["denoised"]["relmse"]);

        const auto file = scratchFolder() / "denoised.exr";
        saveDenoised(file, result);
        const ImageF read = loadImage(file);
        EXPECT_EQ(std::get<std::string>(read.metadata.at("denoised")).substr(0, 6), "biased");
        EXPECT_GE(read.channel("strength"), 0);
        saveErrorMap(scratchFolder() / "map.exr", result);
        saveErrorMap(scratchFolder() / "map.png", result);
        const ImageF map = loadImage(scratchFolder() / "map.exr");
        double square = 0;
        for (const float e : map.data) square += double(e) * e / double(map.data.size());
        EXPECT_NEAR(std::log(square / result.error.relmse), 0, 0.7) << name;
    }
    RenderOptions one;
    one.samples = 1;
    one.denoise = true;
    EXPECT_THROW(renderer.render(load("sample:cornell"), one), std::exception);
}

}  // namespace
}  // namespace helio::test
