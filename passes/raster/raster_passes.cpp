#include "passes/raster/raster_passes.hpp"

#include <heliograph_kernels/raster.hpp>

#include <algorithm>
#include <cassert>

namespace helio {
namespace {

// As in shaders/raster/state.glsl.
constexpr int kCellLevels = 6;
constexpr std::uint64_t kStateBytes = 96;
constexpr std::uint64_t kLargeGroups = 16, kClipGroups = 28, kFillGroups = 40, kTileGroups = 52,
                        kMoreGroups = 64, kFreshGroups = 80;
constexpr std::uint32_t kNarrowTiles = 4;       // of a workgroup of rasterTileNarrow
constexpr std::uint32_t kSetupTriangles = 512;  // of a workgroup of set-up

std::uint64_t cellCount(std::uint32_t width, std::uint32_t height) {
    std::uint64_t cells = 0;
    for (int level = 0; level < kCellLevels; ++level) {
        const std::uint64_t side = 16ull << (2 * level);
        cells += ((width + side - 1) / side) * ((height + side - 1) / side);
    }
    return cells;
}

/** As slotsOf() in shaders/raster/bin.glsl, of all cells. */
std::uint64_t cellSlots(std::uint32_t width, std::uint32_t height) {
    constexpr std::uint64_t tileSlots = 128, mostSlots = 2048, slotTiles = 32768;
    std::uint64_t slots = 0;
    for (int level = 0; level < kCellLevels; ++level) {
        const std::uint64_t side = 16ull << (2 * level);
        const std::uint64_t cells = ((width + side - 1) / side) * ((height + side - 1) / side);
        if (level == 0 && cells > slotTiles) return 0;
        slots += cells * std::min(tileSlots << (4 * level), mostSlots);
    }
    return slots;
}

}  // namespace

RasterPasses::RasterPasses(Graph& graph, const RasterTriangles& triangles,
                           std::shared_ptr<const RasterView> view, const RasterTarget& target,
                           const RasterOptions& options, std::uint64_t maxStorageBufferRange)
    : graph_(graph),
      triangles_(triangles),
      view_(std::move(view)),
      target_(target),
      options_(options),
      window_{target.offset, std::uint64_t(view_->width) * view_->height * 8},
      batch_(std::min(options.batch, triangles.count)) {
    // Workgroups of set-up take whole clusters.
    if (target.clusters) batch_ = std::max(batch_ / kSetupTriangles, 1u) * kSetupTriangles;
    const std::uint32_t width = view_->width, height = view_->height;
    const std::uint64_t cells = cellCount(width, height);
    const std::uint64_t slots = cellSlots(width, height);
    const std::uint64_t records = std::uint64_t(batch_) * kClipParts;
    // No record may need more entries than there are cells; and each must find room for at least one.
    entries_ =
        std::max(records, std::min({records * cells, options.entries, maxStorageBufferRange / 4 - slots}));
    if (target.limit) limit_ = {{"uLimit", *target.limit, Format::RG32UI}};

    state_ = graph.buffer("raster.state", {kStateBytes});
    large_ = graph.buffer("raster.large", {std::uint64_t(batch_) * 4});
    clipped_ = graph.buffer("raster.clipped", {std::uint64_t(batch_) * 4});
    records_ = graph.buffer("raster.records", {records * kRecordBytes});
    counts_ = graph.buffer("raster.counts", {cells * 4});
    starts_ = graph.buffer("raster.starts", {cells * 8});
    tiles_ = graph.buffer("raster.tiles", {std::uint64_t((width + 15) / 16) * ((height + 15) / 16) * 4});
    entry_ = graph.buffer("raster.entries", {(slots + entries_) * 4});
    graph.fill("raster.clearCounts", counts_, 0);
}

ComputeOptions RasterPasses::projection() const {
    return {.spec = {{"ORTHOGRAPHIC", view_->orthographic}, {"DEPTH_FORMAT", std::int32_t(options_.depth)}}};
}

Kernel RasterPasses::peeling(const Kernel& plain) const {
    return target_.limit ? compileVariant(plain, {.defines = {{"PEEL", "1"}}, .generated = {}}) : plain;
}

std::function<RasterPush(std::uint32_t, std::uint32_t)> RasterPasses::pushOf() const {
    const std::uint32_t flags = options_.cullBackFaces ? kRasterCullBack : 0u;
    return [view = view_, flags, orthographic = view_->orthographic, depth = options_.depth](
               std::uint32_t first, std::uint32_t count) {
        assert(view->orthographic == orthographic);
        assert(orthographic || depth == DepthFormat::Reversed || view->depthSlope > 0);
        return makeRasterPush(*view, flags, first, count);
    };
}

Pass RasterPasses::setUp(const Kernel& plain, ComputeOptions options) {
    options.spec["LANES"] = isNarrow() ? 16u : 64u;
    return graph_.compute("raster.setup", peeling(plain), options)
        .reads({{"uTriangles", triangles_.buffer}})
        .reads(limit_)
        .modifies({{"uVisibility", target_.visibility, window_},
                   {"uState", state_},
                   {"uCounters", target_.counters}})
        .overwrites({{"uLarge", large_}, {"uClipped", clipped_}});
}

void RasterPasses::drawAll() {
    const bool gathers =
        options_.gather.value_or(triangles_.count > std::uint64_t(view_->width) * view_->height);
    const Kernel& kernel = gathers ? shaders::rasterSetupTiny : shaders::rasterSetup;
    // Triangles that are few for the pixels are most often large, and tiles need not read where nothing has
    // been drawn before them.
    ComputeOptions options = projection();
    options.spec["DIRECT"] = options_.direct.value_or(
        !isNarrow() || triangles_.count * 64ull >= std::uint64_t(view_->width) * view_->height);
    for (std::uint32_t first = 0; first < triangles_.count; first += batch_) {
        const std::uint32_t count = std::min(batch_, triangles_.count - first);
        drawBatch(first == 0, {}, [&] {
            setUp(kernel, options).record([push = pushOf(), first, count](Commands& c) {
                c.push(push(first, count)).dispatch((count + kSetupTriangles - 1) / kSetupTriangles);
            });
        });
    }
}

void RasterPasses::drawBatch(bool isFirst, std::optional<std::uint64_t> once,
                             const std::function<void()>& setUpBatch) {
    graph_.fill("raster.clearState", state_, 0);
    setUpBatch();
    listBatch(isFirst, once);
    drawTiles(isFirst);
}

void RasterPasses::listBatch(bool isFirst, std::optional<std::uint64_t> once) {
    const auto push = [push = pushOf()] { return push(0, 0); };
    // One workgroup; none where culling has left nothing.
    const auto dispatchOnce = [state = clusterState_, once](Commands& c) {
        if (once)
            c.dispatchIndirect(state, *once);
        else
            c.dispatch(1);
    };
    Pass plan = graph_.compute("raster.plan", shaders::rasterPlan)
                    .modifies({{"uState", state_}})
                    .record([entries = entries_, dispatchOnce](Commands& c) {
                        c.push(std::uint32_t(entries));
                        dispatchOnce(c);
                    });
    if (once) plan.indirect(clusterState_);
    graph_.compute("raster.large", shaders::rasterLarge, projection())
        .reads({{"uTriangles", triangles_.buffer}, {"uState", state_}, {"uLarge", large_}})
        .overwrites({{"uRecords", records_}, {"uEntries", entry_}})
        .modifies({{"uCounts", counts_}})
        .indirect(state_)
        .record(
            [push, state = state_](Commands& c) { c.push(push()).dispatchIndirect(state, kLargeGroups); });
    graph_.compute("raster.clip", shaders::rasterClip, projection())
        .reads({{"uTriangles", triangles_.buffer}, {"uState", state_}, {"uClipped", clipped_}})
        .writes({{"uRecords", records_}, {"uEntries", entry_}})
        .modifies({{"uCounts", counts_}, {"uCounters", target_.counters}})
        .indirect(state_)
        .record([push, state = state_](Commands& c) { c.push(push()).dispatchIndirect(state, kClipGroups); });
    ComputeOptions grouped;
    grouped.spec["GROUP_TILES"] = isFourfold() ? kNarrowTiles : 1u;
    grouped.spec["MAY_START_FRESH"] = isPaired() && isFirst;
    Pass scan = graph_.compute("raster.scan", shaders::rasterScan, grouped)
                    .overwrites({{"uStarts", starts_}, {"uTiles", tiles_}})
                    .modifies({{"uCounts", counts_},
                               {"uCountTexels", counts_, Format::R32UI},
                               {"uState", state_},
                               {"uCounters", target_.counters}})
                    .record([push, dispatchOnce](Commands& c) {
                        c.push(push());
                        dispatchOnce(c);
                    });
    if (once) scan.indirect(clusterState_);
    graph_.compute("raster.fill", shaders::rasterFill)
        .reads({{"uRecords", records_}, {"uState", state_}, {"uStarts", starts_}})
        .modifies({{"uCounts", counts_}})
        .writes({{"uEntries", entry_}})
        .indirect(state_)
        .record([push, state = state_](Commands& c) { c.push(push()).dispatchIndirect(state, kFillGroups); });
}

Pass RasterPasses::drawTiles(const char* name, const Kernel& plain, const ComputeOptions& options,
                             std::uint64_t groups) {
    return graph_.compute(name, peeling(plain), options)
        .reads({{"uRecords", records_},
                {"uEntries", entry_, Format::R32UI},
                {"uStarts", starts_, Format::RG32UI},
                {"uTiles", tiles_, Format::R32UI},
                {"uState", state_, Format::R32UI}})
        .reads(limit_)
        .modifies({{"uVisibility", target_.visibility, window_}, {"uCounters", target_.counters}})
        .indirect(state_)
        .record([push = pushOf(), state = state_, groups](Commands& c) {
            c.push(push(0, 0)).dispatchIndirect(state, groups);
        });
}

void RasterPasses::drawTiles(bool isFirst) {
    // Where nothing has been drawn yet, tiles need not read what they write over. One of the two has no
    // workgroups: rasterScan.comp.
    const auto drawPaired = [&](const char* name, bool fresh, std::uint64_t groups) {
        ComputeOptions options = projection();
        options.spec["FRESH"] = fresh;
        drawTiles(name, isFourfold() ? shaders::rasterTileNarrow : shaders::rasterTile, options, groups)
            .modifies({{"uVisibilityTexels", target_.visibility, window_, Format::RGBA32UI}});
    };
    const auto drawSegments = [&](const char* name, std::uint32_t firstSegment, std::uint64_t groups) {
        ComputeOptions options = projection();
        options.spec["FIRST_SEGMENT"] = firstSegment;
        drawTiles(name, shaders::rasterTileMore, options, groups);
    };
    if (isPaired() && isFirst) drawPaired("raster.tileFresh", true, kFreshGroups);
    if (isPaired())
        drawPaired("raster.tile", false, kTileGroups);
    else
        drawSegments("raster.tile", 0, kTileGroups);
    drawSegments("raster.tileMore", 1, kMoreGroups);
}

}  // namespace helio
