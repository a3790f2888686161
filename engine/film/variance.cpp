#include "engine/film/variance.hpp"

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

constexpr std::uint32_t windowRadius = 3;  // pixels around the centre
constexpr double priorPixels = 16;         // weight of the image's own ratio

/** Ratios of pixels, d^2 over the film's variance, summed over the channels of each. */
struct Ratios {
    double sum = 0, count = 0;
    Ratios& operator+=(const Ratios& other) {
        sum += other.sum;
        count += other.count;
        return *this;
    }
};

/** Every pixel counts alike, be it bright or dark. */
Ratios ratioAt(const FilmImages& images, std::size_t pixel) {
    if (images.difference[4 * pixel + 3] == 0) return {};
    double measured = 0, independent = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double d = images.difference[4 * pixel + c], v = images.variance[4 * pixel + c];
        measured += d * d;
        independent += v;
    }
    if (!(independent > 0) || !std::isfinite(measured) || !std::isfinite(independent)) return {};
    return {measured / independent, 1};
}

/** Sums over a window of 2 windowRadius + 1 along a line, by adding up afresh: no drift, few terms. */
template <typename At>
Ratios windowRatios(std::uint32_t centre, std::uint32_t extent, At at) {
    Ratios sum;
    const std::uint32_t first = centre < windowRadius ? 0 : centre - windowRadius;
    const std::uint32_t last = std::min(centre + windowRadius, extent - 1);
    for (std::uint32_t i = first; i <= last; ++i) sum += at(i);
    return sum;
}

}  // namespace

std::vector<float> varianceOfMean(const FilmImages& images) {
    const std::size_t pixels = std::size_t(images.width) * images.height;
    std::vector<float> result(images.variance);
    for (std::size_t i = 3; i < result.size(); i += 4) result[i] = 0;
    std::vector<Ratios> rows(pixels);
    Ratios all;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        const std::size_t row = std::size_t(y) * images.width;
        for (std::uint32_t x = 0; x < images.width; ++x) {
            all += ratioAt(images, row + x);
            rows[row + x] =
                windowRatios(x, images.width, [&](std::uint32_t i) { return ratioAt(images, row + i); });
        }
    }
    if (all.count == 0) return result;
    const double imageRatio = all.sum / all.count;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            const Ratios sum = windowRatios(
                y, images.height, [&](std::uint32_t i) { return rows[std::size_t(i) * images.width + x]; });
            const double ratio = (sum.sum + priorPixels * imageRatio) / (sum.count + priorPixels);
            const std::size_t at = 4 * (std::size_t(y) * images.width + x);
            for (std::size_t c = 0; c < 3; ++c) result[at + c] = float(images.variance[at + c] * ratio);
        }
    }
    return result;
}

}  // namespace helio
