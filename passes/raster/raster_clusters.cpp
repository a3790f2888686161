#include "passes/raster/raster_clusters.hpp"

#include "passes/raster/raster_pipeline.hpp"

#include <heliograph_kernels/raster.hpp>

#include <algorithm>
#include <array>

namespace helio {
namespace {

std::uint32_t clustersOf(Device& device, const std::function<RasterTriangles(Graph&)>& triangles) {
    Graph graph(device);  // never compiled
    return (triangles(graph).count + RasterClusters::kTriangles - 1) / RasterClusters::kTriangles;
}

}  // namespace

RasterClusters::RasterClusters(Device& device, const std::function<RasterTriangles(Graph&)>& triangles)
    : count_(clustersOf(device, triangles)),
      bounds_(device, "raster.bounds", std::max<std::uint64_t>(count_, 1) * 32),
      seen_(device, "raster.seen", std::max<std::uint64_t>(count_, 4) * 4) {
    Graph graph(device);
    const RasterTriangles all = triangles(graph);
    // The first image draws all.
    graph.fill("raster.seeAll", graph.import(seen_), 1);
    graph.compute("raster.bounds", shaders::rasterBounds)
        .reads({{"uTriangles", all.buffer}})
        .overwrites({{"uBounds", graph.import(bounds_)}})
        .record([count = count_, triangleCount = all.count](Commands& c) {
            constexpr std::uint32_t most = 1u << 21;
            for (std::uint32_t first = 0; first < count; first += most)
                c.push(std::array{first, triangleCount}).dispatchInvocations(std::min(most, count - first));
        });
    Plan plan = graph.compile({.executionsInFlight = 1});
    plan.wait(plan.execute());
}

}  // namespace helio
