#include "engine/film/error_estimate.hpp"

#include "engine/film/stray_samples.hpp"
#include "engine/film/variance.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

constexpr double modelError = 0.01;  // of the estimate's logarithm, for edges and textures
/** Of the logarithm of what the denominator's choice changes. */
constexpr double denominatorDoubt = 0.02;
/** See Truths: what rare samples say beyond is not believed. */
constexpr double largestSkew = 8;
constexpr double skewPriorPixels = 256;  // of the skew
/** Of what pixels' own terms say of the sum's variance over what their neighbours' say, where a pixel is like
 * those around it: 1 for normal errors, a third of the kurtosis of the halves' difference. Measured: 0.8
 * to 2.9 on scenes that the interval holds on, 2.8 to 5.8 where it is too low (the cellar), 4.5 to 10^5 where
 * rare bright samples decide (bench_error coverage on glass, terrain, lights500). */
constexpr double heaviestTail = 3;
/** Where the tail is heavy and yet believed, estimates that missed its samples are those that look lightest:
 * the upper bound's logarithm widens by so much per unit of the tail beyond `lightTail`. Measured on the
 * cellar. */
constexpr double tailDoubt = 0.12, lightTail = 2.2;
/** Of strayError() over the sum. Measured: below 0.3 on scenes that the interval holds on (0.25 to 0.3 on
 * cornell, whose lamp is in view), 0.34 to 0.46 where a smaller picture of it holds the truth in 78 % (48 x
 * 48), 1.2 to 2.7 on lamps below a pixel (lenses). */
constexpr double largestStray = 0.33;
/** Of strayError() over the sum's own spread, with fewer samples than that: a pixel at a lamp's edge that
 * holds less of it than a sample's share is then often seen dark, and where it is not its term is too small
 * by half. Measured at 8 and 16 samples: 1.4 to 2.1 where 22 to 80 % hold the truth (cornell at 48 x 48 to 96
 * x 96, plates); 0 to 1.3 where 94 % and more do (yard, metals, spheres at 16 samples, irradiance, furnace).
 * At 32 cornell holds it again, at 64 plates do. */
constexpr double strayShare = 1.35;
constexpr double samplesAtLamps = 64;

double finiteOr(double x, double otherwise) {
    return std::isfinite(x) ? x : otherwise;
}

/** What a pixel's truth may be. */
struct Truth {
    double squared = 0;  ///< for relMSE's denominator
    double own = 1;      ///< how much of it is the pixel's own value, not its neighbours'
    double apart = 0;    ///< from the pixel's value to the mean of neighbours like it; 0 where there is none
    double noise = 0;    ///< variance of the pixel's value, where it matters
    /** `skew`: see skewOf(). */
    double denominator(double skew) const {
        const double d = squared + relMseRegularizer, r = own * noise / d;
        return d * std::clamp((1 + 3 * own * r) / (1 + 2 * skew * r), 0.5, 1.5);
    }
};

/** One channel of a film, and the variance of its pixels' means, see varianceOfMean(). */
class Channel {
public:
    Channel(const FilmImages& images, std::size_t channel, const std::vector<float>& variance)
        : images_(images), variance_(variance), channel_(channel) {}

    double value(std::size_t pixel) const { return images_.mean[4 * pixel + channel_]; }
    double difference(std::size_t pixel) const { return images_.difference[4 * pixel + channel_]; }
    double noise(std::size_t pixel) const {
        const double d = difference(pixel);
        return finiteOr(double(variance_[4 * pixel + channel_]), d * d);
    }

    /** The pixel's value drawn towards the mean of those of its eight neighbours that it cannot be told from,
     * as Wiener's filter does: by how its noise compares with the contrast around it. Contrasts come from
     * products of the two halves' differences: their expectation is the square of the true one whatever the
     * noise, which a bright sample in one half does not change. */
    Truth truth(std::uint32_t x, std::uint32_t y) const {
        const std::size_t pixel = std::size_t(y) * images_.width + x;
        const double centre = value(pixel), d = difference(pixel), own = noise(pixel);
        // Too little noise to matter.
        if (own < 1e-3 * (centre * centre + relMseRegularizer)) return {centre * centre};
        double like = 0, likeNoise = 0;            // of neighbours that the pixel cannot be told from
        double meanA = 0, meanB = 0, product = 0;  // of all neighbours
        int count = 0, all = 0;
        for (std::uint32_t v = y == 0 ? 0 : y - 1; v <= std::min(y + 1, images_.height - 1); ++v) {
            for (std::uint32_t u = x == 0 ? 0 : x - 1; u <= std::min(x + 1, images_.width - 1); ++u) {
                const std::size_t at = std::size_t(v) * images_.width + u;
                if (at == pixel) continue;
                const double other = value(at) - centre, otherD = difference(at);
                if (!std::isfinite(other) || !std::isfinite(otherD)) continue;
                const double a = other + otherD, b = other - otherD;
                meanA += a;
                meanB += b;
                product += a * b;
                ++all;
                const double bothNoises = noise(at) + own;
                if (!((a - d) * (b + d) < 2 * bothNoises)) continue;
                like += other;
                likeNoise += noise(at);
                ++count;
            }
        }
        if (count == 0) return {centre * centre};
        like /= count;
        likeNoise /= double(count) * count;
        const double spread = all > 1 ? (product - meanA * meanB / all) / (all - 1) : 0;
        const double apart = (like - d) * (like + d) - 4 * (own + likeNoise);
        const double signal = std::max({0.0, spread, apart});
        const double w = signal / (signal + own);
        const double steady = centre + (1 - w) * like;
        return {steady * steady, w, like, own};
    }

private:
    const FilmImages& images_;
    const std::vector<float>& variance_;
    std::size_t channel_;
};

/** What a channel's pixels may be. */
struct Truths {
    std::vector<Truth> at;
    /** E[e d^2] T / sigma^4 of errors e of a pixel's value T: 0 for normal errors, 1 for counts of equal
     * bright samples, more where some are brighter. Where it is not 0, the numerator d^2 and a denominator
     * that holds the same noise are large together, and their ratio is low. Measured where a pixel is like
     * its neighbours, which say what it should be. */
    double skew = 0;

    Truths(const Channel& channel, const FilmImages& images) {
        double third = 0, square = 0, pixels = 0;
        for (std::uint32_t y = 0; y < images.height; ++y) {
            for (std::uint32_t x = 0; x < images.width; ++x) {
                const std::size_t pixel = at.size();
                at.push_back(channel.truth(x, y));
                const Truth& t = at.back();
                if (t.apart == 0 || t.noise == 0) continue;
                const double d = channel.difference(pixel), mean = channel.value(pixel) + t.apart;
                const double weight =
                    (1 - t.own) / ((t.squared + relMseRegularizer) * (t.squared + relMseRegularizer));
                third -= weight * t.apart * d * d * mean;
                square += weight * t.noise * t.noise;
                pixels += 1 - t.own;
            }
        }
        // Drawn towards that of counts, as if by some pixels more.
        const double prior = square * skewPriorPixels / std::max(1.0, pixels);
        if (square > 0) skew = std::clamp((third + prior) / (square + prior), 0.0, largestSkew);
    }
};

/** A pixel's part of the error. */
struct Term {
    /** d / sqrt(3 (truth^2 + 0.01)) of each channel: as good as independent from pixel to pixel, while
     * channels share much of their noise. */
    std::array<double, 3> error{};
    double measured = 0;  ///< sum of its squares
    double smooth = 0;    ///< with the variance's smooth estimate in place of d^2
    double own = 0;       ///< see Truth
};

/** Sums over the pixels that have both halves. */
struct Terms {
    double sum = 0;
    double variance = 0;    ///< of the sum about the realised error
    double squares = 0;     ///< 4/3 of the terms' squares, of pixels like their neighbours
    double neighbours = 0;  ///< 4 of their products with the neighbours' mean
    double ownSum = 0;      ///< with the pixel's own value in the denominator
    double countsSum = 0;   ///< with a skew of 1, that of counts
    std::size_t count = 0;
};

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** What a pixel's neighbours make of its term: means over those that have samples. */
struct Around {
    double alike = 0;    ///< (e . e')^2
    double product = 0;  ///< (e . e) (e' . e')
};

Around around(const std::vector<Term>& pixels, const FilmImages& images, std::uint32_t x, std::uint32_t y) {
    const std::size_t centre = std::size_t(y) * images.width + x;
    Around sum;
    int count = 0;
    for (std::uint32_t v = y == 0 ? 0 : y - 1; v <= std::min(y + 1, images.height - 1); ++v) {
        for (std::uint32_t u = x == 0 ? 0 : x - 1; u <= std::min(x + 1, images.width - 1); ++u) {
            const std::size_t at = std::size_t(v) * images.width + u;
            if (at == centre) continue;
            const double both = dot(pixels[centre].error, pixels[at].error);
            sum.alike += both * both;
            sum.product += pixels[centre].measured * pixels[at].measured;
            ++count;
        }
    }
    return count > 0 ? Around{sum.alike / count, sum.product / count} : sum;
}

/** The variance of a pixel's a . b, taken together: 4 times the sum of squares of its errors' 3 x 3
 * covariance, which is 4 sigma^4 where the channels err alike and less where they do not. Where the pixel is
 * like those around it, 4 (e . e')^2 has that expectation, a product of independent terms, which no tail
 * makes larger. Where it is not, its own term has to tell: (e . e)^2, half of it with the smooth variance for
 * one factor, since halves agree by chance. Its expectation holds (sum of the variances)^2 too; how far that
 * is more is the same for the whole picture, `together` = sum (e . e')^2 / sum (e . e) (e' . e'). */
void addVariance(const std::vector<Term>& pixels, const FilmImages& images, Terms& terms) {
    Around all;
    std::vector<Around> neighbours;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            neighbours.push_back(around(pixels, images, x, y));
            all.alike += neighbours.back().alike;
            all.product += neighbours.back().product;
        }
    }
    const double together = all.product > 0 ? std::clamp(all.alike / all.product, 1.0 / 3.0, 1.0) : 1.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Term& term = pixels[i];
        if (term.measured == 0 && term.smooth == 0) continue;
        const double square = 4 * together / (1 + 2 * together) * term.measured * term.measured;
        const double alike = neighbours[i].product > 0 ? 4 * neighbours[i].alike : square;
        const double alone = 0.5 * square + 2 * together * term.measured * term.smooth;
        terms.variance += term.own * alone + (1 - term.own) * alike;
        terms.squares += (1 - term.own) * square;
        terms.neighbours += (1 - term.own) * alike;
    }
}

Terms halvesTerms(const FilmImages& images) {
    const std::vector<float> variance = varianceOfMean(images);
    const std::array<Channel, 3> channels = {Channel(images, 0, variance), Channel(images, 1, variance),
                                             Channel(images, 2, variance)};
    const std::array<Truths, 3> truths = {Truths(channels[0], images), Truths(channels[1], images),
                                          Truths(channels[2], images)};
    std::vector<Term> pixels(std::size_t(images.width) * images.height);
    Terms terms;
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            const std::size_t pixel = std::size_t(y) * images.width + x;
            if (images.difference[4 * pixel + 3] == 0) continue;
            Term& term = pixels[pixel];
            for (std::size_t c = 0; c < 3; ++c) {
                const double d = channels[c].difference(pixel), value = channels[c].value(pixel);
                if (!std::isfinite(value) || !std::isfinite(d)) continue;
                const double v = finiteOr(variance[4 * pixel + c], d * d);
                if (d == 0 && v == 0) continue;
                const Truth& truth = truths[c].at[pixel];
                const double weight = 1 / (3 * truth.denominator(truths[c].skew));
                term.error[c] = d * std::sqrt(weight);
                term.measured += d * d * weight;
                term.smooth += v * weight;
                term.own += truth.own / 3;
                terms.countsSum += d * d / (3 * truth.denominator(1));
                terms.ownSum += d * d / (3 * (value * value + relMseRegularizer));
            }
            terms.sum += term.measured;
            ++terms.count;
        }
    }
    addVariance(pixels, images, terms);
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
                sum += 0.5 * (a - b) * (a - b) / (m * m + relMseRegularizer);
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
            measured += d * d / (value * value + relMseRegularizer);
            independent += v / (value * value + relMseRegularizer);
        }
    }
    return measured > 0 && independent > 0 ? measured / independent : 1;
}

std::vector<float> relativeWeights(const FilmImages& images) {
    const std::vector<float> variance = varianceOfMean(images);
    std::vector<float> result(images.mean.size());
    for (std::uint32_t y = 0; y < images.height; ++y) {
        for (std::uint32_t x = 0; x < images.width; ++x) {
            const std::size_t pixel = std::size_t(y) * images.width + x;
            for (std::size_t c = 0; c < 3; ++c) {
                const double denominator = Channel(images, c, variance).truth(x, y).denominator(1);
                result[4 * pixel + c] = float(finiteOr(1 / denominator, 0));
            }
        }
    }
    return result;
}

std::vector<float> relativeStandardErrors(const FilmImages& images) {
    const std::vector<float> variance = varianceOfMean(images), weights = relativeWeights(images);
    std::vector<float> result;
    result.reserve(images.mean.size() / 4 * 3);
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (i % 4 != 3) result.push_back(float(std::sqrt(finiteOr(double(variance[i]) * weights[i], 0))));
    return result;
}

ErrorEstimate estimateError(const FilmImages& images) {
    [[maybe_unused]] const std::size_t size = std::size_t(images.width) * images.height * 4;
    assert(images.mean.size() == size && images.variance.size() == size && images.difference.size() == size);
    const Terms terms = halvesTerms(images);
    if (terms.count == 0) return fromNeighbours(images);
    ErrorEstimate result;
    const double n = double(terms.count);
    result.relmse = terms.sum / n;
    if (result.relmse <= 0) return result;
    const double statistical = std::sqrt(terms.variance) / terms.sum;
    const double denominator = std::abs(std::log(terms.ownSum / terms.sum));
    // Errors are skewed upwards: what few samples saw is missed by the estimate and its spread alike. The
    // quantiles are those that bench_error coverage measures.
    // The skew is measured on few pixels: all that it brings is within the interval.
    const double skew = std::log(terms.sum / terms.countsSum);
    const double doubt = std::hypot(modelError + denominatorDoubt * denominator, skew);
    result.low = result.relmse * std::exp(-std::hypot(1.8 * statistical, doubt));
    const double tail = terms.neighbours > 0 ? terms.squares / terms.neighbours : 0;
    const double missed = tailDoubt * std::clamp(tail - lightTail, 0.0, heaviestTail - lightTail);
    result.high = result.relmse * std::exp(std::hypot(2.12 * statistical, doubt, missed));
    double fewest = HUGE_VAL;
    for (std::size_t i = 0; i < images.mean.size(); i += 4)
        fewest = std::min(fewest, double(images.mean[i + 3]));
    const auto straysMatter = [&] {
        const double stray = strayError(images) / result.relmse;
        return stray > largestStray || (fewest < samplesAtLamps && stray > strayShare * statistical);
    };
    result.reliable = fewest >= 8 && statistical < 0.3 && denominator < 0.5 &&
                      terms.squares <= heaviestTail * terms.neighbours && !straysMatter();
    return result;
}

}  // namespace helio
