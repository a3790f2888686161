#pragma once
/** @file The variance of the mean under a stratified sampler. */
#include "engine/film/error_estimate.hpp"

#include <vector>

namespace helio {

/** Variance of the mean per pixel, R G B and 0, under the sampler that made the film. The film's own variance
 * supposes independent samples and is too large for stratified ones, by a factor that differs from place to
 * place. The half difference has the right expectation but one degree of freedom. So the film's variance is
 * scaled by the mean ratio of the two over 7 x 7 pixels, drawn towards the image's mean ratio as if by 16
 * pixels more. Without two halves it is the film's. */
std::vector<float> varianceOfMean(const FilmImages& images);

}  // namespace helio
