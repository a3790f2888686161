// Statistics against published tables and exact values.
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace helio::verify {
namespace {

TEST(Distributions, NormalMatchesTables) {
    EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-13);
    EXPECT_NEAR(normalQuantile(0.995), 2.575829303548901, 1e-13);
    EXPECT_NEAR(normalQuantile(1e-12), -7.034483825301131, 1e-11);
    EXPECT_NEAR(normalCdf(1), 0.8413447460685429, 1e-15);
    EXPECT_NEAR(normalCdf(-6) / 9.865876450376981e-10, 1, 1e-12);
    EXPECT_NEAR(normalQuantile(0.5), 0, 1e-17);
}

TEST(Distributions, ChiSquaredMatchesTables) {
    // Critical values of the NIST/SEMATECH handbook, table 1.3.6.7.4.
    EXPECT_NEAR(chiSquaredPValue(3.841, 1), 0.05, 2e-5);
    EXPECT_NEAR(chiSquaredPValue(23.209, 10), 0.01, 1e-6);
    EXPECT_NEAR(chiSquaredPValue(149.449, 100), 0.001, 1e-7);
    EXPECT_NEAR(chiSquaredPValue(77.929, 100), 0.95, 1e-5);
    // Two degrees of freedom: exactly exp(-x / 2).
    for (const double x : {1e-6, 0.1, 2.0, 5.0, 50.0, 700.0}) {
        EXPECT_NEAR(chiSquaredPValue(x, 2) / std::exp(-x / 2), 1, 1e-12) << x;
    }
    // Many degrees: the normal limit by Wilson and Hilferty.
    const double n = 1e6, z = 2, x = n * std::pow(1 - 2 / (9 * n) + z * std::sqrt(2 / (9 * n)), 3);
    EXPECT_NEAR(chiSquaredPValue(x, n), normalCdf(-z), 1e-6);
}

TEST(Distributions, StudentMatchesTables) {
    EXPECT_NEAR(studentPValue(12.706204736174705, 1), 0.05, 1e-12);
    EXPECT_NEAR(studentPValue(2.2281388519862744, 10), 0.05, 1e-12);
    EXPECT_NEAR(studentPValue(3.3900, 100), 0.001, 1e-5);
    EXPECT_NEAR(studentPValue(1, 1), 0.5, 1e-14);
}

TEST(Sidak, MatchesTheFormula) {
    EXPECT_NEAR(sidakLevel(0.05, 10), 0.005116196891823743, 1e-16);
    EXPECT_NEAR(sidakLevel(0.01, 1000000) * 1e6, 0.010050335853501, 1e-9);
    EXPECT_EQ(sidakLevel(0.05, 1), 0.05);
}

TEST(ChiSquaredTest, JudgesADieAsTheTextbookDoes) {
    // 60 throws: sum of (o - 10)^2 / 10 = 1.2 with 5 degrees of freedom.
    const std::vector<double> observed = {9, 11, 9, 11, 12, 8}, expected(6, 10.0);
    const ChiSquaredResult result = chiSquaredTest(observed, expected);
    EXPECT_NEAR(result.statistic, 1.2, 1e-14);
    EXPECT_EQ(result.degrees, 5);
    EXPECT_NEAR(result.pValue, 0.9448773650, 1e-10);
}

TEST(ChiSquaredTest, PoolsSmallCellsAndRefusesTheImpossible) {
    const std::vector<double> expected = {1, 1, 2, 2, 50, 44}, observed = {2, 0, 2, 2, 48, 46};
    const ChiSquaredResult result = chiSquaredTest(observed, expected);
    EXPECT_EQ(result.pooled, 4u);
    EXPECT_EQ(result.degrees, 2);
    const std::vector<double> none = {0, 100}, some = {1, 99};
    EXPECT_EQ(chiSquaredTest(some, none).pValue, 0);
}

TEST(ChiSquaredTest, PValuesOfTrueHypothesesAreUniform) {
    std::mt19937 random(7);
    RunningStatistics p;
    int below = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        std::vector<double> observed(16), expected(16, 1000 / 16.0);
        for (int i = 0; i < 1000; ++i) ++observed[random() % 16];
        const double value = chiSquaredTest(observed, expected).pValue;
        p.add(value);
        below += value < 0.05;
    }
    EXPECT_LT(std::abs(zTest(p, 0.5).z), 4);
    EXPECT_NEAR(below / 2000.0, 0.05, 4 * std::sqrt(0.05 * 0.95 / 2000));
}

TEST(RunningStatistics, IsExactFarFromZero) {
    RunningStatistics statistics;
    for (int i = 0; i < 1000000; ++i) statistics.add(1e9 + i % 2);
    EXPECT_DOUBLE_EQ(statistics.mean(), 1e9 + 0.5);
    EXPECT_NEAR(statistics.variance(), 0.25 * 1e6 / (1e6 - 1), 1e-9);
}

TEST(ZTest, FindsABiasAndPassesTheTruth) {
    EXPECT_NEAR(zTest(1.96, 1, 0).pValue, 0.049995790296440, 1e-12);
    EXPECT_EQ(zTest(2, 0, 2).z, 0);
    EXPECT_TRUE(std::isinf(zTest(2, 0, 1).z));
    EXPECT_EQ(zTest(2, 0, 1).pValue, 0);
    EXPECT_EQ(zTest(std::nan(""), 1, 1).pValue, 0);
}

TEST(ImageZTest, SeparatesNoiseFromBiasAndFromOneBadPixel) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    const std::size_t n = 20000;
    std::vector<float> reference(n, 1.0f), variance(n, 0.04f), image(n);
    for (float& x : image) x = 1.0f + 0.2f * normal(random);
    const ImageZResult good = imageZTest(image, variance, reference);
    EXPECT_GT(good.worstPValue, 0.001);
    EXPECT_GT(good.chiSquaredPValue, 0.001);
    EXPECT_LT(std::abs(good.meanZ), 4);
    std::vector<float> biased = image;
    for (float& x : biased) x += 0.01f;
    EXPECT_GT(imageZTest(biased, variance, reference).meanZ, 4);
    std::vector<float> spoilt = image;
    spoilt[1234] = 3;
    const ImageZResult bad = imageZTest(spoilt, variance, reference);
    EXPECT_LT(bad.worstPValue, 1e-10);
    EXPECT_EQ(bad.worstIndex, 1234u);
    std::vector<float> broken = image;
    broken[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(imageZTest(broken, variance, reference).worstPValue, 0);
}

TEST(RelativeMeanSquaredError, KnowsItsDefinitionAndCoversTheTruth) {
    const std::vector<float> image = {1, 2, 0}, reference = {0.5f, 2, 0.1f};
    const Interval exact = relativeMeanSquaredError(image, reference);
    EXPECT_NEAR(exact.value, (0.25 / 0.26 + 0 + 0.01 / 0.02) / 3, 1e-7);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    int covered = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        std::vector<float> x(500), r(500, 1.0f);
        for (float& value : x) value = 1 + 0.1f * normal(random);
        covered += relativeMeanSquaredError(x, r).contains(0.01 / 1.01);
    }
    EXPECT_NEAR(covered / 1000.0, 0.95, 0.03);  // the terms are skewed, so a little below 0.95
}

TEST(UlpDistance, CountsRepresentableNumbers) {
    EXPECT_EQ(ulpDistance(1.0f, std::nextafter(1.0f, 2.0f)), 1u);
    EXPECT_EQ(ulpDistance(0.0f, -0.0f), 0u);
    EXPECT_EQ(
        ulpDistance(std::numeric_limits<float>::denorm_min(), -std::numeric_limits<float>::denorm_min()), 2u);
    EXPECT_EQ(ulpDistance(1.0f, 2.0f), 1u << 23);
    EXPECT_EQ(ulpDistance(-1.0, 1.0), 2 * 0x3ff0000000000000ull);
    EXPECT_EQ(ulpDistance(std::nanf(""), std::nanf("")), 0u);
    EXPECT_EQ(ulpDistance(std::nanf(""), 1.0f), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(ulpDistance(std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()), 1u);
}

TEST(UlpError, HasFractions) {
    EXPECT_NEAR(ulpError(1.0f, 1.0 + 0.25 * std::pow(2.0, -23)), 0.25, 1e-12);
    EXPECT_EQ(ulpError(1.0f, 1.0), 0);
    EXPECT_EQ(ulpError(0.0f, 0.0), 0);
    EXPECT_TRUE(std::isinf(ulpError(std::nanf(""), 1.0)));
    EXPECT_EQ(ulpError(std::numeric_limits<float>::infinity(), 1e39), 0);
}

TEST(FitLine, FindsSlopeAndItsError) {
    const std::vector<double> x = {1, 2, 3, 4}, y = {6, 5, 7, 10};
    const Line line = fitLine(x, y);  // textbook: y = 3.5 + 1.4 x, residual sum of squares 4.2
    EXPECT_NEAR(line.slope, 1.4, 1e-14);
    EXPECT_NEAR(line.intercept, 3.5, 1e-14);
    EXPECT_NEAR(line.slopeError, std::sqrt(4.2 / 2 / 5), 1e-14);
    const std::vector<double> h = {1, 0.5, 0.25, 0.125}, error = {3, 0.75, 0.1875, 0.046875};
    EXPECT_NEAR(convergenceOrder(h, error).slope, 2, 1e-13);
}

}  // namespace
}  // namespace helio::verify
