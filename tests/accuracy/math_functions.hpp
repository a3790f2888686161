#pragma once
/** @file
 * The elementary functions of shaders/shared with what is claimed of each: domain, reference, worst error.
 * Host and device tests both work through this table.
 */
#include "engine/core/shared.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace helio::test {

/** A function of one number. */
struct UnaryFunction {
    std::string name;
    std::string glsl;             ///< an expression of `a`, or a function's body
    float (*host)(float);         ///< the float build
    double (*reference)(double);  ///< C's
    float low, high;              ///< domain on which the bound holds
    double boundUlp;              ///< worst error, in ULP of the result, over every float of the domain
};

inline float sineOfTurns(float u) {
    float s, c;
    shared32::sinCosTurns(u, s, c);
    return s;
}
inline float cosineOfTurns(float u) {
    float s, c;
    shared32::sinCosTurns(u, s, c);
    return c;
}
/** sin(2 pi u) with the octants taken off before pi comes in. */
inline double sineOfTurnsReference(long double u) {
    const long double twoPi = 6.283185307179586476925286766559L;
    long double t = u - std::nearbyint(u);
    if (t > 0.25L) t = 0.5L - t;
    if (t < -0.25L) t = -0.5L - t;
    const long double s = std::fabs(t) > 0.125L ? std::copysign(std::cos(twoPi * (0.25L - std::fabs(t))), t)
                                                : std::sin(twoPi * t);
    return static_cast<double>(s);
}
/** Whole turns are dropped first: a quarter more is then exact. */
inline double cosineOfTurnsReference(long double u) {
    return sineOfTurnsReference((u - std::nearbyint(u)) + 0.25L);
}

/** Bounds were measured over every float of each domain, not only over those that tests sample. */
inline const std::vector<UnaryFunction>& unaryFunctions() {
    using namespace shared32;
    static const std::vector<UnaryFunction> table = {
        {"realExp", "realExp(a)", realExp, [](double x) { return std::exp(x); }, -87.3f, 88.72f, 1.0},
        {"realExp2", "realExp2(a)", realExp2, [](double x) { return std::exp2(x); }, -126.f, 127.99f, 1.0},
        {"realExpm1", "realExpm1(a)", realExpm1, [](double x) { return std::expm1(x); }, -120.f, 88.72f, 1.7},
        {"realLog", "realLog(a)", realLog, [](double x) { return std::log(x); }, 1.18e-38f, 3.4e38f, 1.0},
        {"realLog2", "realLog2(a)", realLog2, [](double x) { return std::log2(x); }, 1.18e-38f, 3.4e38f, 1.0},
        {"realLog1p", "realLog1p(a)", realLog1p, [](double x) { return std::log1p(x); }, -0.99999994f,
         3.4e38f, 1.0},
        {"realSin", "realSin(a)", realSin, [](double x) { return std::sin(x); }, -1e5f, 1e5f, 1.1},
        {"realCos", "realCos(a)", realCos, [](double x) { return std::cos(x); }, -1e5f, 1e5f, 1.1},
        {"realTan", "realTan(a)", realTan, [](double x) { return std::tan(x); }, -1e5f, 1e5f, 2.9},
        {"sineOfTurns", "float s, c; sinCosTurns(a, s, c); return s;", sineOfTurns,
         [](double x) { return sineOfTurnsReference(x); }, -1e6f, 1e6f, 1.8},
        {"cosineOfTurns", "float s, c; sinCosTurns(a, s, c); return c;", cosineOfTurns,
         [](double x) { return cosineOfTurnsReference(x); }, -1e6f, 1e6f, 1.8},
        {"realAsin", "realAsin(a)", realAsin, [](double x) { return std::asin(x); }, -1.f, 1.f, 1.4},
        {"realAcos", "realAcos(a)", realAcos, [](double x) { return std::acos(x); }, -1.f, 1.f, 1.2},
        {"realAtan", "realAtan(a)", realAtan, [](double x) { return std::atan(x); }, -3.4e38f, 3.4e38f, 1.6},
        {"realErf", "realErf(a)", realErf, [](double x) { return std::erf(x); }, -10.f, 10.f, 1.4},
        {"realErfInverse", "realErfInverse(a)", realErfInverse,
         [](double y) { return shared64::realErfInverse(y); }, -0.99999994f, 0.99999994f, 3.0},
        {"realCbrt", "realCbrt(a)", realCbrt, [](double x) { return std::cbrt(x); }, -3.4e38f, 3.4e38f, 1.0},
    };
    return table;
}

/** Floats as integers in their order, both zeros alike: neighbours differ by 1. */
inline std::int64_t orderOf(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    return bits < 0 ? -std::int64_t{bits & 0x7fffffff} : bits;
}
inline float floatOfOrder(std::int64_t k) {
    return std::bit_cast<float>(k < 0 ? static_cast<std::uint32_t>(-k) | 0x80000000u
                                      : static_cast<std::uint32_t>(k));
}

/** 2 `count` floats of [low, high] and more: evenly over their bit patterns (every binade alike), evenly over
 * values, and those where such functions break: ends, zeros, powers of two and multiples of pi/4 and of 1/8
 * with their neighbours, neighbours of 1. No subnormal numbers: devices may flush them. */
inline std::vector<float> testInputs(float low, float high, int count, std::uint32_t seed) {
    std::vector<float> inputs;
    std::mt19937_64 random(seed);
    auto add = [&](float x) {
        if (x >= low && x <= high && (x == 0 || std::fabs(x) >= std::numeric_limits<float>::min()))
            inputs.push_back(x);
    };
    auto addAround = [&](float x) {
        add(x);
        float up = x, down = x;
        for (int i = 0; i < 3; ++i) {
            add(up = std::nextafterf(up, INFINITY));
            add(down = std::nextafterf(down, -INFINITY));
        }
    };
    addAround(low);
    addAround(high);
    add(0.f);
    add(-0.f);
    for (int e = -126; e <= 127; ++e)
        for (float s : {1.f, -1.f}) {
            addAround(std::ldexp(s, e));
            addAround(1.f + std::ldexp(s, e));
            addAround(std::ldexp(s * 1.41421356f, e));
        }
    const long double quarterPi = 0.785398163397448309615660845820L;
    for (int k = -130000; k <= 130000; ++k) {
        const float x = static_cast<float>(quarterPi * k);
        add(x);
        add(std::nextafterf(x, INFINITY));
        add(std::nextafterf(x, -INFINITY));
    }
    for (int k = -1000; k <= 1000; ++k) addAround(static_cast<float>(k) * 0.125f);
    std::uniform_int_distribution<std::int64_t> keys(orderOf(low), orderOf(high));
    std::uniform_real_distribution<double> values(low, high);
    for (int i = 0; i < count; ++i) {
        add(floatOfOrder(keys(random)));
        add(static_cast<float>(values(random)));
    }
    return inputs;
}

}  // namespace helio::test
