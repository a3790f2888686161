// Coverage of the error interval on synthetic films whose truth is known.
#include "engine/film/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace helio {
namespace {

using Random = std::mt19937;
using Truth = std::function<double(std::uint32_t x, std::uint32_t y)>;
using Noise = std::function<double(Random&, double mean)>;

struct Synthetic {
    FilmImages film;
    double relmse = 0;  ///< realised
};

Synthetic synthesize(std::uint32_t size, int samples, const Truth& truth, const Noise& noise, unsigned seed) {
    Synthetic result;
    const std::size_t floats = std::size_t(size) * size * 4;
    result.film = {size, size, std::vector<float>(floats), std::vector<float>(floats),
                   std::vector<float>(floats)};
    Random random(seed);
    std::vector<double> values(static_cast<std::size_t>(samples));
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const double mean = truth(x, y);
            double sum = 0, alternating = 0, deviation = 0;
            for (std::size_t k = 0; k < values.size(); ++k) {
                values[k] = noise(random, mean);
                sum += values[k];
                alternating += k % 2 == 0 ? values[k] : -values[k];
            }
            const double value = sum / samples;
            for (const double v : values) deviation += (v - value) * (v - value);
            const std::size_t i = 4 * (std::size_t(y) * size + x);
            for (std::size_t c = 0; c < 3; ++c) {
                result.film.mean[i + c] = float(value);
                result.film.variance[i + c] = samples > 1 ? float(deviation / (samples - 1) / samples) : 0.0f;
                result.film.difference[i + c] = samples > 1 ? float(alternating / samples) : 0.0f;
            }
            result.film.mean[i + 3] = float(samples);
            result.film.difference[i + 3] = samples > 1 ? 1.0f : 0.0f;
            result.relmse += (value - mean) * (value - mean) / (mean * mean + 0.01) / (size * size);
        }
    }
    return result;
}

double normalNoise(Random& random, double mean) {
    return mean * (1 + 0.3 * std::normal_distribution<>()(random));
}
double exponentialNoise(Random& random, double mean) {
    return mean * std::exponential_distribution<>()(random);
}
double fireflies(Random& random, double mean) {
    return 0.7 * mean + (std::uniform_real_distribution<>()(random) < 2e-3 ? 0.3 * mean / 2e-3 : 0);
}

double flat(std::uint32_t, std::uint32_t) {
    return 0.5;
}
double checkers(std::uint32_t x, std::uint32_t y) {
    return ((x / 8 + y / 8) & 1) ? 0.02 : 1.0;
}
double ramp(std::uint32_t x, std::uint32_t) {
    return 0.01 + 0.02 * x;
}
double lamp(std::uint32_t x, std::uint32_t y) {
    return x > 20 && x < 30 && y > 20 && y < 30 ? 17.0 : 0.3;
}

TEST(ErrorEstimate, IntervalCoversTheRealisedErrorWhereItIsReliable) {
    const std::vector<std::pair<const char*, Truth>> truths = {
        {"flat", flat}, {"checkers", checkers}, {"ramp", ramp}, {"lamp", lamp}};
    const std::vector<std::pair<const char*, Noise>> noises = {
        {"normal", normalNoise}, {"exponential", exponentialNoise}, {"fireflies", fireflies}};
    int covered = 0, reliable = 0;
    for (const auto& [truthName, truth] : truths) {
        for (const auto& [noiseName, noise] : noises) {
            for (const int samples : {8, 64}) {
                int here = 0, all = 0;
                for (unsigned seed = 0; seed < 20; ++seed) {
                    const Synthetic s = synthesize(48, samples, truth, noise, seed * 977 + 1);
                    const ErrorEstimate e = estimateError(s.film);
                    EXPECT_LE(e.low, e.relmse);
                    EXPECT_GE(e.high, e.relmse);
                    if (!e.reliable) continue;
                    ++all;
                    here += e.low <= s.relmse && s.relmse <= e.high;
                    EXPECT_NEAR(e.relmse / s.relmse, 1, 0.35)
                        << truthName << " " << noiseName << " " << samples;
                }
                EXPECT_GE(here, all * 7 / 10)
                    << truthName << ", " << noiseName << ", " << samples << " samples";
                covered += here;
                reliable += all;
            }
        }
    }
    EXPECT_GT(reliable, 200);
    // Half of the films have 8 samples of skewed noise, where the interval is a little too narrow.
    EXPECT_GT(covered, 0.9 * reliable) << covered << " of " << reliable;
}

TEST(ErrorEstimate, ChannelsThatErrApartNarrowTheInterval) {
    // 48 x 48 pixels of three independent channels: the estimate's error is that of 6912 grey ones.
    constexpr unsigned seeds = 100;
    unsigned covered = 0;
    double width = 0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        Synthetic all = synthesize(48, 32, flat, normalNoise, 3 * seed);
        for (std::size_t c = 1; c < 3; ++c) {
            const Synthetic one = synthesize(48, 32, flat, normalNoise, 3 * seed + unsigned(c));
            all.relmse += one.relmse;
            for (std::size_t i = c; i < all.film.mean.size(); i += 4) {
                all.film.mean[i] = one.film.mean[i];
                all.film.variance[i] = one.film.variance[i];
                all.film.difference[i] = one.film.difference[i];
            }
        }
        const ErrorEstimate e = estimateError(all.film);
        covered += e.low <= all.relmse / 3 && all.relmse / 3 <= e.high;
        width += std::log(e.high / e.low) / seeds;
    }
    // Relative standard error sqrt(4 / 6912) = 0.0241, and the model's 0.01.
    EXPECT_NEAR(width, 3.92 * std::hypot(0.0241, 0.01 / 1.96), 0.01);
    // Of chance 0.95: fewer than 86 in 1 of 5000
    EXPECT_GE(covered, 86u);
}

TEST(ErrorEstimate, SkewIsMadeUpForWhereAPixelIsLikeNoNeighbour) {
    // A quarter is flat and tells how skewed errors are; elsewhere each pixel has its own value alone, whose
    // noise the numerator shares.
    const Truth truth = [](std::uint32_t x, std::uint32_t y) {
        return x < 12 || (x + y) % 2 == 0 ? 1.0 : 0.2;
    };
    const Noise rare = [](Random& random, double mean) {
        return 0.6 * mean + (std::uniform_real_distribution<>()(random) < 0.06 ? 0.4 * mean / 0.06 : 0);
    };
    double ratio = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const Synthetic s = synthesize(48, 64, truth, rare, seed);
        ratio += estimateError(s.film).relmse / s.relmse / 60;
    }
    EXPECT_NEAR(ratio, 1, 0.06);
}

TEST(ErrorEstimate, NormalNoiseAtManySamplesIsReliable) {
    EXPECT_TRUE(estimateError(synthesize(48, 64, checkers, normalNoise, 1).film).reliable);
}

TEST(ErrorEstimate, HeavyTailsAndFewSamplesAreNotReliable) {
    EXPECT_FALSE(estimateError(synthesize(48, 64, flat, fireflies, 1).film).reliable);
    EXPECT_FALSE(estimateError(synthesize(48, 4, flat, normalNoise, 1).film).reliable);
}

/** Samples that balance within most halves and not within a few: variances do not tell, only the halves'
 * difference. */
TEST(ErrorEstimate, HeavyTailsOfTheHalvesAloneAreNotReliable) {
    for (const bool heavy : {false, true}) {
        Synthetic s = synthesize(64, 64, flat, normalNoise, 3);
        Random random(4);
        for (std::size_t i = 0; i < s.film.difference.size(); i += 4) {
            const bool rare = std::uniform_real_distribution<>()(random) < 0.04;
            for (std::size_t c = 0; c < 3; ++c)
                s.film.difference[i + c] *= !heavy ? 1.0f : rare ? 4.8f : 0.3f;
        }
        EXPECT_EQ(estimateError(s.film).reliable, !heavy);
    }
}

TEST(ErrorEstimate, OneFireflyIsNotReliableAndDoesNotHideItself) {
    Synthetic s = synthesize(64, 64, flat, normalNoise, 2);
    const ErrorEstimate before = estimateError(s.film);
    const std::size_t i = 4 * (20 * 64 + 20);
    for (std::size_t c = 0; c < 3; ++c) {  // one sample of 6400 among 64
        s.film.mean[i + c] += 100;
        s.film.difference[i + c] += 100;
        s.film.variance[i + c] = 100 * 100;
    }
    const ErrorEstimate after = estimateError(s.film);
    EXPECT_FALSE(after.reliable);
    // 100^2 / (0.5^2 + 0.01) over 64^2 pixels, judged by its neighbours' brightness.
    EXPECT_NEAR(after.relmse - before.relmse, 1e4 / 0.26 / 4096, 0.2);
}

/** Intervals of 20 films that hold the error; none may count as reliable. */
int coveredThoughUnreliable(int samples, const Truth& truth, const Noise& noise) {
    int covered = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Synthetic s = synthesize(48, samples, truth, noise, seed);
        const ErrorEstimate e = estimateError(s.film);
        EXPECT_FALSE(e.reliable);
        covered += e.low <= s.relmse && s.relmse <= e.high;
    }
    return covered;
}

TEST(ErrorEstimate, LampsBelowAPixelAreNotReliable) {
    // Five lamps of 160 that fill 0.3 of a pixel and 0.005 of the one beside it, which most films do not see.
    const Truth truth = [](std::uint32_t x, std::uint32_t y) {
        return y % 10 == 5 && x % 40 == 20 ? 48.0 : y % 10 == 5 && x % 40 == 21 ? 1.2 : 0.4;
    };
    const Noise lamps = [](Random& random, double mean) {
        const double share = (mean - 0.4) / 160;
        return 0.4 * (1 + 0.1 * std::normal_distribution<>()(random)) +
               (std::uniform_real_distribution<>()(random) < share ? 160 : 0);
    };
    EXPECT_LT(coveredThoughUnreliable(64, truth, lamps), 19);  // there is something to warn of
    // The same without a pixel beside that may hold more: each pixel's samples are alike.
    const Noise plain = [](Random& random, double mean) {
        return mean * (1 + 0.1 * std::normal_distribution<>()(random));
    };
    EXPECT_TRUE(estimateError(synthesize(48, 64, flat, plain, 1).film).reliable);
}

TEST(ErrorEstimate, EdgesOfLampsAreNotReliableAtFewSamples) {
    // A lamp of 15, and 0.06 of it in the pixels of the row above, which 8 samples see in two of five.
    const Truth truth = [](std::uint32_t x, std::uint32_t y) {
        const bool beside = x >= 10 && x < 38;
        return beside && y >= 10 && y < 14 ? 15.0 : beside && y == 9 ? 0.3 + 0.06 * 15 : 0.3;
    };
    const Noise lamp = [](Random& random, double mean) {
        const double rest = mean > 10 ? mean : 0.3 * (1 + 0.3 * std::normal_distribution<>()(random));
        return rest + (mean > 1 && mean < 10 && std::uniform_real_distribution<>()(random) < 0.06 ? 15 : 0);
    };
    EXPECT_LT(coveredThoughUnreliable(8, truth, lamp), 17);  // there is something to warn of
}

TEST(ErrorEstimate, NoiselessIsZeroAndOneSampleGuesses) {
    const Noise none = [](Random&, double mean) { return mean; };
    const ErrorEstimate zero = estimateError(synthesize(16, 8, ramp, none, 1).film);
    EXPECT_EQ(zero.relmse, 0);
    EXPECT_EQ(zero.high, 0);
    const Synthetic one = synthesize(64, 1, flat, normalNoise, 1);
    const ErrorEstimate guess = estimateError(one.film);
    EXPECT_FALSE(guess.reliable);
    EXPECT_NEAR(guess.relmse / one.relmse, 1, 0.4);
}

TEST(ErrorEstimate, LeavesOutWhatIsNotFinite) {
    Synthetic s = synthesize(32, 16, flat, normalNoise, 3);
    s.film.mean[4 * 100] = NAN;
    s.film.difference[4 * 200 + 1] = INFINITY;
    s.film.variance[4 * 300 + 2] = INFINITY;
    const ErrorEstimate e = estimateError(s.film);
    EXPECT_TRUE(std::isfinite(e.relmse) && std::isfinite(e.high));
    EXPECT_NEAR(e.relmse / s.relmse, 1, 0.2);
}

TEST(ErrorEstimate, StratificationGainIsTheRatioOfVariances) {
    Synthetic s = synthesize(64, 16, flat, normalNoise, 4);
    EXPECT_NEAR(stratificationGain(s.film), 1, 0.1);
    for (float& d : s.film.difference) d *= 0.5f;
    EXPECT_NEAR(stratificationGain(s.film), 0.25, 0.025);
}

}  // namespace
}  // namespace helio
