// Error-free sums and products, differences of products, quadratics and neighbours against exact arithmetic:
// a product of two floats is exact in double, a sum of two such in long double's 64 bits where their
// exponents are close, and
// __float128 holds the rest.
#include "engine/core/shared.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

namespace {

using namespace helio;
using namespace helio::shared32;
__extension__ using Quad = __float128;

/// ULP of `computed` against an exact value that is a double or wider.
double ulpErrorOf(float computed, Quad exact) {
    return verify::ulpError(computed, static_cast<double>(exact));
}

class Floats {
public:
    explicit Floats(std::uint32_t seed) : random_(seed) {}
    /// Either sign, magnitude 2^-range..2^range.
    float wide(double range) {
        const double magnitude = std::exp2(std::uniform_real_distribution<double>(-range, range)(random_));
        return static_cast<float>(random_() & 1 ? magnitude : -magnitude);
    }
    float between(double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random_));
    }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

private:
    std::mt19937_64 random_;
};

TEST(MathErrorFree, SumsAndProductsLoseNothing) {
    Floats random(11);
    for (int i = 0; i < 1'000'000; ++i) {
        const float a = random.wide(30), b = random.wide(30);
        float error;
        float sum = twoSum(a, b, error);
        ASSERT_EQ(Quad(sum) + error, Quad(a) + b) << a << " " << b;
        sum = std::fabs(a) >= std::fabs(b) ? fastTwoSum(a, b, error) : fastTwoSum(b, a, error);
        ASSERT_EQ(Quad(sum) + error, Quad(a) + b) << a << " " << b;
        const float product = twoProduct(a, b, error);
        ASSERT_EQ(double{product} + error, double{a} * b) << a << " " << b;
    }
}

TEST(MathErrorFree, DoubleBuildLosesNothingEither) {
    std::mt19937_64 random(15);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 1'000'000; ++i) {
        const double a = unit(random), b = std::ldexp(unit(random), static_cast<int>(random() % 40) - 20);
        double error;
        const double sum = shared64::twoSum(a, b, error);
        ASSERT_TRUE(Quad(sum) + error == Quad(a) + b) << a << " " << b;
        const double product = shared64::twoProduct(a, b, error);
        ASSERT_TRUE(Quad(product) + error == Quad(a) * b) << a << " " << b;
    }
}

TEST(MathErrorFree, DifferenceOfProductsSurvivesCancellation) {
    Floats random(12);
    double worst = 0, plain = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const float a = random.wide(20), b = random.wide(20), c = random.wide(20);
        // d next to a b / c: all leading bits cancel. Every third is unrelated.
        float d = static_cast<float>(double{a} * b / c);
        for (int k = random.integer(0, 2); k > 0; --k) d = std::nextafter(d, INFINITY);
        if (i % 3 == 0) d = random.wide(20);
        const Quad exact = Quad(a) * b - Quad(c) * d;
        const float computed = differenceOfProducts(a, b, c, d);
        if (exact == 0) {
            ASSERT_EQ(computed, 0);
            continue;
        }
        worst = std::max(worst, ulpErrorOf(computed, exact));
        plain = std::max(plain, ulpErrorOf(a * b - c * d, exact));
    }
    std::printf("differenceOfProducts worst %.3f ULP (plainly %.3g)\n", worst, plain);
    EXPECT_LE(worst, 2);
    EXPECT_GT(plain, 1e5);  // the inputs are hard ones
}

TEST(MathErrorFree, QuadraticRootsOfNearlyEqualAndFarApartRoots) {
    Floats random(13);
    double worst = 0;
    int none = 0, two = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const float a = random.wide(12);
        float b = random.wide(12), c = random.wide(12);
        if (i % 2) c = static_cast<float>(double{b} * b / (4 * double{a}));  // nearly a double root
        if (i % 4 == 3) c = std::nextafter(c, -INFINITY);
        const Quad discriminant = Quad(b) * b - 4 * Quad(a) * c;
        float low, high;
        const int count = solveQuadratic(a, b, c, low, high);
        ASSERT_EQ(count, discriminant < 0 ? 0 : 2) << a << " " << b << " " << c;
        if (count == 0) {
            ++none;
            continue;
        }
        ++two;
        // Exact to long double: the root without cancellation, the other from the product of both.
        const long double root = std::sqrt(static_cast<long double>(discriminant));
        const long double q = -0.5L * (b + std::copysign(root, static_cast<long double>(b)));
        const long double x1 = q / a, x2 = q == 0 ? 0 : c / q;
        ASSERT_LE(low, high);
        worst = std::max({worst, verify::ulpError(low, double(std::min(x1, x2))),
                          verify::ulpError(high, double(std::max(x1, x2)))});
    }
    std::printf("solveQuadratic worst %.3f ULP (%d without, %d with roots)\n", worst, none, two);
    EXPECT_LE(worst, 3);
    EXPECT_GT(none, 100'000);
    EXPECT_GT(two, 100'000);
}

TEST(MathErrorFree, DegenerateQuadratics) {
    float low, high;
    EXPECT_EQ(solveQuadratic(0, 2, -6, low, high), 1);
    EXPECT_EQ(low, 3);
    EXPECT_EQ(high, 3);
    EXPECT_EQ(solveQuadratic(0, 0, 1, low, high), 0);
    EXPECT_EQ(solveQuadratic(0, 0, 0, low, high), 0);
    EXPECT_EQ(solveQuadratic(1, 0, 0, low, high), 2);
    EXPECT_EQ(low, 0);
    EXPECT_EQ(high, 0);
    EXPECT_EQ(solveQuadratic(1, 0, -4, low, high), 2);
    EXPECT_EQ(low, -2);
    EXPECT_EQ(high, 2);
    EXPECT_EQ(solveQuadratic(1, -1e8f, 1, low, high), 2);  // the plain formula gives 0 for the lesser root
    EXPECT_FLOAT_EQ(low, 1e-8f);
    EXPECT_FLOAT_EQ(high, 1e8f);
    EXPECT_EQ(solveQuadratic(1, 2, 1, low, high), 2);
    EXPECT_EQ(low, -1);
    EXPECT_EQ(high, -1);
}

TEST(MathFloatBits, NeighboursAreThoseOfC) {
    Floats random(14);
    const float inf = INFINITY;
    for (float x :
         {0.f, -0.f, 1.f, -1.f, inf, -inf, REAL_MAX, -REAL_MAX, REAL_MIN_NORMAL, -REAL_MIN_NORMAL}) {
        EXPECT_EQ(nextUp(x), std::nextafterf(x, inf)) << x;
        EXPECT_EQ(nextDown(x), std::nextafterf(x, -inf)) << x;
    }
    EXPECT_TRUE(std::isnan(nextUp(NAN)));
    EXPECT_TRUE(std::isnan(nextDown(NAN)));
    for (int i = 0; i < 1'000'000; ++i) {
        const float x = random.wide(125);
        ASSERT_EQ(nextUp(x), std::nextafterf(x, inf));
        ASSERT_EQ(nextDown(x), std::nextafterf(x, -inf));
        const float below = powerOfTwoBelow(x);
        ASSERT_EQ(below, std::ldexp(1.f, std::ilogb(x)));
        ASSERT_EQ(leadingBits(x) + (x - leadingBits(x)), x);
        const int n = random.integer(-100, 100);
        const float scaled = std::ldexp(x, n);
        if (std::isnormal(scaled)) {
            ASSERT_EQ(scaleByPowerOfTwo(x, n), scaled) << x << " " << n;
        }
    }
    EXPECT_EQ(1 / powerOfTwoBelow(0.f), std::ldexp(1.f, 126));
    EXPECT_EQ(powerOfTwoBelow(inf), std::ldexp(1.f, 126));
}

}  // namespace
