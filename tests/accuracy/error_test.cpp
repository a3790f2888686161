// The error estimate of path-traced pictures against their true error, over many seeds.
#include "tests/support/device.hpp"
#include "tests/support/error_scenes.hpp"
#include "tests/support/scene_films.hpp"

#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>

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
    int covered = 0;
    double ratio = 0, width = 0;
    for (const FilmImages& film : all) {
        // The mean of n pictures leaves out 1 / n of a picture's own error.
        const double truth = relativeError(film, reference) / (1 - 1.0 / seeds);
        const ErrorEstimate error = estimateError(film);
        covered += error.low <= truth && truth <= error.high;
        ratio += error.relmse / truth / seeds;
        width += error.high / error.low / seeds;
    }
    // 100 draws of chance 0.95 give 85 or fewer with probability 1.5e-4.
    EXPECT_GT(covered, 85);
    EXPECT_NEAR(ratio, 1, 0.1);
    // 256 pixels of equal normal errors cannot do better than exp(4 * 2 / 16) = 1.65.
    EXPECT_LT(width, 4);
    RecordProperty("covered", covered);
    printf("%s: %d of %d, estimate / truth %.3f, high / low %.2f\n", GetParam(), covered, seeds, ratio,
           width);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorInterval, testing::Values("room", "spheres"));

TEST(ErrorEstimate, IsNotReliableOnACaustic) {
    SceneFilms films(device(), errorScene("glass"), {48, 48});
    for (std::uint32_t seed = 1; seed <= 3; ++seed)
        EXPECT_FALSE(estimateError(films.render(32, seed)).reliable);
}

/** The fewest samples, at least 8, whose estimate is below the limit. */
std::uint32_t leastSamples(SceneFilms& films, double limit) {
    for (std::uint32_t samples = 8;; ++samples) {
        const ErrorEstimate error = estimateError(films.render(samples, 0));
        if (error.high < limit && (error.reliable || samples >= 64)) return samples;
    }
}

TEST(ErrorLimit, EndsWithin20PercentOfTheLeastSamplesThatSuffice) {
    for (const char* name : {"cornell", "spheres"}) {
        const Scene scene = errorScene(name);
        SceneFilms films(device(), scene, {16, 16});
        Renderer renderer(deviceOptions());
        for (const double limit : {0.05, 0.02, 0.008, 0.003}) {
            const std::uint32_t least = leastSamples(films, limit);
            RenderOptions options;
            options.size = {16, 16};
            options.samples = 4096;
            options.maxError = limit;
            const RenderResult result = renderer.render(scene, options);
            EXPECT_LT(result.error.high, limit) << name;
            EXPECT_LE(result.samples, 1.2 * least) << name << " to " << limit;
            printf("%s to %g: %u samples, %u suffice\n", name, limit, result.samples, least);
        }
    }
}

}  // namespace
}  // namespace helio::test
