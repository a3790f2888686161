#pragma once
/** @file Antialiasing of the rasterizer's images: sums of images of shifted samples, and FXAA. */
#include "passes/raster/view.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <array>
#include <cstdint>
#include <memory>

namespace helio {

/** The view whose pixel centres are another's samples at `position` (0..1 of the pixel, from its upper left).
 */
RasterView shiftedView(const RasterView& view, const std::array<float, 2>& position);

/** What an image adds to a sum. */
struct AddWeight {
    float weight = 1;
    bool begins = true;  ///< there is no sum yet
};
/** Declares adding `color` (vec4 a pixel) to `sum`, an imported buffer of the same size. The weight is read
 * at every execution. */
void declareAdd(Graph& graph, Buffer color, Buffer sum, std::uint32_t pixels,
                std::shared_ptr<const AddWeight> weight);

/** Declares FXAA of an image (vec4 a pixel, linear); returns the filtered image. Pixels in whose
 * neighbourhood lightness differs by less than 1/8 of its brightest, or 1/32, keep their bits. */
Buffer declareFxaa(Graph& graph, Buffer color, std::array<std::uint32_t, 2> size);

}  // namespace helio
