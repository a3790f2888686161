#include "bench_judge.hpp"

#include <heliograph/error.hpp>
#include <heliograph/verify.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace helio::cli {
namespace {

/** Calls use(i, value) with every R, G, B of the image in the order of Truth::rgb. */
template <typename Use>
void forEachValue(const ImageF& image, const Use& use) {
    const std::array channels = {image.channel("R"), image.channel("G"), image.channel("B")};
    const std::size_t pixels = std::size_t(image.width) * image.height, stride = image.channels.size();
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        for (std::size_t c = 0; c < 3; ++c)
            use(3 * pixel + c, double(image.data[pixel * stride + std::size_t(channels[c])]));
    }
}

/** Shorter renders, and those of little more than one sample, are partly what a render takes whatever its
 * samples. */
constexpr double kLeastSeconds = 0.02, kLeastOfFirst = 8;

double relative(double squaredError, double truth) {
    return squaredError / (truth * truth + 0.01);
}

}  // namespace

Truth truthFromHalves(const ImageF& first, const ImageF& second) {
    Truth truth;
    truth.rgb.resize(3 * std::size_t(first.width) * first.height);
    const double values = double(truth.rgb.size());
    std::vector<double> other(truth.rgb.size());
    forEachValue(second, [&](std::size_t i, double value) { other[i] = value; });
    forEachValue(first, [&](std::size_t i, double value) {
        truth.rgb[i] = 0.5 * (value + other[i]);
        const double squared = 0.25 * (value - other[i]) * (value - other[i]);
        truth.residualMse += squared / values;
        truth.residual += relative(squared, truth.rgb[i]) / values;
    });
    return truth;
}

PictureError pictureError(const ImageF& image, const Truth& truth) {
    PictureError error{-truth.residualMse, -truth.residual};
    const double values = double(truth.rgb.size());
    forEachValue(image, [&](std::size_t i, double value) {
        const double squared = (value - truth.rgb[i]) * (value - truth.rgb[i]);
        error.mse += squared / values;
        error.relmse += relative(squared, truth.rgb[i]) / values;
    });
    return error;
}

ImageF differencePicture(const ImageF& image, const Truth& truth) {
    ImageF result = truthPicture(truth, image.width, image.height);
    forEachValue(image, [&](std::size_t i, double value) {
        result.data[i] =
            float(std::sqrt(relative((value - truth.rgb[i]) * (value - truth.rgb[i]), truth.rgb[i])));
    });
    return result;
}

ImageF truthPicture(const Truth& truth, std::uint32_t width, std::uint32_t height) {
    ImageF image{width, height, {"R", "G", "B"}, {truth.rgb.begin(), truth.rgb.end()}, {}};
    return image;
}

Display displayOf(const Truth& truth) {
    double mean = 0;
    for (const double value : truth.rgb) mean += value / double(truth.rgb.size());
    return {.exposure = std::min(0.0, -std::log2(std::max(mean, 1e-30) / 0.5))};
}

SeriesFit fitSeries(std::span<const SeriesPoint> points) {
    std::vector<double> samples, errors, steady;
    double last = 0;
    for (const SeriesPoint& point : points) {
        if (!(point.relmse > 0)) continue;
        samples.push_back(point.samples);
        errors.push_back(point.relmse);
        last = point.relmse * point.cpuSeconds;
        const double least = std::max(kLeastSeconds, kLeastOfFirst * points.front().cpuSeconds);
        if (point.cpuSeconds >= least) steady.push_back(std::sqrt(last));
    }
    SeriesFit fit;
    if (samples.size() < 3) return fit;
    const verify::Line line = verify::convergenceOrder(samples, errors);
    fit.order = line.slope;
    fit.orderError = line.slopeError;
    if (last > 0) fit.efficiency = 1 / last;
    double mean = 0;
    fit.steadyPoints = steady.size();
    for (const double value : steady) mean += value / double(steady.size());
    for (const double value : steady)
        fit.unsteadiness = std::max(fit.unsteadiness, std::abs(value / mean - 1));
    return fit;
}

}  // namespace helio::cli
