// Filters drawn by importance sampling against their closed forms. Literals here are floats.
#include "engine/core/shared.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace helio {
namespace {

using namespace shared32;

constexpr double pi = 3.14159265358979323846L;

/// Distribution functions from their definitions.
double boxCdf(double x) {
    return std::clamp(x + 0.5, 0.0 * x, 0 * x + 1);
}
double tentCdf(double x) {
    return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}
double gaussianCdf(double x) {
    return verify::normalCdf(x / 0.5);
}
double blackmanHarrisCdf(double x) {
    const double t = x / 1.5, a0 = 0.35875L, a1 = 0.48829L, a2 = 0.14128L, a3 = 0.01168L;
    return 0.5 + (a0 * t + a1 * std::sin(pi * t) / pi + a2 * std::sin(2 * pi * t) / (2 * pi) +
                  a3 * std::sin(3 * pi * t) / (3 * pi)) /
                     (2 * a0);
}

struct Case {
    const char* name;
    uint kind;
    std::function<double(double)> cdf;
    double variance, radius, cdfError;
};

const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"box", FILTER_BOX, boxCdf, 1 / 12.0L, 0.5, 1e-7},
        {"tent", FILTER_TENT, tentCdf, 1 / 6.0L, 1, 1e-7},
        {"gaussian", FILTER_GAUSSIAN, gaussianCdf, 0.25, 2.72L, 1e-6},
        {"Blackman-Harris", FILTER_BLACKMAN_HARRIS, blackmanHarrisCdf, 0.17265848L, 1.5, 5e-6},
    };
    return all;
}

TEST(Filter, OffsetsInvertTheDistributionFunction) {
    for (const Case& c : cases()) {
        double worst = 0;
        float before = -10;
        for (uint i = 0; i < (1u << 24); i += i < 4096 || i > (1u << 24) - 4096 ? 1 : 1021) {
            const float u = float(i) / 16777216.0f;
            const float x = filterOffset1D(c.kind, u);
            worst = std::max(worst, std::abs(c.cdf(x) - (double(u) + std::ldexp(1.0, -25))));
            EXPECT_GE(x, before) << c.name << " at " << u;
            EXPECT_LE(std::abs(x), c.radius) << c.name;
            before = x;
        }
        EXPECT_LT(worst, c.cdfError) << c.name;
    }
}

TEST(Filter, IsSymmetric) {
    for (const Case& c : cases()) {
        for (uint i = 0; i < (1u << 23); i += 4099) {
            const float low = filterOffset1D(c.kind, float(i) / 16777216.0f);
            const float high = filterOffset1D(c.kind, float((1u << 24) - 1 - i) / 16777216.0f);
            EXPECT_EQ(low, -high) << c.name;
        }
    }
}

TEST(Filter, MomentsMatchTheClosedForm) {
    for (const Case& c : cases()) {
        double second = 0, first = 0;
        const uint n = 1u << 20;
        for (uint i = 0; i < n; ++i) {
            const double x = filterOffset1D(c.kind, (float(i) + 0.5f) / float(n));
            first += x / n;
            second += x * x / n;
        }
        EXPECT_NEAR(first, 0, 1e-6) << c.name;
        EXPECT_NEAR(second, c.variance, 1e-4 * c.variance) << c.name;
    }
}

TEST(Filter, SampledOffsetsFollowTheFilter) {
    for (const Case& c : cases()) {
        constexpr int cells = 200;
        constexpr int samples = 1 << 20;
        std::vector<double> observed(cells), expected(cells);
        for (int k = 0; k < cells; ++k) {
            const double low = c.radius * (2.0 * k / cells - 1),
                         high = c.radius * (2.0 * (k + 1) / cells - 1);
            expected[std::size_t(k)] = samples * (c.cdf(high) - c.cdf(low));
        }
        for (uint i = 0; i < samples; ++i) {
            const Vec2 u = sample2D(SAMPLER_INDEPENDENT, startSample(SAMPLER_INDEPENDENT, i, 0, 0), 0);
            const double x = filterOffset(c.kind, u).y;
            ++observed[std::size_t(std::clamp(int((x / c.radius + 1) / 2 * cells), 0, cells - 1))];
        }
        EXPECT_GT(verify::chiSquaredTest(observed, expected).pValue, 1e-4) << c.name;
    }
}

}  // namespace
}  // namespace helio
