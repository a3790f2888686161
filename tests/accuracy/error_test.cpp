// The error estimate of path-traced pictures against their true error, over many seeds.
#include "tests/support/device.hpp"
#include "tests/support/error_scenes.hpp"
#include "tests/support/scene_films.hpp"

#include <heliograph/renderer.hpp>
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace helio::test {
namespace {

class ErrorInterval : public testing::TestWithParam<const char*> {};

TEST_P(ErrorInterval, HoldsTheTrueErrorIn95PercentOfSeeds) {
    constexpr int seeds = 100;
    SceneFilms films(device(), errorScene(GetParam()), {16, 16});
    std::vector<FilmImages> all;
    MeanImage mean;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        all.push_back(films.render(64, seed));
        mean.add(all.back());
    }
    const std::vector<double> reference = mean.mean();
    int covered = 0, reliable = 0;
    double ratio = 0, width = 0;
    for (const FilmImages& film : all) {
        // The mean of n pictures leaves out 1 / n of a picture's own error.
        const double truth = relativeError(film, reference) / (1 - 1.0 / seeds);
        const ErrorEstimate error = estimateError(film);
        covered += error.low <= truth && truth <= error.high;
        reliable += error.reliable;
        ratio += error.relmse / truth / seeds;
        width += error.high / error.low / seeds;
    }
    // 100 draws of chance 0.95 give 85 or fewer with probability 1.5e-4.
    EXPECT_GT(covered, 85);
    EXPECT_GT(reliable, 70);
    EXPECT_NEAR(ratio, 1, 0.1);
    // 256 pixels of equal normal errors cannot do better than exp(4 * 2 / 16) = 1.65.
    EXPECT_LT(width, 4);
    RecordProperty("covered", covered);
    printf("%s: %d of %d, %d reliable, estimate / truth %.3f, high / low %.2f\n", GetParam(), covered, seeds,
           reliable, ratio, width);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorInterval, testing::Values("room", "spheres"));

TEST(ErrorEstimate, IsNotReliableOnACausticNorBesideLampsBelowAPixel) {
    for (const char* name : {"glass", "lenses"}) {
        SceneFilms films(device(), errorScene(name), {48, 48});
        for (std::uint32_t seed = 1; seed <= 3; ++seed)
            EXPECT_FALSE(estimateError(films.render(32, seed)).reliable) << name;
    }
}

/** The fewest samples, at least 8, whose estimate is below the limit. */
std::uint32_t leastSamples(SceneFilms& films, double limit) {
    for (std::uint32_t samples = 8;; ++samples) {
        const ErrorEstimate error = estimateError(films.render(samples, 0));
        if (error.high < limit && (error.reliable || samples >= 64)) return samples;
    }
}

TEST(ErrorLimit, EndsWithin20PercentOfTheLeastSamplesThatSuffice) {
    const std::vector<std::pair<const char*, std::vector<double>>> limits = {
        {"cornell", {0.05, 0.02, 0.008}},
        {"spheres", {0.05, 0.008, 0.003}},
        {"metals", {0.02, 0.008}},
        {"yard", {0.005, 0.0015}},
        {"garden", {0.05, 0.01}}};
    for (const auto& [name, ofScene] : limits) {
        const Scene scene = errorScene(name);
        SceneFilms films(device(), scene, {24, 24});
        Renderer renderer(deviceOptions());
        for (const double limit : ofScene) {
            const std::uint32_t least = leastSamples(films, limit);
            RenderOptions options;
            options.size = {24, 24};
            options.samples = 4096;
            options.maxError = limit;
            const RenderResult result = renderer.render(scene, options);
            EXPECT_LT(result.error.high, limit) << name;
            EXPECT_LE(result.samples, 1.2 * least) << name << " to " << limit;
            printf("%s to %g: %u samples, %u suffice\n", name, limit, result.samples, least);
        }
    }
}

/** Over seeds: the picture's mean, its mean relative to the truth, and relMSE. */
struct Runs {
    verify::RunningStatistics brightness, relative, error;
};
void addRun(Runs& runs, const FilmImages& film, const std::vector<double>& truth) {
    double brightness = 0, relative = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double x = film.mean[i / 3 * 4 + i % 3];
        brightness += x / double(truth.size());
        relative += x / (truth[i] + 0.1) / double(truth.size());
    }
    runs.brightness.add(brightness);
    runs.relative.add(relative);
    runs.error.add(relativeError(film, truth));
}
double zOf(const verify::RunningStatistics& a, const verify::RunningStatistics& b) {
    return (a.mean() - b.mean()) / std::hypot(a.standardError(), b.standardError());
}

class Adaptive : public testing::TestWithParam<const char*> {};

TEST_P(Adaptive, IsUnbiasedAndNoWorse) {
    constexpr int seeds = 150;
    const Scene scene = errorScene(GetParam());
    SceneFilms plain(device(), scene, {16, 16}), adaptive(device(), scene, {16, 16}, true);
    const auto truthFilm = plain.render(4096, 999);
    MeanImage mean;
    mean.add(truthFilm);
    const std::vector<double> truth = mean.mean();
    Runs plainRuns, adaptiveRuns;
    double samples = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        addRun(plainRuns, plain.render(16, std::uint32_t(seed)), truth);
        const FilmImages film = adaptive.render(16, std::uint32_t(10000 + seed));
        addRun(adaptiveRuns, film, truth);
        for (std::size_t i = 3; i < film.mean.size(); i += 4) samples += film.mean[i];
    }
    EXPECT_NEAR(samples / (256.0 * seeds), 16, 0.16);
    // 150 pictures each of 256 pixels and 16 samples: |z| above 3.9 in 1 of 10,000.
    EXPECT_LT(std::abs(zOf(adaptiveRuns.brightness, plainRuns.brightness)), 3.9);
    EXPECT_LT(std::abs(zOf(adaptiveRuns.relative, plainRuns.relative)), 3.9);
    const double gain = adaptiveRuns.error.mean() / plainRuns.error.mean();
    const double uncertainty = std::hypot(adaptiveRuns.error.standardError() / adaptiveRuns.error.mean(),
                                          plainRuns.error.standardError() / plainRuns.error.mean());
    printf("%s: z %.2f, relative %.2f; relMSE %.3f +- %.3f of plain\n", GetParam(),
           zOf(adaptiveRuns.brightness, plainRuns.brightness), zOf(adaptiveRuns.relative, plainRuns.relative),
           gain, uncertainty);
    EXPECT_LT(gain, 1.05 + 3 * uncertainty);
    if (std::string(GetParam()) == "spheres") {
        EXPECT_LT(gain, 0.9);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Adaptive, testing::Values("cornell", "room", "spheres"));

}  // namespace
}  // namespace helio::test
