#include "engine/film/stray_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace helio {
namespace {

using Rgb = std::array<double, 3>;

double square(double x) {
    return x * x;
}

/** Brightness of a pixel's samples, weighted with itself. 0 where it has none, or none that is finite. */
Rgb sampleBrightness(const FilmImages& images, std::size_t pixel) {
    Rgb result{};
    const double samples = images.mean[4 * pixel + 3];
    for (std::size_t c = 0; c < 3; ++c) {
        const double mean = images.mean[4 * pixel + c], variance = images.variance[4 * pixel + c] * samples;
        const double brightness = variance / mean + mean;
        if (mean > 0 && std::isfinite(brightness)) result[c] = brightness;
    }
    return result;
}

/** The largest of a line's entries within one of each, in its stead. */
template <typename At>
void spread(std::uint32_t length, At at) {
    Rgb before{};
    for (std::uint32_t i = 0; i < length; ++i) {
        const Rgb own = at(i), after = i + 1 < length ? at(i + 1) : Rgb{};
        for (std::size_t c = 0; c < 3; ++c) at(i)[c] = std::max({before[c], own[c], after[c]});
        before = own;
    }
}

}  // namespace

double strayError(const FilmImages& images) {
    const std::size_t width = images.width, pixels = width * images.height;
    std::vector<Rgb> own(pixels);
    for (std::size_t i = 0; i < pixels; ++i) own[i] = sampleBrightness(images, i);
    std::vector<Rgb> around = own;
    for (std::size_t y = 0; y < images.height; ++y)
        spread(images.width, [&](std::size_t x) -> Rgb& { return around[y * width + x]; });
    for (std::size_t x = 0; x < width; ++x)
        spread(images.height, [&](std::size_t y) -> Rgb& { return around[y * width + x]; });
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double samples = images.mean[4 * i + 3];
        if (!(samples > 0)) continue;
        ++count;
        double term = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            if (!(2 * own[i][c] <= around[i][c]) || around[i][c] == 0) continue;
            const double change = around[i][c] / samples;
            const double truth = std::max(0.0f, images.mean[4 * i + c]) + change;
            term += square(change) / (3 * (square(truth) + relMseRegularizer));
        }
        if (std::isfinite(term)) sum += square(term);
    }
    return count > 0 ? std::sqrt(sum) / double(count) : 0;
}

}  // namespace helio
