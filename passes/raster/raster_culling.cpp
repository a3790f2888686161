#include "passes/raster/raster_passes.hpp"

#include <heliograph_kernels/raster.hpp>

#include <algorithm>
#include <array>
#include <cassert>

namespace helio {
namespace {

// As in shaders/raster/cluster.glsl.
constexpr std::uint32_t kClusterTriangles = RasterClusters::kTriangles;
constexpr std::uint64_t kClusterStateBytes = 64, kDepthGroups = 24, kPyramidGroups = 36, kTestGroups = 48;
constexpr std::uint32_t kDepthCell = 16;
constexpr std::uint32_t kClustersAtOnce = 1u << 20;  // of a dispatch

/** Cells of all levels of the pyramid of depths. */
std::uint64_t pyramidCells(std::uint32_t cellsX, std::uint32_t cellsY) {
    std::uint64_t cells = 0;
    for (std::uint32_t level = 0;; ++level) {
        const std::uint64_t x = (cellsX + (1u << level) - 1) >> level,
                            y = (cellsY + (1u << level) - 1) >> level;
        cells += x * y;
        if (x == 1 && y == 1) return cells;
    }
}

}  // namespace

struct RasterPasses::Culling {
    std::uint32_t clusters, inBatch, batches;
    std::uint32_t cellsX, cellsY;  ///< of the pyramid's finest level
    Buffer list, pyramid, found, bounds, seen;
};

void RasterPasses::drawVisible() {
    const std::uint32_t clusters = target_.clusters->count(), triangleCount = triangles_.count;
    assert(clusters == (triangleCount + kClusterTriangles - 1) / kClusterTriangles);
    const std::uint32_t inBatch = batch_ / kClusterTriangles, batches = (clusters + inBatch - 1) / inBatch;
    const std::uint32_t width = view_->width, height = view_->height;
    const std::uint32_t cellsX = (width + kDepthCell - 1) / kDepthCell,
                        cellsY = (height + kDepthCell - 1) / kDepthCell;
    clusterState_ = graph_.buffer("raster.clusterState", {kClusterStateBytes + std::uint64_t(batches) * 48});
    const Culling culling{
        .clusters = clusters,
        .inBatch = inBatch,
        .batches = batches,
        .cellsX = cellsX,
        .cellsY = cellsY,
        .list = graph_.buffer("raster.clusterList", {std::uint64_t(clusters) * 8}),
        .pyramid = graph_.buffer("raster.pyramid", {pyramidCells(cellsX, cellsY) * 4}),
        .found = graph_.buffer("raster.clustersFound", {4}),
        .bounds = graph_.import(target_.clusters->bounds()),
        .seen = graph_.import(target_.clusters->seen()),
    };
    graph_.fill("raster.clearClusters", clusterState_, 0);
    graph_.fill("raster.clearList", culling.list, 0);
    graph_.fill("raster.clearFound", culling.found, 0);
    graph_.compute("raster.cull", shaders::rasterCull, projection())
        .reads({{"uBounds", culling.bounds, Format::RGBA32F}})
        .modifies(
            {{"uSeen", culling.seen}, {"uClusterState", clusterState_}, {"uCounters", target_.counters}})
        .modifies({{"uList", culling.list}})
        .record([push = pushOf(), clusters, triangleCount](Commands& c) {
            for (std::uint32_t first = 0; first < clusters; first += kClustersAtOnce)
                c.push(push(first, triangleCount))
                    .dispatchInvocations(std::min(kClustersAtOnce, clusters - first));
        });
    drawPhase(culling, 0);
    cullHidden(culling);
    drawPhase(culling, 1);
    graph_.compute("raster.mark", shaders::rasterMark)
        .reads({{"uVisibility", target_.visibility, window_, Format::RG32UI}})
        .writes({{"uSeen", culling.seen}})
        .record([push = pushOf(), width, height](Commands& c) {
            c.push(push(0, 0)).dispatchOver((width + 1) / 2, (height + 1) / 2);
        });
}

void RasterPasses::drawPhase(const Culling& culling, std::int32_t phase) {
    const std::array sizes{culling.clusters, culling.inBatch, culling.batches,
                           culling.cellsX | culling.cellsY << 16};
    graph_.compute("raster.clusterPlan", shaders::rasterClusterPlan, {.spec = {{"PHASE", phase}}})
        .modifies({{"uState", clusterState_}})
        .reads({{"uFound", culling.found}})
        .record([sizes](Commands& c) { c.push(sizes).dispatch(1); });
    ComputeOptions options = projection();
    options.spec["PHASE"] = phase;
    for (std::uint32_t k = 0; k < culling.batches; ++k) {
        const std::uint64_t groups = kClusterStateBytes + (std::uint64_t(phase) * culling.batches + k) * 24;
        drawBatch(phase == 0 && k == 0, groups + 12, [&] {
            setUp(shaders::rasterSetupClusters, options)
                .reads({{"uClusterList", culling.list, Format::R32UI},
                        {"uClusterState", clusterState_, Format::R32UI}})
                .indirect(clusterState_)
                .record([push = pushOf(), state = clusterState_, first = k * culling.inBatch,
                         count = triangles_.count, groups](Commands& c) {
                    c.push(push(first, count)).dispatchIndirect(state, groups);
                });
        });
    }
}

void RasterPasses::cullHidden(const Culling& culling) {
    const auto dispatch = [&](std::uint32_t count, std::uint64_t groups) {
        return [push = pushOf(), state = clusterState_, count, groups](Commands& c) {
            c.push(push(0, count)).dispatchIndirect(state, groups);
        };
    };
    graph_.compute("raster.depths", shaders::rasterDepths)
        .reads({{"uVisibility", target_.visibility, window_, Format::RG32UI}})
        .overwrites({{"uPyramid", culling.pyramid}})
        .indirect(clusterState_)
        .record(dispatch(0, kDepthGroups));
    graph_.compute("raster.pyramid", shaders::rasterPyramid)
        .modifies({{"uPyramid", culling.pyramid}})
        .indirect(clusterState_)
        .record(dispatch(0, kPyramidGroups));
    graph_.compute("raster.cullHidden", shaders::rasterCullHidden, projection())
        .reads({{"uBounds", culling.bounds, Format::RGBA32F}, {"uPyramid", culling.pyramid, Format::R32UI}})
        .reads({{"uClusterState", clusterState_}})
        .modifies({{"uFound", culling.found}, {"uList", culling.list}, {"uCounters", target_.counters}})
        .indirect(clusterState_)
        .record(dispatch(triangles_.count, kTestGroups));
}

}  // namespace helio
