#include <heliograph/verify.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace helio::verify {
namespace {

/** Maps a float's bits to integers in the order of the numbers, 0 and -0 to the same. */
template <typename Signed, typename Float>
Signed ordered(Float x) {
    const auto bits = std::bit_cast<Signed>(x);
    return bits >= 0 ? bits : std::numeric_limits<Signed>::min() - bits;
}

template <typename Signed, typename Float>
std::uint64_t distance(Float a, Float b) {
    if (std::isnan(a) || std::isnan(b)) {
        return std::isnan(a) && std::isnan(b) ? 0 : std::numeric_limits<std::uint64_t>::max();
    }
    const auto x = std::int64_t(ordered<Signed>(a)), y = std::int64_t(ordered<Signed>(b));
    return x > y ? std::uint64_t(x) - std::uint64_t(y) : std::uint64_t(y) - std::uint64_t(x);
}

}  // namespace

Interval relativeMeanSquaredError(std::span<const float> image, std::span<const float> reference,
                                  double confidence) {
    assert(image.size() == reference.size() && confidence > 0 && confidence < 1);
    RunningStatistics terms;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double x = image[i], r = reference[i];
        if (std::isfinite(x) && std::isfinite(r)) terms.add((x - r) * (x - r) / (r * r + 0.01));
    }
    const double half = normalQuantile(0.5 + 0.5 * confidence) * terms.standardError();
    return {terms.mean(), std::max(0.0, terms.mean() - half), terms.mean() + half};
}

std::uint64_t ulpDistance(float a, float b) {
    return distance<std::int32_t>(a, b);
}
std::uint64_t ulpDistance(double a, double b) {
    return distance<std::int64_t>(a, b);
}

double ulpError(float computed, double exact) {
    const float nearest = float(exact);
    if (std::isnan(computed) || std::isnan(exact)) {
        return std::isnan(computed) && std::isnan(exact) ? 0 : std::numeric_limits<double>::infinity();
    }
    if (std::isinf(nearest) || std::isinf(computed)) {
        return computed == nearest ? 0 : std::numeric_limits<double>::infinity();
    }
    const float magnitude = std::abs(nearest);
    const float next = std::nextafter(magnitude, std::numeric_limits<float>::infinity());
    // At the largest float the step is that below it.
    const double ulp = std::isinf(next) ? double(magnitude) - double(std::nextafter(magnitude, 0.0f))
                                        : double(next) - double(magnitude);
    return std::abs(double(computed) - exact) / ulp;
}

Line fitLine(std::span<const double> x, std::span<const double> y) {
    assert(x.size() == y.size() && x.size() >= 2);
    const double n = double(x.size());
    double meanX = 0, meanY = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        meanX += x[i] / n;
        meanY += y[i] / n;
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - meanX) * (x[i] - meanX);
        xy += (x[i] - meanX) * (y[i] - meanY);
    }
    assert(xx > 0);
    Line line;
    line.slope = xy / xx;
    line.intercept = meanY - line.slope * meanX;
    double residual = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = y[i] - line.intercept - line.slope * x[i];
        residual += r * r;
    }
    line.slopeError = x.size() > 2 ? std::sqrt(residual / (n - 2) / xx) : 0;
    return line;
}

Line convergenceOrder(std::span<const double> step, std::span<const double> error) {
    std::vector<double> x, y;
    for (const double h : step) x.push_back(std::log(h));
    for (const double e : error) y.push_back(std::log(e));
    return fitLine(x, y);
}

}  // namespace helio::verify
