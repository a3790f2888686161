#pragma once
/** @file Push constants of every kernel that takes the view: RasterPush of shaders/raster/view.glsl. */
#include "passes/raster/view.hpp"

#include <cstdint>

namespace helio {

struct RasterPush {
    double rowX[4], rowY[4], rowW[4];
    double depthOffset, depthSlope;
    std::uint32_t size, first, count, flags;
};
static_assert(sizeof(RasterPush) == 128);

inline constexpr std::uint32_t kRasterCullBack = 2;

inline RasterPush makeRasterPush(const RasterView& view, std::uint32_t flags, std::uint32_t first,
                                 std::uint32_t count) {
    return {{view.rowX.x, view.rowX.y, view.rowX.z, view.eye.x},
            {view.rowY.x, view.rowY.y, view.rowY.z, view.eye.y},
            {view.rowW.x, view.rowW.y, view.rowW.z, view.eye.z},
            view.depthOffset,
            view.depthSlope,
            view.width | view.height << 16,
            first,
            count,
            flags};
}

}  // namespace helio
