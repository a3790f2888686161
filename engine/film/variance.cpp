#include "engine/film/variance.hpp"

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

constexpr std::uint32_t radius = 3;  // pixels around the centre
constexpr double priorPixels = 16;   // weight of the image's own ratio

/** What a pixel brings to the ratio, summed over its channels. */
struct Pair {
    double measured = 0, independent = 0, count = 0;
    Pair& operator+=(const Pair& other) {
        measured += other.measured;
        independent += other.independent;
        count += other.count;
        return *this;
    }
};

Pair pairAt(const FilmImages& images, std::size_t pixel) {
    Pair pair;
    if (images.difference[4 * pixel + 3] == 0) return pair;
    for (std::size_t c = 0; c < 3; ++c) {
        const double d = images.difference[4 * pixel + c], v = images.variance[4 * pixel + c];
        if (!std::isfinite(d) || !std::isfinite(v)) return {};
        pair.measured += d * d;
        pair.independent += v;
    }
    pair.count = 1;
    return pair;
}

/** Sums over a window of 2 radius + 1 along a line, by adding up afresh: no drift, few terms. */
template <typename At>
Pair windowSum(std::uint32_t centre, std::uint32_t extent, At at) {
    Pair sum;
    const std::uint32_t first = centre < radius ? 0 : centre - radius;
    const std::uint32_t last = std::min(centre + radius, extent - 1);
    for (std::uint32_t i = first; i <= last; ++i) sum += at(i);
    return sum;
}

}  // namespace

std::vector<float> varianceOfMean(const FilmImages& images) {
    const std::size_t pixels = std::size_t(images.width) * images.height;
    std::vector<float> result(images.variance);
    for (std::size_t i = 3; i < result.size(); i += 4) result[i] = 0;
    std::vector<Pair> rows(pixels);
    Pair all;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        const std::size_t row = std::size_t(y) * images.width;
        for (std::uint32_t x = 0; x < images.width; ++x) {
            all += pairAt(images, row + x);
            rows[row + x] =
                windowSum(x, images.width, [&](std::uint32_t i) { return pairAt(images, row + i); });
        }
    }
    if (all.independent <= 0) return result;
    const double imageRatio = all.measured / all.independent;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            const Pair sum = windowSum(
                y, images.height, [&](std::uint32_t i) { return rows[std::size_t(i) * images.width + x]; });
            if (sum.independent <= 0) continue;
            const double prior = priorPixels * sum.independent / sum.count;
            const double ratio = (sum.measured + prior * imageRatio) / (sum.independent + prior);
            const std::size_t at = 4 * (std::size_t(y) * images.width + x);
            for (std::size_t c = 0; c < 3; ++c) result[at + c] = float(images.variance[at + c] * ratio);
        }
    }
    return result;
}

}  // namespace helio
