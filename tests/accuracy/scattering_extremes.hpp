#pragma once
/** @file
 * Scattering models under random parameters and directions at their extremes, drawn on the device: 0 and 1,
 * denormal numbers, indices from 0.01 to 100, cosines down to 1e-38.
 */
#include "tests/accuracy/scattering_lobes.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace helio::test {

/** The lobes that have code of their own. */
std::vector<std::string> extremeLobes();

struct Extremes {
    std::uint64_t samples = 0;  ///< of value, density and a direction drawn
    std::uint64_t faults = 0;   ///< not finite, negative, or a direction that is not unit
    std::string first;          ///< the first fault's parameters
};

/** Samples of one lobe: 16 each of `invocations` that start at `batch`. */
Extremes runExtremes(const Lobe& lobe, std::uint32_t batch, std::uint32_t invocations);

}  // namespace helio::test
