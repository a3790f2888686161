#pragma once
/** @file Series over sizes in place of samples: what the engine does that has no samples. Looks beneath the
 * public interface, since no render shows these steps alone. */
#include <heliograph/device.hpp>

#include <cstdint>
#include <string>

namespace helio::cli {

/** One run. */
struct SizeResult {
    double mse = 0;      ///< mean squared error against the same in double precision on the host
    double relmse = 0;   ///< mean((x - r)^2 / (r^2 + 0.01))
    double seconds = 0;  ///< on the wall, upload and compilation apart
    double cpuSeconds = 0;
    std::uint64_t items = 0;  ///< texels that were made, or rays
};

/** The chain of levels of a texture of side x side random texels; `isFloat` or of 8 bits, sRGB. Truth: areas
 * of the level above, in double precision. */
SizeResult measureMips(Device& device, bool isFloat, std::uint32_t side, std::uint32_t seed);

/** Rays to a bumpy ball of so many triangles (rounded). Truth: 64 of the rays against every triangle in
 * double precision; a miss counts as distance 0. */
struct RayBundle {
    bool coherent = true;  ///< a pinhole camera's, neighbours together, or from random points about the ball
    bool closest = true;   ///< or whether anything is met at all: 1 or 0
    std::uint32_t count = 1u << 17;
};
SizeResult measureTraversal(Device& device, const RayBundle& bundle, std::uint32_t triangles,
                            std::uint32_t seed);

}  // namespace helio::cli
