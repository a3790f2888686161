#include <heliograph/verify.hpp>

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace helio::verify {
namespace {

/** Regularized upper incomplete gamma function Q(a, x): series below a + 1, Lentz's continued fraction above
 * (DLMF 8.7.1 and 8.9.2). */
double upperGamma(double a, double x) {
    if (x <= 0) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * epsilon; ++n) {
            term *= x / n;
            sum += term;
        }
        return 1 - front * sum;
    }
    constexpr double tiny = std::numeric_limits<double>::min() / epsilon;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
    for (double n = 1; n < 1e6; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = an * d + b;
        if (std::abs(d) < tiny) d = tiny;
        c = b + an / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1 / d;
        h *= d * c;
        if (std::abs(d * c - 1) < 2 * epsilon) break;
    }
    return front * h;
}

/** Regularized incomplete beta function I_x(a, b) by its continued fraction (DLMF 8.17.22). */
double incompleteBeta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(b, a, 1 - x);
    const double front = std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) -
                                  std::lgamma(b)) /
                         a;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    constexpr double tiny = std::numeric_limits<double>::min() / epsilon;
    const auto away = [](double v) { return std::abs(v) < tiny ? tiny : v; };
    double c = 1, d = 1 / away(1 - (a + b) * x / (a + 1)), h = d;
    for (double m = 1; m < 1e5; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / away(1 + even * d);
        c = away(1 + even / c);
        h *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / away(1 + odd * d);
        c = away(1 + odd / c);
        h *= d * c;
        if (std::abs(d * c - 1) < 2 * epsilon) break;
    }
    return front * h;
}

}  // namespace

double normalCdf(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double normalQuantile(double p) {
    assert(p > 0 && p < 1);
    if (p > 0.5) return -normalQuantile(1 - p);
    // Start from Abramowitz and Stegun 26.2.23, |error| < 4.5e-4, then Halley's iteration on the tail.
    const double t = std::sqrt(-2 * std::log(p));
    double z = -(t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                         (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))));
    for (int i = 0; i < 3; ++i) {
        const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
        const double step = (normalCdf(z) - p) / density;
        z -= step / (1 + 0.5 * z * step);
    }
    return z;
}

double chiSquaredPValue(double statistic, double degrees) {
    assert(degrees > 0);
    return upperGamma(0.5 * degrees, 0.5 * statistic);
}

double studentPValue(double t, double degrees) {
    assert(degrees > 0);
    return incompleteBeta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
}

}  // namespace helio::verify
