#pragma once
#include <cstdint>

namespace helio::test {

/** The price of the general engine in the raster pipeline: the shading of sample:cornell's visibility buffer
 * against strippedShade.comp, run in turn. Prints as the comparison of path tracers does; 1 where the
 * pictures differ. */
int compareShading(std::uint32_t pairs, std::uint32_t runs, std::uint32_t size);

}  // namespace helio::test
