#include "engine/film/sample_allocation.hpp"

#include "engine/film/error_estimate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

constexpr std::uint32_t radius = 2;  // of the neighbourhood, pixels
constexpr double largestShare = 16;  // the path tracer takes 4096 samples at a time
/** Added to relative variances, of their mean: nobody is sure of a quiet pixel, least of all after few
 * samples. */
double benefitOfDoubt(std::uint32_t pilot) {
    return 0.2 + 2.0 / pilot;
}

/** A pixel's relative variance: half from the difference of the halves, which knows how far samples are
 * stratified, half from the samples' variance times the picture's `gain`, which is less noisy. */
double relativeVariance(const FilmImages& film, std::size_t pixel, double gain) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double x = film.mean[4 * pixel + c], d = film.difference[4 * pixel + c];
        const double both = 0.5 * (d * d + gain * film.variance[4 * pixel + c]);
        const double relative = both / (x * x + relMseRegularizer);
        if (std::isfinite(relative)) sum += relative;
    }
    return sum;
}

/** Sum of a window's values along a line, by adding up afresh. */
template <typename At>
double windowSum(std::uint32_t centre, std::uint32_t extent, At at) {
    double sum = 0;
    for (std::uint32_t i = centre < radius ? 0 : centre - radius; i <= std::min(centre + radius, extent - 1);
         ++i)
        sum += at(i);
    return sum;
}

std::uint32_t windowExtent(std::uint32_t centre, std::uint32_t extent) {
    return std::min(centre + radius, extent - 1) - (centre < radius ? 0 : centre - radius) + 1;
}

}  // namespace

std::uint32_t pilotSamples(std::uint32_t samples) {
    return std::min(samples, std::clamp(samples / 4, 8u, 64u));
}

SampleAllocation::SampleAllocation(std::vector<float> shares, std::uint32_t pilot)
    : shares_(std::move(shares)), pilot_(pilot) {}

SampleAllocation::SampleAllocation(const FilmImages& film, std::uint32_t pilot) : pilot_(pilot) {
    const std::uint32_t width = film.width, height = film.height;
    const std::size_t pixels = std::size_t(width) * height;
    const double gain = std::min(1.0, stratificationGain(film));
    std::vector<double> own(pixels), rows(pixels), around(pixels);
    for (std::size_t i = 0; i < pixels; ++i) own[i] = relativeVariance(film, i, gain);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            rows[std::size_t(y) * width + x] =
                windowSum(x, width, [&](std::uint32_t u) { return own[std::size_t(y) * width + u]; });
    double mean = 0;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::size_t i = std::size_t(y) * width + x;
            const double count = double(windowExtent(x, width)) * windowExtent(y, height) - 1;
            const double sum =
                windowSum(y, height, [&](std::uint32_t v) { return rows[std::size_t(v) * width + x]; });
            // Without the pixel itself: what its own term leaves behind is rounding.
            around[i] = count > 0 ? std::max(0.0, sum - own[i]) / count : 0;
            mean += around[i] / double(pixels);
        }
    }
    shares_.resize(pixels);
    double sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        // Least sum of variance / samples for a given sum of samples: proportional to the root.
        shares_[i] = mean > 0 ? float(std::sqrt(around[i] / mean + benefitOfDoubt(pilot))) : 1.0f;
        sum += shares_[i];
    }
    for (float& share : shares_) share = float(std::min(share * double(pixels) / sum, largestShare));
}

std::vector<std::uint32_t> SampleAllocation::samples(double average) const {
    const auto fewest = double(pilot_);
    const auto total = [&](double factor) {
        double sum = 0;
        for (const float share : shares_) sum += std::max(fewest, factor * share);
        return sum;
    };
    const double wanted = std::max(average, fewest) * double(shares_.size());
    double low = 0, high = fewest;
    while (total(high) < wanted) high *= 2;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (total(middle) < wanted ? low : high) = middle;
    }
    std::vector<std::uint32_t> result(shares_.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = std::max(pilot_, 2 * std::uint32_t(std::lround(0.5 * low * shares_[i])));
    return result;
}

}  // namespace helio
