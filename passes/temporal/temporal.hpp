#pragma once
/** @file
 * Temporal antialiasing: each frame takes one sample of a pixel, at a place that changes from frame to frame,
 * and is mixed into the picture so far. That is looked up where the pixel's surface was in the last frame
 * (motion exact, from the triangle and both views), left out where that surface was not seen there, and, on
 * what moves, held to the range of the frame's colours around. A picture may have more pixels than its
 * frames: a temporal upscaler, made by hand, nothing learned.
 */
#include "passes/raster/view.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace helio {

/** What a frame leaves to the next. Must outlive the plans that it is declared in. */
class TemporalHistory {
public:
    /** `size` is the picture's, a multiple of `upscale` each way. `triangles` of a scene whose surfaces
     * move, else 0. */
    TemporalHistory(Device& device, std::array<std::uint32_t, 2> size, std::uint32_t upscale,
                    std::uint32_t triangles);

    bool fits(std::array<std::uint32_t, 2> size, std::uint32_t upscale, std::uint32_t triangles) const;

    /** What a frame brings. */
    struct Frame {
        Buffer keys;       ///< visibility
        Buffer color;      ///< vec4 a pixel of the frame
        Buffer triangles;  ///< uTriangles of shaders/scene/triangles.glsl, in scene order
    };
    /** Declares mixing a frame in; returns the picture, vec4 a pixel. `view` is that of the frame's samples,
     * read at every execution. */
    Buffer declare(Graph& graph, const Frame& frame, std::shared_ptr<const RasterView> view);

    /** Forgets all frames. */
    void restart() { isEmpty_ = true; }
    /** Before a frame is executed: the view through the pixels' centres, where the samples lie, the weight of
     * a new sample in the long run, and whether anything but the view is not as in the last frame. */
    void beginFrame(const RasterView& centre, const std::array<float, 2>& position, double blend,
                    bool sceneChanged);

    /** The frame's view for a view of the picture. */
    RasterView frameView(const RasterView& picture) const;

private:
    std::array<std::uint32_t, 2> size_;
    std::uint32_t upscale_, triangles_;
    DeviceBuffer color_, keys_, corners_, parameters_;
    RasterView previous_;
    bool isEmpty_ = true;
};

/** Places of a frame's samples: the sequence of Halton in bases 2 and 3, so many that the pixels of the
 * picture are filled evenly. */
std::vector<std::array<float, 2>> temporalPositions(std::uint32_t upscale);

}  // namespace helio
