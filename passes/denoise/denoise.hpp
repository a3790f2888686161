#pragma once
/** @file
 * An edge-preserving filter of path-traced pictures. Its result is biased.
 *
 * Each half of the samples is filtered by itself, guided by its own colours, their variance and what the
 * pixels' centres see first: an a-trous wavelet filter (Dammertz et al., "Edge-Avoiding A-Trous Wavelet
 * Transform for fast Global Illumination Filtering", HPG 2010) with the variance-guided colour weight of
 * Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017. Since a filtered half is independent
 * of the other half as it was, the error is measured rather than hoped for: with M the mean of the halves, F
 * that of the filtered ones, d and D half their differences, and e the error of M,
 *
 *     E[e (F - M)] = E[D d - d^2],      E[d^2] = E[e^2]
 *
 * for any filter and any noise. M + s (F - M) has therefore the expected squared error d^2 + 2 s (D d - d^2)
 * + s^2 (F - M)^2, which s = (d^2 - D d) / (F - M)^2 makes least. Both are summed over the 80 pixels around
 * the pixel, relative to brightness; where filtering would harm, s is 0 and the pixel stays as it was. Since
 * the pixel's own samples do not choose its s, they measure what it brings. */
#include "engine/film/error_estimate.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <glm/glm.hpp>

#include <vector>

namespace helio {

/** What the pixels' centres see first. */
struct DenoiseGuides {
    std::vector<glm::vec4> geometry;  ///< unit normal, depth along the view; 0 for a miss
    std::vector<glm::vec4> albedo;    ///< R G B, 1 for a hit
};

struct Denoised {
    std::vector<glm::vec4>
        picture;            ///< R G B, and s: 0 where the pixel was left as it is, 1 where it is filtered
    ErrorEstimate error;    ///< measured
    double undenoised = 0;  ///< relMSE of the picture before by the same measure
    double strength = 0;    ///< mean of s
    std::vector<PassTiming> timings;
};

/** Filters a film's picture, whose error is `before`. Guides must have the film's size. Pixels without
 * samples in both halves stay. */
Denoised denoise(Device& device, const FilmImages& film, const DenoiseGuides& guides,
                 const ErrorEstimate& before);

}  // namespace helio
