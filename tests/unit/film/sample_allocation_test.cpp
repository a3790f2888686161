// How samples are shared out.
#include "engine/film/sample_allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace helio {
namespace {

/** Brightness 1; relative standard errors by place. */
FilmImages film(std::uint32_t width, std::uint32_t height, float (*noise)(std::uint32_t, std::uint32_t)) {
    const std::size_t floats = std::size_t(width) * height * 4;
    FilmImages film{width, height, std::vector<float>(floats, 1.0f), std::vector<float>(floats),
                    std::vector<float>(floats, 1.0f)};
    for (std::size_t i = 0; i < floats; ++i) {
        const float e = noise(std::uint32_t(i / 4 % width), std::uint32_t(i / 4 / width));
        film.variance[i] = e * e;
        if (i % 4 != 3) film.difference[i] = i / 4 % 2 == 0 ? e : -e;
    }
    return film;
}

double meanOf(const std::vector<std::uint32_t>& samples) {
    return std::accumulate(samples.begin(), samples.end(), 0.0) / double(samples.size());
}

TEST(SampleAllocation, EqualNoiseGetsEqualSamples) {
    const SampleAllocation allocation(film(20, 10, [](auto, auto) { return 0.1f; }), 8);
    for (const std::uint32_t n : allocation.samples(64)) EXPECT_EQ(n, 64u);
}

TEST(SampleAllocation, TheNoisyHalfGetsMoreAndTheMeanIsKept) {
    const SampleAllocation allocation(
        film(40, 40, [](std::uint32_t x, std::uint32_t) { return x < 20 ? 0.01f : 0.3f; }), 64);
    for (const double average : {64.0, 100.0, 1000.0}) {
        const std::vector<std::uint32_t> samples = allocation.samples(average);
        EXPECT_NEAR(meanOf(samples), average, 1);
        EXPECT_GE(*std::min_element(samples.begin(), samples.end()), 64u);
        for (const std::uint32_t n : samples) EXPECT_EQ(n % 2, 0u);
        if (average > 64) {
            EXPECT_GT(samples[30], samples[5]);
        }
    }
}

TEST(SampleAllocation, APixelsOwnNoiseDoesNotCount) {
    const FilmImages quiet = film(21, 21, [](auto, auto) { return 0.1f; });
    FilmImages loud = quiet;
    for (std::size_t c = 0; c < 3; ++c) loud.variance[4 * 220 + c] = loud.difference[4 * 220 + c] = 100;
    const auto shareOf = [](const FilmImages& images, std::size_t pixel) {
        const SampleAllocation allocation(images, 16);
        return allocation.shares()[pixel] / allocation.shares()[0];
    };
    // All but the common factor, which the shares of the corner take out.
    EXPECT_NEAR(shareOf(loud, 220), shareOf(quiet, 220), 1e-5);
    EXPECT_GT(shareOf(loud, 221), 2 * shareOf(quiet, 221));
}

TEST(SampleAllocation, NeverFallsAndStaysInTheTracersLimits) {
    FilmImages images =
        film(64, 64, [](std::uint32_t x, std::uint32_t y) { return x == 9 && y < 9 ? 9.0f : 1e-4f; });
    images.variance[0] = NAN;
    images.variance[40] = INFINITY;
    const SampleAllocation allocation(images, 16);
    std::vector<std::uint32_t> before = allocation.samples(16);
    for (double average = 32; average < 2000; average += 256) {
        const std::vector<std::uint32_t> samples = allocation.samples(average);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_GE(samples[i], before[i]);
            EXPECT_LE(samples[i] - before[i], 4096u);
        }
        before = samples;
    }
}

TEST(SampleAllocation, OnePixelAndNoNoise) {
    EXPECT_EQ(SampleAllocation(film(1, 1, [](auto, auto) { return 0.5f; }), 8).samples(32).at(0), 32u);
    EXPECT_EQ(SampleAllocation(film(3, 1, [](auto, auto) { return 0.0f; }), 8).samples(32).at(1), 32u);
    EXPECT_EQ(pilotSamples(4), 4u);
    EXPECT_EQ(pilotSamples(64), 16u);
    EXPECT_EQ(pilotSamples(100000), 64u);
}

}  // namespace
}  // namespace helio
