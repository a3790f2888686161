#pragma once
/** @file Where samples are worth most. */
#include "engine/film/error_estimate.hpp"

#include <cstdint>
#include <vector>

namespace helio {

/** Shares samples out over the pixels of a picture so that its relMSE is least, from a pilot of equal
 * numbers.
 *
 * A number of samples that depends on the samples themselves biases their mean: pixels that happen to look
 * quiet are left at that. So a pixel's share comes from the 24 pixels around it alone, whose samples are
 * independent of its own (samplers that correlate pixels are refused). Given that share its mean is unbiased,
 * pilot and all. Its own samples reach its number only through the one factor that makes the shares add up to
 * the samples asked for, as one of all pixels. The pilot decides once: a second round's numbers would have
 * depended on the pixel through its neighbours' first. */
class SampleAllocation {
public:
    /** From a film whose pixels all have `pilot` samples. */
    SampleAllocation(const FilmImages& film, std::uint32_t pilot);
    /** From shares() of an earlier one. */
    SampleAllocation(std::vector<float> shares, std::uint32_t pilot);

    /** Samples of each pixel, even (halves count alike), at least the pilot's, of mean `average` but for
     * rounding. None falls where the average rises. */
    std::vector<std::uint32_t> samples(double average) const;
    /** Relative number of samples of each pixel, of mean 1 and at most 16. */
    const std::vector<float>& shares() const { return shares_; }

private:
    std::vector<float> shares_;
    std::uint32_t pilot_;
};

/** Samples per pixel of the pilot where `samples` are asked for: a quarter, 8 to 64. */
std::uint32_t pilotSamples(std::uint32_t samples);

}  // namespace helio
