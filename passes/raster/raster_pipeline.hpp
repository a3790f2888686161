#pragma once
/** @file
 * The compute rasterizer: triangles to a visibility buffer.
 *
 * Each triangle is transformed in double (camera-relative), clipped at the near plane and at a guard band of
 * 32,768 pixels where it has to be, snapped to 1/256 pixel, and covers the pixels whose centres its edges
 * contain in exact integers under the top-left rule. Small ones are drawn at once by 64-bit atomics; others
 * are listed per tile of 16x16 pixels (first counted, then placed, so that no list overflows) and drawn by a
 * kernel that owns the tile. Nearer wins, and of equal depths the smaller id: the order of triangles has no
 * influence.
 */
#include "passes/raster/raster_clusters.hpp"
#include "passes/raster/view.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace helio {

/** Triangles as shaders/scene/triangles.glsl reads them, in any order. */
struct RasterTriangles {
    Buffer buffer;
    std::uint32_t count = 0;
};

struct RasterOptions {
    bool cullBackFaces = false;
    /** Triangles set up together; the scratch memory grows with it, results do not depend on it. */
    std::uint32_t batch = 1u << 18;
    /** Most entries that the lists of tiles hold at a time; results do not depend on it. */
    std::uint64_t entries = 1u << 24;
    /** Invocations that draw a tile, 32 or, where subgroups have at most so many, 8; 0 chooses by the
     * device's subgroups. Results do not depend on it. */
    std::uint32_t tileLanes = 0;
    /** Whether subgroups set up triangles until all their invocations have some to draw: where few triangles
     * cover a pixel. None: where they outnumber the pixels. Only narrow subgroups do. Results do not depend
     * on it. */
    std::optional<bool> gather = {};
    /** Whether small triangles are drawn as they are set up, rather than through the tiles as large ones are.
     * None: but where they are few for the pixels. Results do not depend on it. */
    std::optional<bool> direct = {};
    /** Depth of the keys. Perspective views of the conventional formats are made by conventionalDepth(). */
    DepthFormat depth = DepthFormat::Reversed;
};

/** Work done for an image, summed over the batches. */
struct RasterCounters {
    std::uint64_t triangles = 0;   ///< read
    std::uint64_t outside = 0;     ///< wholly outside the view
    std::uint64_t backFacing = 0;  ///< left out on request
    std::uint64_t empty = 0;       ///< without area, or no pixel centre in the bounding box
    std::uint64_t small = 0;       ///< drawn directly
    std::uint64_t large = 0;       ///< drawn through the tiles
    std::uint64_t clipped = 0;  ///< clipped at the near plane or the guard band, then drawn through the tiles
    std::uint64_t smallVisited = 0;  ///< pixels that direct drawing tested
    std::uint64_t smallCovered = 0;  ///< of these, covered
    std::uint64_t parts = 0;         ///< triangles that clipping made
    std::uint64_t entries = 0;       ///< entries of the tiles' lists
    std::uint64_t tileVisited = 0;   ///< triangles times tiles that the tile kernel tested
    std::uint64_t hidden =
        0;  ///< triangles of clusters behind all that is drawn where they are; never set up
    std::uint64_t clusters = 0;         ///< looked at, where clusters are culled
    std::uint64_t clustersOutside = 0;  ///< of these, wholly outside the view; their triangles are `outside`
    std::uint64_t clustersHidden = 0;   ///< of these, behind all that is drawn where they are
};

/** What the rasterizer leaves in the graph. */
struct RasterOutput {
    /** A 64-bit key per pixel, rows from the top: bits of the depth above, the complement of the triangle's
     * id (its g) below; 0 where no triangle is seen. */
    Buffer visibility;
    /** One RasterCounters. */
    Buffer counters;
};

/** What the rasterizer needs of a device beyond what every device has. */
inline constexpr std::array kRasterCapabilities = {"shaderInt64", "shaderBufferInt64Atomics", "shaderFloat64",
                                                   "subgroupArithmetic", "subgroupShuffle"};
/** Where a rasterizer's output goes, for callers that draw several images: cleared by the caller. */
struct RasterTarget {
    Buffer visibility;
    std::uint64_t offset = 0;  ///< bytes; a multiple of rasterStride()'s unit
    Buffer counters;           ///< added to
    /** Peeling: of each pixel only keys below this buffer's (as many as keys) are drawn; none: all are. */
    std::optional<Buffer> limit = {};
    /** Clusters of these triangles, to cull the hidden ones: for scenes of which several images are drawn; no
     * picture changes. Must outlive the plan. */
    RasterClusters* clusters = nullptr;
};
/** Bytes from one image's keys to the next's in a buffer of several. */
std::uint64_t rasterStride(std::uint32_t width, std::uint32_t height);

/** Throws DeviceError where the device lacks one of kRasterCapabilities. */
void requireRasterCapabilities(const DeviceInfo& device);

class RasterPipeline {
public:
    /** Throws DeviceError: see requireRasterCapabilities. */
    explicit RasterPipeline(const Device& device, const RasterOptions& options = {});

    /** Declares the passes. `view` is read at every execution: its camera may change between two, its size
     * and kind of projection may not. Throws InputError for a size that the device cannot hold. */
    RasterOutput declare(Graph& graph, const RasterTriangles& triangles,
                         std::shared_ptr<const RasterView> view, RasterClusters* clusters = nullptr) const;
    /** The same into a part of a buffer. */
    void declare(Graph& graph, const RasterTriangles& triangles, std::shared_ptr<const RasterView> view,
                 const RasterTarget& target) const;

private:
    RasterOptions options_;
    std::uint64_t maxStorageBufferRange_ = 0;
};

/** Id of a visibility key, or -1 for a miss. */
inline std::int64_t visibleTriangle(std::uint64_t key) {
    return key == 0 ? -1 : std::int64_t(std::uint32_t(~key));
}

}  // namespace helio
