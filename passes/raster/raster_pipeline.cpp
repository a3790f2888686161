#include "passes/raster/raster_pipeline.hpp"

#include "passes/raster/push.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/raster.hpp>

#include <algorithm>
#include <cassert>
#include <string>

namespace helio {
namespace {

// As in shaders/raster/state.glsl.
constexpr int kLevels = 6;
constexpr std::uint32_t kClipParts = 6;
constexpr std::uint32_t kRecordBytes = 64;
constexpr std::uint64_t kStateBytes = 96;
constexpr std::uint64_t kLargeGroups = 16, kClipGroups = 28, kFillGroups = 40, kTileGroups = 52,
                        kMoreGroups = 64, kFreshGroups = 80;
constexpr std::uint32_t kTallTiles = 4;         // of a workgroup of rasterTileTall
constexpr std::uint32_t kSetupTriangles = 512;  // of a workgroup of set-up
// As in shaders/raster/cluster.glsl.
constexpr std::uint32_t kClusterTriangles = RasterClusters::kTriangles;
constexpr std::uint64_t kClusterStateBytes = 64, kDepthGroups = 24, kPyramidGroups = 36, kTestGroups = 48;
constexpr std::uint32_t kDepthCell = 16;
constexpr std::uint32_t kClustersAtOnce = 1u << 20;  // of a dispatch

std::uint64_t cellCount(std::uint32_t width, std::uint32_t height) {
    std::uint64_t cells = 0;
    for (int level = 0; level < kLevels; ++level) {
        const std::uint64_t side = 16ull << (2 * level);
        cells += ((width + side - 1) / side) * ((height + side - 1) / side);
    }
    return cells;
}

void checkSize(std::uint32_t width, std::uint32_t height, std::uint64_t maxStorageBufferRange) {
    if (width > 0 && height > 0 && width <= kMaxRasterSize && height <= kMaxRasterSize &&
        std::uint64_t(width) * height * 8 <= maxStorageBufferRange)
        return;
    throw InputError("", "",
                     fmt::format("the rasterizer cannot hold an image of {} x {} pixels", width, height),
                     fmt::format("choose at most {} pixels, and 1 to {} each way", maxStorageBufferRange / 8,
                                 kMaxRasterSize));
}

}  // namespace

void requireRasterCapabilities(const DeviceInfo& device) {
    for (const char* needed : kRasterCapabilities)
        if (!device.has(needed))
            throw DeviceError(fmt::format(
                "{} lacks {}, which the rasterizer needs; use the path pipeline or another device",
                device.name, needed));
}

RasterPipeline::RasterPipeline(const Device& device, const RasterOptions& options)
    : options_(options), maxStorageBufferRange_(device.info().maxStorageBufferRange) {
    assert(options.batch > 0);
    assert(options.stripRows == 0 || options.stripRows == 4 || options.stripRows == 8);
    if (options_.stripRows == 0) options_.stripRows = device.info().subgroupSize <= 16 ? 8 : 4;
    requireRasterCapabilities(device.info());
    // A record is 64 bytes and all of a batch must be in reach of one binding; indirect dispatches have at
    // most 65,535 workgroups of 64.
    const std::uint64_t records =
        std::min<std::uint64_t>(maxStorageBufferRange_ / kRecordBytes, 65535u * 64u);
    options_.batch = std::uint32_t(std::clamp<std::uint64_t>(options_.batch, 1, records / kClipParts));
}

std::uint64_t rasterStride(std::uint32_t width, std::uint32_t height) {
    constexpr std::uint64_t unit = 256;  // no device asks for a coarser alignment of bindings
    return (std::uint64_t(width) * height * 8 + unit - 1) / unit * unit;
}

RasterOutput RasterPipeline::declare(Graph& graph, const RasterTriangles& triangles,
                                     std::shared_ptr<const RasterView> view, RasterClusters* clusters) const {
    assert(view != nullptr);
    checkSize(view->width, view->height, maxStorageBufferRange_);
    RasterOutput output;
    output.visibility = graph.buffer("raster.visibility", {std::uint64_t(view->width) * view->height * 8});
    output.counters = graph.buffer("raster.counters", {sizeof(RasterCounters)});
    graph.fill("raster.clear", output.visibility, 0);
    graph.fill("raster.clearCounters", output.counters, 0);
    declare(graph, triangles, std::move(view), {output.visibility, 0, output.counters, {}, clusters});
    return output;
}

void RasterPipeline::declare(Graph& graph, const RasterTriangles& triangles,
                             std::shared_ptr<const RasterView> view, const RasterTarget& target) const {
    assert(view != nullptr);
    const std::uint32_t width = view->width, height = view->height;
    checkSize(width, height, maxStorageBufferRange_);
    if (triangles.count == 0) return;
    const Window window{target.offset, std::uint64_t(width) * height * 8};

    std::uint32_t batch = std::min(options_.batch, triangles.count);
    // Workgroups of set-up take whole clusters.
    if (target.clusters) batch = std::max(batch / kSetupTriangles, 1u) * kSetupTriangles;
    const std::uint64_t cells = cellCount(width, height);
    const std::uint64_t records = std::uint64_t(batch) * kClipParts;
    // No record may need more entries than there are cells; and each must find room for at least one.
    const std::uint64_t entries =
        std::max(records, std::min({records * cells, options_.entries, maxStorageBufferRange_ / 4}));

    const Buffer state = graph.buffer("raster.state", {kStateBytes});
    const Buffer large = graph.buffer("raster.large", {std::uint64_t(batch) * 4});
    const Buffer clipped = graph.buffer("raster.clipped", {std::uint64_t(batch) * 4});
    const Buffer record = graph.buffer("raster.records", {records * kRecordBytes});
    const Buffer counts = graph.buffer("raster.counts", {cells * 4});
    const Buffer starts = graph.buffer("raster.starts", {cells * 8});
    const Buffer tiles =
        graph.buffer("raster.tiles", {std::uint64_t((width + 15) / 16) * ((height + 15) / 16) * 4});
    const Buffer entry = graph.buffer("raster.entries", {entries * 4});

    std::vector<Binding> limit;
    if (target.limit) limit = {{"uLimit", *target.limit, Format::RG32UI}};
    const auto kernel = [&](const Kernel& plain) {
        return target.limit ? compileVariant(plain, {.defines = {{"PEEL", "1"}}, .generated = {}}) : plain;
    };
    const bool orthographic = view->orthographic;
    const ComputeOptions projection{
        .spec = {{"ORTHOGRAPHIC", orthographic}, {"DEPTH_FORMAT", std::int32_t(options_.depth)}}};
    const auto tiled = [&](std::uint32_t firstSegment) {
        ComputeOptions options = projection;
        options.spec["FIRST_SEGMENT"] = firstSegment;
        return options;
    };
    graph.fill("raster.clearCounts", counts, 0);
    const std::uint32_t flags = options_.cullBackFaces ? kRasterCullBack : 0u;
    const auto pushOf = [view, flags, orthographic, depth = options_.depth](std::uint32_t first,
                                                                            std::uint32_t count) {
        assert(view->orthographic == orthographic);
        assert(orthographic || depth == DepthFormat::Reversed || view->depthSlope > 0);
        return makeRasterPush(*view, flags, first, count);
    };
    const auto setUp = [&](const Kernel& plain, const ComputeOptions& options) {
        return graph.compute("raster.setup", kernel(plain), options)
            .reads({{"uTriangles", triangles.buffer}})
            .reads(limit)
            .modifies({{"uVisibility", target.visibility, window},
                       {"uState", state},
                       {"uCounters", target.counters}})
            .overwrites({{"uLarge", large}, {"uClipped", clipped}});
    };
    Buffer clusterState;
    // Draws what `setUpBatch` lists; `isFirst`: nothing has been drawn before; `once`: where in clusterState
    // it says whether there is anything.
    const auto drawBatch = [&](bool isFirst, std::optional<std::uint64_t> once, const auto& setUpBatch) {
        const auto push = [pushOf] { return pushOf(0, 0); };
        graph.fill("raster.clearState", state, 0);
        setUpBatch();
        // One workgroup; none where culling has left nothing.
        const auto dispatchOnce = [clusterState](Commands& c, std::optional<std::uint64_t> groups) {
            if (groups)
                c.dispatchIndirect(clusterState, *groups);
            else
                c.dispatch(1);
        };
        Pass plan = graph.compute("raster.plan", shaders::rasterPlan)
                        .modifies({{"uState", state}})
                        .record([entries, dispatchOnce, once](Commands& c) {
                            c.push(std::uint32_t(entries));
                            dispatchOnce(c, once);
                        });
        if (once) plan.indirect(clusterState);
        graph.compute("raster.large", shaders::rasterLarge, projection)
            .reads({{"uTriangles", triangles.buffer}, {"uState", state}, {"uLarge", large}})
            .overwrites({{"uRecords", record}})
            .modifies({{"uCounts", counts}})
            .indirect(state)
            .record([push, state](Commands& c) { c.push(push()).dispatchIndirect(state, kLargeGroups); });
        graph.compute("raster.clip", shaders::rasterClip, projection)
            .reads({{"uTriangles", triangles.buffer}, {"uState", state}, {"uClipped", clipped}})
            .writes({{"uRecords", record}})
            .modifies({{"uCounts", counts}, {"uCounters", target.counters}})
            .indirect(state)
            .record([push, state](Commands& c) { c.push(push()).dispatchIndirect(state, kClipGroups); });
        const bool paired = width % 2 == 0;  // two keys at a time
        const bool tall = options_.stripRows == 8;
        ComputeOptions grouped;
        grouped.spec["GROUP_TILES"] = paired && tall ? kTallTiles : 1u;
        grouped.spec["MAY_START_FRESH"] = paired && isFirst;
        Pass scan = graph.compute("raster.scan", shaders::rasterScan, grouped)
                        .reads({{"uCounts", counts}})
                        .overwrites({{"uStarts", starts}, {"uTiles", tiles}})
                        .modifies({{"uState", state}, {"uCounters", target.counters}})
                        .record([push, dispatchOnce, once](Commands& c) {
                            c.push(push());
                            dispatchOnce(c, once);
                        });
        if (once) scan.indirect(clusterState);
        graph.compute("raster.fill", shaders::rasterFill)
            .reads({{"uRecords", record}, {"uState", state}, {"uStarts", starts}})
            .modifies({{"uCounts", counts}})
            .overwrites({{"uEntries", entry}})
            .indirect(state)
            .record([push, state](Commands& c) { c.push(push()).dispatchIndirect(state, kFillGroups); });
        const std::vector<Binding> lists = {{"uRecords", record},
                                            {"uEntries", entry, Format::R32UI},
                                            {"uStarts", starts, Format::RG32UI},
                                            {"uTiles", tiles, Format::R32UI},
                                            {"uState", state, Format::R32UI}};
        const Kernel& tileKernel = tall ? shaders::rasterTileTall : shaders::rasterTile;
        const auto drawTiles = [&](const char* name, const Kernel& plain, const ComputeOptions& options,
                                   std::uint64_t groups) {
            return graph.compute(name, kernel(plain), options)
                .reads(lists)
                .reads(limit)
                .modifies({{"uVisibility", target.visibility, window}, {"uCounters", target.counters}})
                .indirect(state)
                .record(
                    [push, state, groups](Commands& c) { c.push(push()).dispatchIndirect(state, groups); });
        };
        // Where nothing has been drawn yet, tiles need not read what they write over. One of the two has no
        // workgroups: rasterScan.comp.
        const auto drawPaired = [&](const char* name, bool fresh, std::uint64_t groups) {
            ComputeOptions options = projection;
            options.spec["FRESH"] = fresh;
            drawTiles(name, tileKernel, options, groups)
                .modifies({{"uVisibilityTexels", target.visibility, window, Format::RGBA32UI}});
        };
        if (paired && isFirst) drawPaired("raster.tileFresh", true, kFreshGroups);
        if (paired)
            drawPaired("raster.tile", false, kTileGroups);
        else
            drawTiles("raster.tile", shaders::rasterTileMore, tiled(0), kTileGroups);
        drawTiles("raster.tileMore", shaders::rasterTileMore, tiled(1), kMoreGroups);
    };

    if (!target.clusters) {
        for (std::uint32_t first = 0; first < triangles.count; first += batch) {
            const std::uint32_t count = std::min(batch, triangles.count - first);
            drawBatch(first == 0, {}, [&] {
                setUp(shaders::rasterSetup, projection).record([pushOf, first, count](Commands& c) {
                    c.push(pushOf(first, count)).dispatch((count + kSetupTriangles - 1) / kSetupTriangles);
                });
            });
        }
        return;
    }

    const std::uint32_t clusters = target.clusters->count(), triangleCount = triangles.count;
    assert(clusters == (triangleCount + kClusterTriangles - 1) / kClusterTriangles);
    const std::uint32_t inBatch = batch / kClusterTriangles, batches = (clusters + inBatch - 1) / inBatch;
    const std::uint32_t cellsX = (width + kDepthCell - 1) / kDepthCell,
                        cellsY = (height + kDepthCell - 1) / kDepthCell;
    std::uint64_t pyramidCells = 0;
    for (std::uint32_t level = 0;; ++level) {
        const std::uint64_t x = (cellsX + (1u << level) - 1) >> level,
                            y = (cellsY + (1u << level) - 1) >> level;
        pyramidCells += x * y;
        if (x == 1 && y == 1) break;
    }
    clusterState = graph.buffer("raster.clusterState", {kClusterStateBytes + std::uint64_t(batches) * 48});
    const Buffer list = graph.buffer("raster.clusterList", {std::uint64_t(clusters) * 8});
    const Buffer pyramid = graph.buffer("raster.pyramid", {pyramidCells * 4}),
                 found = graph.buffer("raster.clustersFound", {4});
    const Buffer bounds = graph.import(target.clusters->bounds()),
                 seen = graph.import(target.clusters->seen());
    graph.fill("raster.clearClusters", clusterState, 0);
    graph.fill("raster.clearList", list, 0);
    graph.fill("raster.clearFound", found, 0);
    graph.compute("raster.cull", shaders::rasterCull, projection)
        .reads({{"uBounds", bounds, Format::RGBA32F}})
        .modifies({{"uSeen", seen}, {"uClusterState", clusterState}, {"uCounters", target.counters}})
        .modifies({{"uList", list}})
        .record([pushOf, clusters, triangleCount](Commands& c) {
            for (std::uint32_t first = 0; first < clusters; first += kClustersAtOnce)
                c.push(pushOf(first, triangleCount))
                    .dispatchInvocations(std::min(kClustersAtOnce, clusters - first));
        });
    const auto drawPhase = [&](std::int32_t phase) {
        graph.compute("raster.clusterPlan", shaders::rasterClusterPlan, {.spec = {{"PHASE", phase}}})
            .modifies({{"uState", clusterState}})
            .reads({{"uFound", found}})
            .record([=](Commands& c) {
                c.push(std::array{clusters, inBatch, batches, cellsX | cellsY << 16}).dispatch(1);
            });
        ComputeOptions options = projection;
        options.spec["PHASE"] = phase;
        for (std::uint32_t k = 0; k < batches; ++k) {
            const std::uint64_t groups = kClusterStateBytes + (std::uint64_t(phase) * batches + k) * 24;
            drawBatch(phase == 0 && k == 0, groups + 12, [&] {
                setUp(shaders::rasterSetupClusters, options)
                    .reads({{"uClusterList", list, Format::R32UI},
                            {"uClusterState", clusterState, Format::R32UI}})
                    .indirect(clusterState)
                    .record([=](Commands& c) {
                        c.push(pushOf(k * inBatch, triangleCount)).dispatchIndirect(clusterState, groups);
                    });
            });
        }
    };
    drawPhase(0);
    graph.compute("raster.depths", shaders::rasterDepths)
        .reads({{"uVisibility", target.visibility, window, Format::RG32UI}})
        .overwrites({{"uPyramid", pyramid}})
        .indirect(clusterState)
        .record([=](Commands& c) { c.push(pushOf(0, 0)).dispatchIndirect(clusterState, kDepthGroups); });
    graph.compute("raster.pyramid", shaders::rasterPyramid)
        .modifies({{"uPyramid", pyramid}})
        .indirect(clusterState)
        .record([=](Commands& c) { c.push(pushOf(0, 0)).dispatchIndirect(clusterState, kPyramidGroups); });
    graph.compute("raster.cullHidden", shaders::rasterCullHidden, projection)
        .reads({{"uBounds", bounds, Format::RGBA32F}, {"uPyramid", pyramid, Format::R32UI}})
        .reads({{"uClusterState", clusterState}})
        .modifies({{"uFound", found}, {"uList", list}, {"uCounters", target.counters}})
        .indirect(clusterState)
        .record([=](Commands& c) {
            c.push(pushOf(0, triangleCount)).dispatchIndirect(clusterState, kTestGroups);
        });
    drawPhase(1);
    graph.compute("raster.mark", shaders::rasterMark)
        .reads({{"uVisibility", target.visibility, window, Format::RG32UI}})
        .writes({{"uSeen", seen}})
        .record([=](Commands& c) { c.push(pushOf(0, 0)).dispatchOver((width + 1) / 2, (height + 1) / 2); });
}

}  // namespace helio
