#pragma once
/** @file
 * What occlusion culling keeps between images of the same triangles: boxes around clusters of them, and which
 * clusters the last image showed. An image first draws those, then of the others in view all but the ones
 * that lie wholly behind what is drawn by then (hierarchical z: Greene, Kass and Miller 1993; in two phases:
 * Haar and Aaltonen, GPU-driven rendering pipelines, 2015). Nothing that could be seen is ever left out:
 * pictures are the same to the bit.
 */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>
#include <functional>

namespace helio {

struct RasterTriangles;

class RasterClusters {
public:
    /** As in shaders/raster/cluster.glsl. */
    static constexpr std::uint32_t kTriangles = 64;

    /** `triangles` declares them in a graph; they lie in the order of their ids, which begin at 0. Draws
     * nothing, but reads them all once. */
    RasterClusters(Device& device, const std::function<RasterTriangles(Graph&)>& triangles);

    std::uint32_t count() const { return count_; }
    /** Two texels a cluster: corners of its box. */
    DeviceBuffer& bounds() { return bounds_; }
    /** A word a cluster: not 0 where the last image shows it. */
    DeviceBuffer& seen() { return seen_; }

private:
    std::uint32_t count_;
    DeviceBuffer bounds_, seen_;
};

}  // namespace helio
