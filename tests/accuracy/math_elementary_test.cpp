// Elementary functions of the float build against the C library in double, in ULP; special values as in C.
#include "tests/accuracy/math_functions.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

namespace {

using namespace helio;
using test::testInputs;
using test::unaryFunctions;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kLeastNormal = std::numeric_limits<float>::min();

/// With HELIOGRAPH_EXHAUSTIVE in the environment every normal float of each domain is tried: about an hour,
/// from which the errors stated in the library are.
TEST(MathElementary, UnaryFunctionsKeepTheirBounds) {
    for (const auto& f : unaryFunctions()) {
        double worst = 0;
        float where = 0;
        std::size_t count = 0;
        auto check = [&](float x) {
            const double error = verify::ulpError(f.host(x), f.reference(x));
            if (!(error <= worst)) worst = error, where = x;
            ++count;
        };
        for (float x : testInputs(f.low, f.high, 600'000, 1)) check(x);
        if (std::getenv("HELIOGRAPH_EXHAUSTIVE"))
            for (std::int64_t k = test::orderOf(f.low); k <= test::orderOf(f.high); ++k)
                if (std::isnormal(test::floatOfOrder(k))) check(test::floatOfOrder(k));
        std::printf("%-14s %10zu inputs, worst %.3f ULP at %.9g (bound %.1f)\n", f.name.c_str(), count, worst,
                    where, f.boundUlp);
        EXPECT_GE(count, 1'000'000u) << f.name;
        EXPECT_LE(worst, f.boundUlp) << f.name << " at " << where;
    }
}

TEST(MathElementary, PowKeepsItsBoundOverTheNormalRange) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    double worst = 0;
    float worstX = 0, worstY = 0;
    int count = 0;
    for (int i = 0; i < 3'000'000; ++i) {
        // Bases of every magnitude, and bases ever closer to 1 that take exponents up to 1e8; results
        // 2^-126..2^127.
        const double logX =
            i % 2 ? unit(random) * 126 : std::ldexp(unit(random), -static_cast<int>(random() % 23));
        const float x = static_cast<float>(std::exp2(logX));
        if (x == 1) continue;
        const float y = static_cast<float>(unit(random) * 126.9 / std::log2(double{x}));
        const double exact = std::pow(double{x}, double{y});
        if (!(exact >= kLeastNormal && exact <= std::numeric_limits<float>::max())) continue;
        const double error = verify::ulpError(shared32::realPow(x, y), exact);
        if (!(error <= worst)) worst = error, worstX = x, worstY = y;
        ++count;
    }
    std::printf("realPow %d inputs, worst %.3f ULP at (%.9g, %.9g)\n", count, worst, worstX, worstY);
    EXPECT_GT(count, 1'000'000);
    EXPECT_LE(worst, 1.2) << worstX << " " << worstY;
}

TEST(MathElementary, Atan2KeepsItsBoundInEveryQuadrant) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    double worst = 0;
    float worstX = 0, worstY = 0;
    for (int i = 0; i < 3'000'000; ++i) {
        const double magnitude = unit(random) * 120;
        // Ratios of magnitude 2^-8..2^8, and of any.
        const double other = i % 2 ? magnitude + unit(random) * 8 : unit(random) * 120;
        const float x =
            std::copysign(static_cast<float>(std::exp2(magnitude)), static_cast<float>(unit(random)));
        const float y = std::copysign(static_cast<float>(std::exp2(other)), static_cast<float>(unit(random)));
        const double exact = std::atan2(double{y}, double{x});
        if (std::fabs(exact) < kLeastNormal) continue;
        const double error = verify::ulpError(shared32::realAtan2(y, x), exact);
        if (!(error <= worst)) worst = error, worstX = x, worstY = y;
    }
    std::printf("realAtan2 worst %.3f ULP at (%.9g, %.9g)\n", worst, worstY, worstX);
    EXPECT_LE(worst, 1.7) << worstY << " " << worstX;
}

void expectSame(float computed, float expected, const std::string& what) {
    if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(computed)) << what << " gave " << computed;
    else
        EXPECT_EQ(std::bit_cast<std::uint32_t>(computed), std::bit_cast<std::uint32_t>(expected))
            << what << " gave " << computed << ", not " << expected;
}

TEST(MathElementary, SpecialValuesAreThoseOfC) {
    for (float x : {0.f, -0.f, kInfinity, -kInfinity, kNaN, 1000.f, -1000.f, 1.f, -1.f}) {
        const std::string of = "(" + std::to_string(x) + ")";
        // Where the exact result is a float: zero, infinity, NaN or the argument.
        auto check = [&](float computed, float c, const char* name) {
            if (c == 0 || std::isinf(c) || std::isnan(c) || c == x) expectSame(computed, c, name + of);
        };
        check(shared32::realExp(x), std::exp(x), "exp");
        check(shared32::realExp2(x), std::exp2(x), "exp2");
        check(shared32::realExpm1(x), std::expm1(x), "expm1");
        check(shared32::realLog(x), std::log(x), "log");
        check(shared32::realLog2(x), std::log2(x), "log2");
        check(shared32::realLog1p(x), std::log1p(x), "log1p");
        check(shared32::realSin(x), std::sin(x), "sin");
        check(shared32::realCos(x), std::cos(x), "cos");
        check(shared32::realTan(x), std::tan(x), "tan");
        check(shared32::realAsin(x), std::asin(x), "asin");
        check(shared32::realAcos(x), std::acos(x), "acos");
        check(shared32::realAtan(x), std::atan(x), "atan");
        check(shared32::realErf(x), std::erf(x), "erf");
        check(shared32::realCbrt(x), std::cbrt(x), "cbrt");
    }
    EXPECT_EQ(shared32::realExpm1(-kInfinity), -1.f);
    EXPECT_EQ(shared32::realAtan(kInfinity), std::atan(kInfinity));
    for (int n = -126; n <= 127; ++n)
        EXPECT_EQ(shared32::realExp2(static_cast<float>(n)), std::ldexp(1.f, n));
    for (int n = -126; n <= 127; ++n)
        EXPECT_EQ(shared32::realLog2(std::ldexp(1.f, n)), static_cast<float>(n));
}

TEST(MathElementary, PowAndAtan2SpecialValuesAreThoseOfC) {
    const float values[] = {0.f,   -0.f, 1.f,   -1.f,   2.f,    -2.f, 3.f,       -3.f,      0.5f,
                            -0.5f, 2.5f, 1e30f, -1e30f, 1e-30f, kNaN, kInfinity, -kInfinity};
    for (float x : values)
        for (float y : values) {
            const std::string of = "(" + std::to_string(x) + ", " + std::to_string(y) + ")";
            const float power = std::pow(x, y);
            if (power == 0 || std::isinf(power) || std::isnan(power) || power == 1) {
                expectSame(shared32::realPow(x, y), power, "pow" + of);
            } else {
                const double exact = std::pow(double{x}, double{y});
                EXPECT_LE(verify::ulpError(shared32::realPow(x, y), exact), 1.2) << of;
            }
            const double angle = std::atan2(double{x}, double{y});
            if (std::isnan(angle) || angle == 0) {
                expectSame(shared32::realAtan2(x, y), static_cast<float>(angle), "atan2" + of);
            } else if (std::fabs(angle) > kLeastNormal) {
                EXPECT_LE(verify::ulpError(shared32::realAtan2(x, y), angle), 1.7) << of;
            }
        }
}

TEST(MathElementary, InverseErrorFunctionInDoubleUndoesTheErrorFunction) {
    // The reference itself: C has no inverse to compare with.
    for (int i = 1; i < 4000; ++i) {
        const double x = 0.001L * i;
        if (x < 1) {
            EXPECT_NEAR(shared64::realErfInverse(std::erf(x)) / x, 1, 1e-13L) << x;
        }
        // Near 1 the argument's own spacing limits what can come back.
        const double spacing = 1.2e-16L * std::exp(x * x);
        EXPECT_NEAR(shared64::realErfInverse(std::erf(x)), x, spacing + 1e-14L) << x;
    }
    EXPECT_NEAR(shared64::realErfInverse(0.5L), 0.476936276204469873381L, 1e-15L);
    EXPECT_EQ(shared64::realErfInverse(1), INFINITY);
    EXPECT_TRUE(std::isnan(shared64::realErfInverse(1.5L)));
    EXPECT_EQ(shared32::realErfInverse(1), kInfinity);
    EXPECT_EQ(shared32::realErfInverse(-1), -kInfinity);
    EXPECT_TRUE(std::isnan(shared32::realErfInverse(1.5f)));
    EXPECT_TRUE(std::isnan(shared32::realErfInverse(kNaN)));
}

TEST(MathElementary, TurnsAreExactAtQuarters) {
    for (int k = -40; k <= 40; ++k) {
        float s, c;
        shared32::sinCosTurns(static_cast<float>(k) * 0.25f, s, c);
        const float sines[] = {0, 1, 0, -1};
        EXPECT_EQ(s, sines[k & 3]) << k;
        EXPECT_EQ(c, sines[(k + 1) & 3]) << k;
    }
}

}  // namespace
