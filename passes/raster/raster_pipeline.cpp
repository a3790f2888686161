#include "passes/raster/raster_pipeline.hpp"

#include "passes/raster/raster_passes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>

namespace helio {
namespace {

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
    assert(options.tileLanes == 0 || options.tileLanes == 8 || options.tileLanes == 32);
    const bool isNarrow = device.info().subgroupSize <= 8;
    if (options_.tileLanes == 0 || !isNarrow) options_.tileLanes = isNarrow ? 8 : 32;
    if (options_.tileLanes != 8) options_.gather = false;
    requireRasterCapabilities(device.info());
    // A record is 64 bytes and all of a batch must be in reach of one binding; indirect dispatches have at
    // most 65,535 workgroups of 64.
    const std::uint64_t records =
        std::min<std::uint64_t>(maxStorageBufferRange_ / RasterPasses::kRecordBytes, 65535u * 64u);
    options_.batch =
        std::uint32_t(std::clamp<std::uint64_t>(options_.batch, 1, records / RasterPasses::kClipParts));
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
    checkSize(view->width, view->height, maxStorageBufferRange_);
    if (triangles.count == 0) return;
    RasterPasses passes(graph, triangles, std::move(view), target, options_, maxStorageBufferRange_);
    if (target.clusters)
        passes.drawVisible();
    else
        passes.drawAll();
}

}  // namespace helio
