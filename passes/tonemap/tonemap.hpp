#pragma once
/** @file Linear colour to 8-bit sRGB on the device: what previews and viewers show. */
#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>

#include <cstdint>

namespace helio {

struct TonemapOptions {
    float exposure = 0.0f;  ///< in EV: colour is multiplied by 2^exposure first
    ToneCurve curve = ToneCurve::None;
};

/** Declares the pass: `linear` holds a vec4 (R, G, B, any) per pixel, rows from the top, and is left as it
 * is. Gives a buffer of one 32-bit word per pixel: R in the low byte, then G, B and 255. Values are exposed,
 * bent by the curve, clamped to 0..1 (NaN to 0), encoded by the exact sRGB curve and rounded to the nearest code. */
Buffer declareTonemap(Graph& graph, Buffer linear, std::uint32_t width, std::uint32_t height,
                      const TonemapOptions& options = {});

}  // namespace helio
