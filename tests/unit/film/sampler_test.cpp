// The sampler's promises: stratification, uniformity, independence, convergence. Literals here are floats.
#include "engine/core/shared.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace helio {
namespace {

using namespace shared32;

constexpr double significance = 1e-4L;

/// p-value of the hypothesis that pairs are uniform in the unit square.
double uniformPairs(int count, const std::function<Vec2(uint)>& pair) {
    constexpr int side = 64;
    std::vector<double> cells(side * side), expected(side * side, double(count) / (side * side));
    for (int i = 0; i < count; ++i) {
        const Vec2 u = pair(uint(i));
        EXPECT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
        ++cells[std::size_t(int(u.y * side) * side + int(u.x * side))];
    }
    return verify::chiSquaredTest(cells, expected).pValue;
}

TEST(Hash, Pcg3dMatchesAnIndependentEvaluation) {
    // Jarzynski and Olano's definition, in 64-bit arithmetic reduced by hand.
    const auto reference = [](std::uint64_t x, std::uint64_t y, std::uint64_t z) {
        const std::uint64_t m = 0xffffffffull;
        x = (x * 1664525 + 1013904223) & m;
        y = (y * 1664525 + 1013904223) & m;
        z = (z * 1664525 + 1013904223) & m;
        x = (x + y * z) & m, y = (y + z * x) & m, z = (z + x * y) & m;
        x ^= x >> 16, y ^= y >> 16, z ^= z >> 16;
        x = (x + y * z) & m, y = (y + z * x) & m, z = (z + x * y) & m;
        return uvec3(uint(x), uint(y), uint(z));
    };
    for (uint i = 0; i < 1000; ++i) EXPECT_EQ(pcg3d(uvec3(i, i * i, 7 * i)), reference(i, i * i, 7 * i));
}

TEST(Hash, EveryInputBitFlipsHalfOfTheOutput) {
    for (uint bit = 0; bit < 32; ++bit) {
        double flips = 0;
        const int n = 4096;
        for (uint i = 0; i < n; ++i) {
            flips += std::popcount(hashUint(i * 0x9e3779b9u) ^ hashUint((i * 0x9e3779b9u) ^ (1u << bit)));
        }
        EXPECT_NEAR(flips / n, 16, 0.5) << "input bit " << bit;
    }
}

TEST(Hash, UnitFloatStaysBelowOne) {
    EXPECT_EQ(unitFloat(0u), 0.0f);
    EXPECT_LT(unitFloat(0xffffffffu), 1.0f);
    EXPECT_EQ(unitFloat(0x80000000u), 0.5f);
}

TEST(Sobol, SecondDimensionFollowsItsDirectionNumbers) {
    // Primitive polynomial x + 1 (Joe and Kuo's second row): v[k] = v[k - 1] ^ (v[k - 1] >> 1), v[0] = 1/2.
    for (uint index = 0; index < 100000; index = index * 5 / 4 + 1) {
        uint x = 0, direction = 0x80000000u;
        for (uint bits = index; bits != 0; bits >>= 1, direction ^= direction >> 1) {
            if (bits & 1u) x ^= direction;
        }
        EXPECT_EQ(bitfieldReverse(sobolSecondReversed(index)), x) << index;
    }
}

TEST(Sobol, EachHalfIsANetInEveryElementaryInterval) {
    for (uint pixel = 0; pixel < 50; ++pixel) {
        for (int power = 1; power <= 10; ++power) {
            for (int split = 0; split <= power; ++split) {
                std::vector<int> cells(std::size_t{1} << power);
                for (uint i = 0; i < (1u << power); ++i) {
                    const PixelSampler s = startSample(SAMPLER_SOBOL, pixel, 2 * i + (pixel & 1u), 11);
                    const Vec2 u = sample2D(SAMPLER_SOBOL, s, pixel % 9);
                    ++cells[std::size_t((int(u.y * (1 << (power - split))) << split) |
                                        int(u.x * (1 << split)))];
                }
                for (const int count : cells) ASSERT_EQ(count, 1) << pixel << " 2^" << power << " " << split;
            }
        }
    }
}

TEST(Sampler, PairsAreUniformOverPixelsSamplesDimensionsAndSeeds) {
    const int n = 1 << 19;
    for (const uint kind : {SAMPLER_SOBOL, SAMPLER_INDEPENDENT, SAMPLER_HALTON, SAMPLER_STRATIFIED}) {
        EXPECT_GT(uniformPairs(n, [&](uint i) { return sample2D(kind, startSample(kind, i, 0, 0), 0); }),
                  significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return sample2D(kind, startSample(kind, 5, 0, 0), i); }),
                  significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return sample2D(kind, startSample(kind, 5, 3, i), 2); }),
                  significance);
    }
    EXPECT_GT(uniformPairs(n,
                           [](uint i) {
                               return sample2D(SAMPLER_INDEPENDENT, startSample(SAMPLER_INDEPENDENT, 5, i, 0),
                                               0);
                           }),
              significance);
}

TEST(Sampler, DimensionsPixelsHalvesAndSeedsAreIndependent) {
    const int n = 1 << 19;
    for (const uint kind : {SAMPLER_SOBOL, SAMPLER_INDEPENDENT, SAMPLER_HALTON, SAMPLER_STRATIFIED}) {
        const auto number = [&](uint pixel, uint sampleIndex, uint dimension, uint seed) {
            return sample1D(kind, startSample(kind, pixel, sampleIndex, seed), dimension);
        };
        EXPECT_GT(uniformPairs(n, [&](uint i) { return Vec2(number(i, 0, 0, 0), number(i, 0, 1, 0)); }),
                  significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return Vec2(number(i, 0, 0, 0), number(i, 1, 0, 0)); }),
                  significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return Vec2(number(i, 0, 0, 0), number(i + 1, 0, 0, 0)); }),
                  significance);
        EXPECT_GT(
            uniformPairs(n, [&](uint i) { return Vec2(number(i, 4, 3, 0), number(i + 1024, 4, 3, 0)); }),
            significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return Vec2(number(i, 0, 0, 0), number(i, 0, 0, 1)); }),
                  significance);
        EXPECT_GT(uniformPairs(n, [&](uint i) { return Vec2(number(i, 0, 5, 0), number(i, 0, 5, 65536)); }),
                  significance);
    }
}

TEST(Sampler, OneNumberIsThePairsFirst) {
    for (const uint kind : {SAMPLER_SOBOL, SAMPLER_INDEPENDENT}) {
        const PixelSampler s = startSample(kind, 3, 4, 5);
        EXPECT_EQ(sample1D(kind, s, 6), sample2D(kind, s, 6).x);
    }
}

/// Root mean square error over pixels of the mean of f over 2^1 .. 2^last samples; slope in log-log.
double slopeOfError(uint kind, const std::function<double(Vec2)>& f, double truth, int last) {
    std::vector<double> counts, errors;
    for (int power = 3; power <= last; ++power) {
        double squares = 0;
        const uint pixels = 512;
        for (uint pixel = 0; pixel < pixels; ++pixel) {
            double sum = 0;
            for (uint i = 0; i < (1u << power); ++i)
                sum += f(sample2D(kind, startSample(kind, pixel, i, 3, uint(power - 1)), 1));
            const double error = sum / (1u << power) - truth;
            squares += error * error;
        }
        counts.push_back(double(1u << power));
        errors.push_back(std::sqrt(squares / pixels));
    }
    return verify::convergenceOrder(counts, errors).slope;
}

TEST(Sampler, ErrorFallsAtTheOrderOfTheTheory) {
    const auto smooth = [](Vec2 u) { return double(u.x) * u.y; };
    const auto disk = [](Vec2 u) { return u.x * u.x + u.y * u.y < 1 ? 1.0 : 0.0; };
    const double quarterDisk = 0.785398163397448309616L;
    EXPECT_NEAR(slopeOfError(SAMPLER_INDEPENDENT, smooth, 0.25, 10), -0.5, 0.05);
    EXPECT_NEAR(slopeOfError(SAMPLER_INDEPENDENT, disk, quarterDisk, 10), -0.5, 0.05);
    // Owen (1997): variance O(n^-3 log n) for smooth functions; (0,2)-nets with an edge: n^-3/2.
    EXPECT_LT(slopeOfError(SAMPLER_SOBOL, smooth, 0.25, 10), -1.3);
    EXPECT_NEAR(slopeOfError(SAMPLER_SOBOL, disk, quarterDisk, 10), -0.75, 0.08);
    EXPECT_LT(slopeOfError(SAMPLER_SOBOL_BLUE, smooth, 0.25, 10), -1.3);
    // A jittered grid: variance O(n^-2) for smooth functions, n^-3/2 with an edge (Mitchell 1996).
    EXPECT_NEAR(slopeOfError(SAMPLER_STRATIFIED, smooth, 0.25, 10), -1.0, 0.08);
    EXPECT_NEAR(slopeOfError(SAMPLER_STRATIFIED, disk, quarterDisk, 10), -0.75, 0.08);
    // Halton's pair (5, 7): near -1, with ripples at powers of the primes.
    EXPECT_LT(slopeOfError(SAMPLER_HALTON, smooth, 0.25, 10), -0.8);
    EXPECT_LT(slopeOfError(SAMPLER_HALTON, disk, quarterDisk, 10), -0.6);
}

/// Mean power of the error's spectrum over frequencies below a quarter of the sampling rate on each axis, as
/// a part of its mean over all: 1 for white noise. Mean over dimensions.
double lowFrequencies(uint kind, uint samples) {
    constexpr int side = 32;
    double low = 0, all = 0;
    int lowCount = 0, allCount = 0;
    for (uint dimension = 0; dimension < 6; ++dimension) {
        std::vector<double> error(side * side);
        for (uint y = 0; y < side; ++y)
            for (uint x = 0; x < side; ++x) {
                const uint pixel = kind == SAMPLER_SOBOL_BLUE ? mortonCode(x, y) : y * side + x;
                double sum = 0;
                for (uint i = 0; i < samples; ++i) {
                    const Vec2 u = sample2D(
                        kind, startSample(kind, pixel, i, 2, uint(std::bit_width((samples - 1) / 2))),
                        dimension);
                    sum += double(u.x) * u.y + (u.x + u.y < 1 ? 0.5 : 0.0);
                }
                error[y * side + x] = sum / samples - 0.5;
            }
        for (int v = 0; v < side; ++v)
            for (int u = 0; u < side; ++u) {
                if (u == 0 && v == 0) continue;
                double real = 0, imaginary = 0;
                for (int y = 0; y < side; ++y)
                    for (int x = 0; x < side; ++x) {
                        const double angle = 6.283185307179586L * double((u * x + v * y) % side) / side;
                        real += error[std::size_t(y * side + x)] * std::cos(angle);
                        imaginary += error[std::size_t(y * side + x)] * std::sin(angle);
                    }
                const double power = real * real + imaginary * imaginary;
                const int fu = std::min(u, side - u), fv = std::min(v, side - v);
                if (fu < side / 8 && fv < side / 8) {
                    low += power;
                    ++lowCount;
                }
                all += power;
                ++allCount;
            }
    }
    return low / lowCount / (all / allCount);
}

TEST(Sampler, BlueSamplersErrorHasNoLowFrequencies) {
    for (const uint samples : {2u, 8u, 16u}) {
        const double blue = lowFrequencies(SAMPLER_SOBOL_BLUE, samples),
                     white = lowFrequencies(SAMPLER_SOBOL, samples);
        RecordProperty("blue", std::to_string(blue));
        EXPECT_LT(blue, samples == 2 ? 0.8L : 0.5L) << samples;  // two halves, each blue on its own
        EXPECT_NEAR(white, 1, 0.35) << samples;
    }
}

TEST(Sampler, StratifiedFillsEveryCellOnce) {
    for (uint pixel = 0; pixel < 40; ++pixel)
        for (uint strata = 0; strata <= 8; ++strata)
            for (uint grid = 0; grid < 2; ++grid) {
                std::vector<int> cells(std::size_t{1} << strata), lines(std::size_t{1} << strata);
                const uint columns = (strata + 1) / 2;
                for (uint i = 0; i < (1u << strata); ++i) {
                    const PixelSampler s =
                        startSample(SAMPLER_STRATIFIED, pixel, 2 * (i + (grid << strata)) + 1, 7, strata);
                    const Vec2 u = sample2D(SAMPLER_STRATIFIED, s, pixel);
                    ++cells[std::size_t((int(u.y * (1 << (strata - columns))) << columns) |
                                        int(u.x * (1 << columns)))];
                    ++lines[std::size_t(sample1D(SAMPLER_STRATIFIED, s, pixel) * (1 << strata))];
                }
                for (const int count : cells) ASSERT_EQ(count, 1) << pixel << " 2^" << strata;
                for (const int count : lines) ASSERT_EQ(count, 1) << pixel << " 2^" << strata;
            }
}

TEST(Sampler, HaltonIsANetInEachBase) {
    // p^k consecutive numbers fall once into each interval of length p^-k.
    for (uint dimension = 0; dimension < 16; ++dimension)
        for (uint axis = 0; axis < 2; ++axis) {
            const uint base = smallPrime(2 * dimension + axis);
            for (uint count = base; count <= 700; count *= base) {
                std::vector<int> cells(count);
                for (uint i = 0; i < count; ++i) {
                    const Vec2 u = sample2D(SAMPLER_HALTON,
                                            startSample(SAMPLER_HALTON, 9, 2 * (i + count), 4), dimension);
                    ++cells[std::size_t(double(axis == 0 ? u.x : u.y) * count)];
                }
                int misplaced = 0;  // by the rounding of a number next to a boundary
                for (const int c : cells) misplaced += std::abs(c - 1);
                EXPECT_LE(misplaced, 2) << "base " << base << ", " << count;
            }
        }
}

TEST(Sampler, IsUnbiasedForEveryCount) {
    // Owen-scrambled points are uniform one by one, so the mean is unbiased at any count, powers of 2 or not.
    for (const uint kind : {SAMPLER_SOBOL, SAMPLER_HALTON, SAMPLER_STRATIFIED})
        for (const uint count : {1u, 3u, 6u, 20u}) {
            verify::RunningStatistics means;
            for (uint pixel = 0; pixel < 40000; ++pixel) {
                double sum = 0;
                for (uint i = 0; i < count; ++i) {
                    const Vec2 u = sample2D(kind, startSample(kind, pixel, i, 1, 3), 4);
                    sum += double(u.x) * u.x * u.y;
                }
                means.add(sum / count);
            }
            EXPECT_LT(std::abs(verify::zTest(means, 1 / 6.0L).z), 4) << count;
            EXPECT_LT(means.standardError(), 0.002L);
        }
}

}  // namespace
}  // namespace helio
