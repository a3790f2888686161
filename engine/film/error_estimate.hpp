#pragma once
/** @file The error of an unfinished image, estimated from the film's two halves. */
#include <heliograph/renderer.hpp>

#include <cstdint>
#include <vector>

namespace helio {

/** What the resolve pass brings back: four floats per pixel, rows from the top. */
struct FilmImages {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> mean;      ///< R G B, number of samples
    std::vector<float> variance;  ///< of the mean if samples were independent; rejected samples
    std::vector<float>
        difference;  ///< its square is an unbiased estimate of the mean's variance; 1 if there is one
};

/** Added to the squared truth in relMSE, so that black pixels do not count without bound. */
inline constexpr double relMseRegularizer = 0.01;

/** Estimates the image's relMSE, mean((x - truth)^2 / (truth^2 + 0.01)), with a 95 % interval for the
 * realised error of this very image.
 *
 * Let a, b be the errors of the independent halves and x = (a + b) / 2 that of the mean. The half difference
 * is d = (a - b) / 2, and d^2 - x^2 = -a b has expectation 0 for any distribution: the sum of d^2 follows the
 * realised error, fireflies included, and its uncertainty needs no higher moments than Var(a) Var(b), which
 * 4/3 d^4 bounds on average (equality for normal errors).
 *
 * The denominator never takes a pixel's value where noise dominates it: a value is drawn towards the mean of
 * its neighbours by how its noise compares with the contrast around it; what noise is left in it, and in the
 * numerator too, is made up for by how skewed errors are. How much both matter widens the interval.
 * `reliable` is false with fewer than 8 samples; where so few pixels carry the error that the normal
 * approximation fails; where the tail of single pixels is heavy, as on caustics; where pixels beside bright
 * ones may hold what no sample has met (strayError()), as beside lamps smaller than a pixel, and with fewer
 * than 64 samples beside any lamp that matters; and where pixels are so noisy that the choice of denominator
 * matters much. Without two halves, neighbouring pixels stand in and the result is not reliable. */
ErrorEstimate estimateError(const FilmImages& images);

/** 1 / (truth^2 + 0.01) of each pixel as estimateError() takes it: R G B and 0. */
std::vector<float> relativeWeights(const FilmImages& images);
/** Of each pixel, R G B: the root of its expected part in relMSE, with the same denominators. */
std::vector<float> relativeStandardErrors(const FilmImages& images);

/** The variance of the mean that the two halves measure over that of independent samples, over the whole
 * image: about 1 for independent samples, less for stratified ones. 1 where there is nothing to compare. */
double stratificationGain(const FilmImages& images);

}  // namespace helio
