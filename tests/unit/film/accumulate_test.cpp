// The film's running mean and variance against sums in extended precision. Literals here are floats.
#include "engine/core/shared.hpp"
#include "tests/support/sanitized.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

namespace helio {
namespace {

using namespace shared32;
using Random = std::mt19937;

struct Exact {
    long double mean = 0, varianceOfMean = 0;
};

struct Outcome {
    Exact exact;
    FilmPixel pixel;
    double storedMean = 0;  ///< with the low words
};

/// Feeds a million samples in batches of the given size, and sums them exactly.
Outcome accumulate(int batchSize, const std::function<float(Random&, int)>& sample, int count = 1000000) {
    Outcome outcome;
    outcome.pixel = emptyFilmPixel();
    Random random(3);
    std::vector<float> values;
    for (int i = 0; i < count; i += batchSize) {
        FilmBatch batch = startFilmBatch(outcome.pixel);
        for (int k = i; k < i + batchSize && k < count; ++k) {
            values.push_back(sample(random, k));
            addFilmSample(batch, uint(k), Vec3(values.back(), 2.0f * values.back(), -values.back()));
        }
        outcome.pixel = mergeFilmBatch(outcome.pixel, batch);
    }
    for (const float x : values) outcome.exact.mean += x;
    outcome.exact.mean /= count;
    for (const float x : values)
        outcome.exact.varianceOfMean += (x - outcome.exact.mean) * (x - outcome.exact.mean);
    outcome.exact.varianceOfMean /= (long double)(count - 1) * count;
    const FilmPixel& p = outcome.pixel;
    outcome.storedMean =
        (double(p.sumA.x) + p.sumALow.x + p.sumB.x + p.sumBLow.x) / double(p.countA + p.countB);
    return outcome;
}

float uniform(Random& random) {
    return std::uniform_real_distribution<float>()(random);
}

/// Both within `tolerance` relative to the exact sums; the mean at full precision within `storedTolerance`.
void expectExact(const char* what, const std::function<float(Random&, int)>& sample, double tolerance = 2e-7,
                 double storedTolerance = 1e-9) {
    for (const int batchSize : test::kSanitized ? std::vector{16} : std::vector{1, 7, 64}) {
        const Outcome o = accumulate(batchSize, sample);
        const double mean = double(o.exact.mean), variance = double(o.exact.varianceOfMean);
        EXPECT_NEAR(o.storedMean, mean, storedTolerance * std::abs(mean))
            << what << " in batches of " << batchSize;
        EXPECT_NEAR(filmMean(o.pixel).x, mean, 1.2e-7 * std::abs(mean)) << what;
        EXPECT_NEAR(filmVarianceOfMean(o.pixel).x, variance, tolerance * variance)
            << what << " " << batchSize;
        EXPECT_NEAR(filmVarianceOfMean(o.pixel).y, 4 * variance, 4 * tolerance * variance) << what;
        EXPECT_EQ(filmMean(o.pixel).z, -filmMean(o.pixel).x) << what;
        EXPECT_EQ(filmCount(o.pixel), 1000000);
    }
}

TEST(Accumulate, StaysExactAfterAMillionSamples) {
    expectExact("uniform", [](Random& r, int) { return uniform(r); });
    expectExact("constant", [](Random&, int) { return 0.1f; });
    expectExact("small noise on a large mean", [](Random& r, int) { return 1e4f + 0.01f * uniform(r); });
    expectExact(
        "heavy tail", [](Random& r, int) { return 1 / (1e-6f + uniform(r)); }, 5e-7, 5e-9);
    expectExact("dark, then bright",
                [](Random&, int i) { return i < 64 ? 0.0f : 1.0f + float(i & 4) * 1e-6f; });
    expectExact("tiny", [](Random& r, int) { return 1e-15f * uniform(r); });
    expectExact("huge", [](Random& r, int) { return 1e15f * uniform(r); });
}

TEST(Accumulate, SurvivesABrightFirstSample) {
    // The first batch of all is shifted by its first sample; a small first batch keeps that harmless.
    for (const int batchSize : {1, 4}) {
        const Outcome o = accumulate(batchSize, [](Random& r, int i) { return i == 0 ? 1e6f : uniform(r); });
        EXPECT_NEAR(o.storedMean / double(o.exact.mean), 1, 1e-6);
        EXPECT_NEAR(filmVarianceOfMean(o.pixel).x / double(o.exact.varianceOfMean), 1, 1e-6);
    }
}

TEST(Accumulate, PlainFloatSumsWouldNotDo) {
    // The same million samples in plain float sums: what the double-single state is for.
    Random random(3);
    float sum = 0;
    double exact = 0;
    for (int i = 0; i < 1000000; ++i) {
        const float x = 1e4f + 0.01f * uniform(random);
        sum += x;
        exact += x;
    }
    EXPECT_GT(std::abs(sum / exact - 1), 1e-6);
}

TEST(Accumulate, SplitsHalvesByParity) {
    FilmPixel p = emptyFilmPixel();
    FilmBatch batch = startFilmBatch(p);
    for (uint i = 0; i < 10; ++i) addFilmSample(batch, i, Vec3(i % 2 == 0 ? 1.0f : 5.0f));
    p = mergeFilmBatch(p, batch);
    EXPECT_EQ(p.countA, 5);
    EXPECT_EQ(p.countB, 5);
    EXPECT_EQ(p.sumA.x + p.sumALow.x, 5);
    EXPECT_EQ(p.sumB.x + p.sumBLow.x, 25);
    EXPECT_EQ(filmMean(p).x, 3);
    EXPECT_EQ(filmHalfDifference(p).x, -2);
    EXPECT_NEAR(filmVarianceOfMean(p).x, 40.0 / 9 / 10, 1e-7);
}

TEST(Accumulate, HalfDifferenceIsScaledForUnequalHalves) {
    // Halves of 3 and 1 samples: Var(A - B) = s^2 (1/3 + 1), Var(mean) = s^2 / 4, so the factor is sqrt(3)
    // / 4.
    FilmPixel p = emptyFilmPixel();
    FilmBatch batch = startFilmBatch(p);
    for (const uint i : {0u, 2u, 4u}) addFilmSample(batch, i, Vec3(1.0f));
    addFilmSample(batch, 1u, Vec3(3.0f));
    p = mergeFilmBatch(p, batch);
    EXPECT_NEAR(filmHalfDifference(p).x, -2 * std::sqrt(3.0) / 4, 1e-6);
}

TEST(Accumulate, LeavesOutAndCountsWhatIsNotFinite) {
    FilmPixel p = emptyFilmPixel();
    FilmBatch batch = startFilmBatch(p);
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    addFilmSample(batch, 0, Vec3(nan, 1, 1));
    addFilmSample(batch, 1, Vec3(1, -infinity, 1));
    addFilmSample(batch, 2, Vec3(2, 2, 2));
    addFilmSample(batch, 3, Vec3(1, 1, nan));
    p = mergeFilmBatch(p, batch);
    EXPECT_EQ(p.rejected, 3);
    EXPECT_EQ(filmCount(p), 1);
    EXPECT_EQ(filmMean(p), Vec3(2.0f));
    EXPECT_EQ(filmVarianceOfMean(p), Vec3(0.0f));
    EXPECT_EQ(filmHalfDifference(p), Vec3(0.0f));
}

TEST(Accumulate, HoldsNoNumberWithoutSamples) {
    const FilmPixel p = mergeFilmBatch(emptyFilmPixel(), startFilmBatch(emptyFilmPixel()));
    EXPECT_EQ(filmMean(p), Vec3(0.0f));
    EXPECT_EQ(filmVarianceOfMean(p), Vec3(0.0f));
    EXPECT_EQ(filmHalfDifference(p), Vec3(0.0f));
}

TEST(Accumulate, HugeSamplesGiveAnInfiniteVarianceAndNoNan) {
    FilmPixel p = emptyFilmPixel();
    for (uint i = 0; i < 100; ++i) {
        FilmBatch batch = startFilmBatch(p);
        for (uint k = 0; k < 4; ++k) addFilmSample(batch, k, Vec3((i + k) % 3 == 0 ? 1e30f : 5e29f));
        addFilmSample(batch, 4, Vec3(3e38f));  // counted as not finite
        p = mergeFilmBatch(p, batch);
    }
    EXPECT_NEAR(filmMean(p).x / 6.67e29f, 1, 0.01);
    EXPECT_TRUE(std::isinf(filmVarianceOfMean(p).x));
    EXPECT_EQ(p.rejected, 100);
}

}  // namespace
}  // namespace helio
