#include "engine/film/error_estimate.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

constexpr double regularizer = 0.01;  // of relMSE
constexpr double modelError = 0.03;   // of the logarithm
constexpr double normalQuantile95 = 1.959963984540054;

double finiteOr(double x, double otherwise) {
    return std::isfinite(x) ? x : otherwise;
}

/** What a pixel's truth may be, and how uncertain that is. */
struct Steady {
    double value = 0;
    double noise = 0;  ///< variance of `value`
    /** Denominator of relMSE whose reciprocal is unbiased to first order in the noise: E[1 / v^2] is
     * (1 + 3 noise / v^2) / truth^2. */
    double denominator() const { return value * value + 3 * noise + regularizer; }
};

/** One channel of a film, and the variance of its pixels. */
class Channel {
public:
    Channel(const FilmImages& images, std::size_t channel, double gain)
        : images_(images), channel_(channel), gain_(gain) {}

    Steady own(std::size_t pixel) const {
        const std::size_t i = 4 * pixel + channel_;
        const double d = images_.difference[i];
        return {images_.mean[i], finiteOr(gain_ * images_.variance[i], d * d)};
    }

    /** The pixel's value drawn towards the mean of those in 5 x 5 that it cannot be told from. */
    Steady steadied(std::uint32_t x, std::uint32_t y) const {
        const std::size_t pixel = std::size_t(y) * images_.width + x;
        const Steady centre = own(pixel);
        // Too little noise to matter.
        if (centre.noise < 1e-3 * (centre.value * centre.value + regularizer)) return {centre.value, 0};
        Steady around;
        int count = 0;
        for (std::uint32_t v = y < 2 ? 0 : y - 2; v <= std::min(y + 2, images_.height - 1); ++v) {
            for (std::uint32_t u = x < 2 ? 0 : x - 2; u <= std::min(x + 2, images_.width - 1); ++u) {
                const Steady other = own(std::size_t(v) * images_.width + u);
                const double gap = other.value - centre.value;
                if ((u == x && v == y) || !(gap * gap <= 9 * (other.noise + centre.noise))) continue;
                around.value += other.value;
                around.noise += other.noise;
                ++count;
            }
        }
        if (count == 0) return {centre.value, 0};
        around.value /= count;
        around.noise /= double(count) * count;
        const double gap = centre.value - around.value;
        const double signal = std::max(0.0, gap * gap - 4 * (centre.noise + around.noise));
        const double w = signal / (signal + centre.noise);
        // The pixel's own part has its noise in common with the numerator, which rises with it where noise is
        // skewed as light's is: left uncorrected, the two effects about cancel.
        return {w * centre.value + (1 - w) * around.value, (1 - w) * (1 - w) * around.noise};
    }

private:
    const FilmImages& images_;
    std::size_t channel_;
    double gain_;
};

/** Sum and sum of squares of the pixels' terms. */
struct Terms {
    double sum = 0, squares = 0, ownSum = 0;
    std::size_t count = 0;
    void add(double term, double ownTerm) {
        sum += term;
        squares += term * term;
        ownSum += ownTerm;
        ++count;
    }
};

Terms halvesTerms(const FilmImages& images, double gain) {
    const std::array<Channel, 3> channels = {Channel(images, 0, gain), Channel(images, 1, gain),
                                             Channel(images, 2, gain)};
    Terms terms;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            const std::size_t pixel = std::size_t(y) * images.width + x;
            if (images.difference[4 * pixel + 3] == 0) continue;
            double term = 0, ownTerm = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double d = images.difference[4 * pixel + c];
                if (d == 0 || !std::isfinite(images.mean[4 * pixel + c]) || !std::isfinite(d)) continue;
                term += d * d / channels[c].steadied(x, y).denominator() / 3;
                ownTerm += d * d / channels[c].own(pixel).denominator() / 3;
            }
            terms.add(term, ownTerm);
        }
    }
    return terms;
}

/** With one sample per pixel: half the squared difference of horizontal neighbours, edges included. */
ErrorEstimate fromNeighbours(const FilmImages& images) {
    double sum = 0;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 1; x < images.width; ++x) {
            const std::size_t i = 4 * (std::size_t(y) * images.width + x);
            for (std::size_t c = 0; c < 3; ++c) {
                const double a = images.mean[i + c], b = images.mean[i + c - 4], m = 0.5 * (a + b);
                if (!std::isfinite(a) || !std::isfinite(b)) continue;
                sum += 0.5 * (a - b) * (a - b) / (m * m + regularizer);
                ++count;
            }
        }
    }
    const double relmse = count > 0 ? sum / double(count) : 0;
    return {relmse, 0, 4 * relmse, false};
}

}  // namespace

double stratificationGain(const FilmImages& images) {
    double measured = 0, independent = 0;
    for (std::size_t i = 0; i < images.mean.size(); i += 4) {
        if (images.difference[i + 3] == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = images.mean[i + c], d = images.difference[i + c], v = images.variance[i + c];
            if (!std::isfinite(value) || !std::isfinite(d) || !std::isfinite(v)) continue;
            measured += d * d / (value * value + regularizer);
            independent += v / (value * value + regularizer);
        }
    }
    return measured > 0 && independent > 0 ? measured / independent : 1;
}

ErrorEstimate estimateError(const FilmImages& images) {
    [[maybe_unused]] const std::size_t size = std::size_t(images.width) * images.height * 4;
    assert(images.mean.size() == size && images.variance.size() == size && images.difference.size() == size);
    const Terms terms = halvesTerms(images, std::min(1.0, stratificationGain(images)));
    if (terms.count == 0) return fromNeighbours(images);
    ErrorEstimate result;
    const double n = double(terms.count);
    result.relmse = terms.sum / n;
    if (result.relmse <= 0) return result;
    const double statistical = std::sqrt(4.0 / 3.0 * terms.squares) / terms.sum;
    const double denominator = std::abs(std::log(terms.ownSum / terms.sum));
    // Edges and textures bias the denominator by a few per cent where noise is strong (seen on the samples: 3
    // to 6); where its choice matters much, nothing is known beyond it.
    const double doubt = denominator < 0.5 ? modelError + 0.5 * denominator : modelError + denominator;
    const double spread = std::exp(normalQuantile95 * statistical + doubt);
    result.low = result.relmse / spread;
    result.high = result.relmse * spread;
    double fewest = HUGE_VAL;
    for (std::size_t i = 0; i < images.mean.size(); i += 4)
        fewest = std::min(fewest, double(images.mean[i + 3]));
    result.reliable = fewest >= 8 && statistical < 0.25 && denominator < 0.5;
    return result;
}

}  // namespace helio
