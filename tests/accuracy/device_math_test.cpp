// The elementary functions on the device: the bounds that hold on the host hold there, and results are those
// of the C++ float build bit by bit, since every operation that rounds is IEEE's and in one order.
#include "tests/accuracy/math_functions.hpp"
#include "tests/support/device.hpp"
#include "tests/support/shader_harness.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

namespace {

using namespace helio;
using namespace helio::test;

constexpr const char* kMath = "shaders/shared/math.glsl";

/// How many results differ in bits; NaNs are alike.
std::size_t bitDifferences(const std::vector<float>& got, const std::vector<float>& host,
                           std::size_t& first) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const bool same = std::bit_cast<std::uint32_t>(got[i]) == std::bit_cast<std::uint32_t>(host[i]) ||
                          (std::isnan(got[i]) && std::isnan(host[i]));
        if (!same && count++ == 0) first = i;
    }
    return count;
}

bool roundsCorrectly() {
    return device().info().type == "cpu";
}

TEST(DeviceMath, UnaryFunctionsKeepTheirBounds) {
    for (const auto& f : unaryFunctions()) {
        const auto inputs = testInputs(f.low, f.high, 600'000, 101);
        const auto onDevice = runOnDevice<float>(kMath, f.glsl, inputs);
        double worst = 0;
        float where = 0;
        std::vector<float> host;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const double error = verify::ulpError(onDevice[i], f.reference(inputs[i]));
            if (!(error <= worst)) worst = error, where = inputs[i];
            host.push_back(f.host(inputs[i]));
        }
        std::size_t first = 0;
        const std::size_t different = bitDifferences(onDevice, host, first);
        std::printf("%-14s %8zu inputs, worst %.3f ULP at %.9g (bound %.1f), %zu differ from the host\n",
                    f.name.c_str(), inputs.size(), worst, where, f.boundUlp, different);
        EXPECT_GE(inputs.size(), 1'000'000u) << f.name;
        EXPECT_LE(worst, f.boundUlp) << f.name << " at " << where;
        if (roundsCorrectly()) {
            EXPECT_EQ(different, 0u) << f.name << " first at " << inputs[first] << ": " << onDevice[first]
                                     << " on the device, " << host[first] << " on the host";
        }
    }
}

TEST(DeviceMath, PowAndAtan2KeepTheirBounds) {
    std::mt19937_64 random(102);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<float> bases, exponents, ys, xs;
    for (int i = 0; i < 1'500'000; ++i) {
        const double logX =
            i % 2 ? unit(random) * 126 : std::ldexp(unit(random), -static_cast<int>(random() % 23));
        const float x = static_cast<float>(std::exp2(logX));
        const float y = static_cast<float>(unit(random) * 126.9 / std::log2(double{x}));
        const double exact = std::pow(double{x}, double{y});
        if (x != 1 && exact > std::numeric_limits<float>::min() &&
            exact < std::numeric_limits<float>::max()) {
            bases.push_back(x);
            exponents.push_back(y);
        }
        const double magnitude = unit(random) * 100;
        const double other = i % 2 ? magnitude + unit(random) * 8 : magnitude + unit(random) * 24;
        xs.push_back(
            std::copysign(static_cast<float>(std::exp2(magnitude)), static_cast<float>(unit(random))));
        ys.push_back(std::copysign(static_cast<float>(std::exp2(other)), static_cast<float>(unit(random))));
    }
    const auto powers = runOnDevice<float>(kMath, "realPow(a, b)", bases, exponents);
    const auto angles = runOnDevice<float>(kMath, "realAtan2(a, b)", ys, xs);
    double worstPower = 0, worstAngle = 0;
    std::vector<float> hostPowers, hostAngles;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        worstPower = std::max(worstPower,
                              verify::ulpError(powers[i], std::pow(double{bases[i]}, double{exponents[i]})));
        hostPowers.push_back(shared32::realPow(bases[i], exponents[i]));
    }
    for (std::size_t i = 0; i < angles.size(); ++i) {
        worstAngle =
            std::max(worstAngle, verify::ulpError(angles[i], std::atan2(double{ys[i]}, double{xs[i]})));
        hostAngles.push_back(shared32::realAtan2(ys[i], xs[i]));
    }
    std::size_t first = 0;
    const std::size_t powerBits = bitDifferences(powers, hostPowers, first);
    const std::size_t angleBits = bitDifferences(angles, hostAngles, first);
    std::printf(
        "realPow %zu inputs, worst %.3f ULP, %zu differ; realAtan2 %zu inputs, worst %.3f ULP, %zu differ\n",
        powers.size(), worstPower, powerBits, angles.size(), worstAngle, angleBits);
    EXPECT_GE(powers.size(), 1'000'000u);
    EXPECT_LE(worstPower, 1.2);
    EXPECT_LE(worstAngle, 1.7);
    if (roundsCorrectly()) {
        EXPECT_EQ(powerBits, 0u);
        EXPECT_EQ(angleBits, 0u);
    }
}

TEST(DeviceMath, SpecialValuesAreThoseOfTheHost) {
    std::vector<float> values;  // no subnormals: devices may flush them
    for (float x : specialFloats())
        if (x == 0 || !(std::fabs(x) < std::numeric_limits<float>::min())) values.push_back(x);
    for (float x : {2.f, -2.f, 3.f, -3.f, 0.5f, -0.5f, 2.5f, -2.5f, 1000.f, -1000.f}) values.push_back(x);
    for (const auto& f : unaryFunctions()) {
        const auto onDevice = runOnDevice<float>(kMath, f.glsl, values);
        std::vector<float> host;
        for (float x : values) host.push_back(f.host(x));
        std::size_t first = 0;
        EXPECT_EQ(bitDifferences(onDevice, host, first), 0u)
            << f.name << "(" << values[first] << ") is " << onDevice[first] << ", on the host "
            << host[first];
    }
    std::vector<float> a, b;
    for (float x : values)
        for (float y : values) a.push_back(x), b.push_back(y);
    const auto powers = runOnDevice<float>(kMath, "realPow(a, b)", a, b);
    const auto angles = runOnDevice<float>(kMath, "realAtan2(a, b)", a, b);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double power = std::pow(double{a[i]}, double{b[i]});
        if (std::isnan(power)) {
            EXPECT_TRUE(std::isnan(powers[i])) << a[i] << " " << b[i];
        } else if (power == 0 || std::fabs(power) >= std::numeric_limits<float>::min()) {
            EXPECT_LE(verify::ulpError(powers[i], power), 1.2) << a[i] << " ^ " << b[i] << " = " << powers[i];
        }
        const double angle = std::atan2(double{a[i]}, double{b[i]});
        if (std::isnan(angle)) {
            EXPECT_TRUE(std::isnan(angles[i])) << a[i] << " " << b[i];
        } else if (angle == 0 || std::fabs(angle) >= std::numeric_limits<float>::min()) {
            EXPECT_LE(verify::ulpError(angles[i], angle), 1.7) << a[i] << " " << b[i];
        }
    }
}

TEST(DeviceMath, SumsAndProductsLoseNothing) {
    std::mt19937_64 random(103);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<float> a, b;
    for (int i = 0; i < 1'000'000; ++i) {
        a.push_back(static_cast<float>(std::ldexp(unit(random), static_cast<int>(random() % 60) - 30)));
        b.push_back(static_cast<float>(std::ldexp(unit(random), static_cast<int>(random() % 60) - 30)));
    }
    const char* file = "shaders/shared/error_free.glsl";
    const auto sums =
        runOnDevice<glm::vec2>(file, "float e; float s = twoSum(a, b, e); return vec2(s, e);", a, b);
    const auto products =
        runOnDevice<glm::vec2>(file, "float e; float p = twoProduct(a, b, e); return vec2(p, e);", a, b);
    for (std::size_t i = 0; i < a.size(); ++i) {
        // Exact: a product of floats in double, the sum in long double where exponents are within 2^40.
        ASSERT_EQ(double{products[i].x} + products[i].y, double{a[i]} * b[i]) << a[i] << " " << b[i];
        const long double sum = static_cast<long double>(sums[i].x) + sums[i].y;
        if (std::fabs(std::ilogb(a[i]) - std::ilogb(b[i])) < 39) {
            ASSERT_EQ(sum, static_cast<long double>(a[i]) + b[i]) << a[i] << " " << b[i];
        }
    }
}

TEST(DeviceMath, QuadraticRoots) {
    std::mt19937_64 random(104);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<glm::vec3> equations;
    for (int i = 0; i < 300'000; ++i) {
        glm::vec3 e(unit(random), unit(random), unit(random));
        if (i % 2) e.z = static_cast<float>(double{e.y} * e.y / (4 * double{e.x}));  // nearly a double root
        equations.push_back(e);
    }
    const auto roots = runOnDevice<glm::vec3>("shaders/shared/error_free.glsl",
                                              "float l, h; int n = solveQuadratic(a.x, a.y, a.z, l, h); "
                                              "return n == 2 ? vec3(n, l, h) : vec3(n, 0, 0);",
                                              equations);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const long double a = equations[i].x, b = equations[i].y, c = equations[i].z;
        const long double discriminant =
            b * b - 4 * a * c;  // 49 bits each: exact but for the last difference
        ASSERT_EQ(roots[i].x, discriminant < 0 ? 0 : 2) << i;
        if (discriminant < 0) continue;
        const long double q = -0.5L * (b + std::copysign(std::sqrt(discriminant), b));
        const long double x1 = q / a, x2 = c / q;
        ASSERT_LE(verify::ulpError(roots[i].y, double(std::min(x1, x2))), 3) << i;
        ASSERT_LE(verify::ulpError(roots[i].z, double(std::max(x1, x2))), 3) << i;
    }
}

}  // namespace
