#include "passes/temporal/temporal.hpp"

#include "passes/raster/push.hpp"

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <heliograph_kernels/temporal.hpp>

#include <algorithm>

namespace helio {
namespace {

/** TemporalFrame of temporalResolve.comp. */
struct TemporalFrame {
    double rowX[4], rowY[4], rowW[4];
    double depthOffset, depthSlope;
    float position[2];
    float mostWeight;
    std::uint32_t flags;
};
static_assert(sizeof(TemporalFrame) == 128);
constexpr std::uint32_t kHasHistory = 1, kSameView = 2, kSceneChanged = 4;

std::uint64_t pixels(const std::array<std::uint32_t, 2>& size) {
    return std::uint64_t(size[0]) * size[1];
}

bool sameView(const RasterView& a, const RasterView& b) {
    return a.eye == b.eye && a.rowX == b.rowX && a.rowY == b.rowY && a.rowW == b.rowW &&
           a.orthographic == b.orthographic;
}

double halton(std::uint32_t base, std::uint32_t n) {
    double scale = 1, sum = 0;
    for (; n > 0; n /= base) sum += (scale /= base) * (n % base);
    return sum;
}

}  // namespace

std::vector<std::array<float, 2>> temporalPositions(std::uint32_t upscale) {
    std::vector<std::array<float, 2>> positions;
    for (std::uint32_t k = 1; k <= 16 * upscale * upscale; ++k)
        positions.push_back({float(halton(2, k)), float(halton(3, k))});
    return positions;
}

TemporalHistory::TemporalHistory(Device& device, std::array<std::uint32_t, 2> size, std::uint32_t upscale,
                                 std::uint32_t triangles)
    : size_(size),
      upscale_(upscale),
      triangles_(triangles),
      color_(device, "temporal.history", pixels(size) * 16),
      keys_(device, "temporal.keys", pixels(size) / (upscale * upscale) * 8),
      corners_(device, "temporal.corners", std::uint64_t(triangles) * 48),
      parameters_(device, "temporal.frame", sizeof(TemporalFrame)) {}

bool TemporalHistory::fits(std::array<std::uint32_t, 2> size, std::uint32_t upscale,
                           std::uint32_t triangles) const {
    return size == size_ && upscale == upscale_ && triangles == triangles_;
}

RasterView TemporalHistory::frameView(const RasterView& picture) const {
    RasterView view = picture;
    view.rowX /= double(upscale_);
    view.rowY /= double(upscale_);
    view.width /= upscale_;
    view.height /= upscale_;
    return view;
}

Buffer TemporalHistory::declare(Graph& graph, const Frame& frame, std::shared_ptr<const RasterView> view) {
    const std::array<std::uint32_t, 2> size = size_;
    const Buffer resolved = graph.buffer("temporal.resolved", {pixels(size) * 16}),
                 history = graph.import(color_), keys = graph.import(keys_);
    Kernel kernel = shaders::temporalResolve;
    if (triangles_ > 0) kernel = compileVariant(kernel, {.defines = {{"MOVING", "1"}}, .generated = {}});
    ComputeOptions options;
    options.spec["UPSCALE"] = std::int32_t(upscale_);
    options.spec["ORTHOGRAPHIC"] = view->orthographic;
    Pass pass = graph.compute("temporal.resolve", kernel, options);
    pass.reads({{"uKeys", frame.keys, Format::RG32UI},
                {"uColor", frame.color, Format::RGBA32F},
                {"uHistory", history, Format::RGBA32F},
                {"uPreviousKeys", keys, Format::RG32UI},
                {"uTriangles", frame.triangles, Format::RGBA32UI},
                {"uFrame", graph.import(parameters_)}})
        .overwrites({{"uResolved", resolved}})
        .record([view = std::move(view), size](Commands& c) {
            c.push(makeRasterPush(*view, 0, 0, 0)).dispatchOver(size[0], size[1]);
        });
    if (triangles_ > 0) {
        const Buffer corners = graph.import(corners_);
        pass.reads({{"uPreviousTriangles", corners, Format::RGBA32UI}});
        graph.copy("temporal.keepTriangles", frame.triangles, corners);
    }
    graph.copy("temporal.keep", resolved, history);
    graph.copy("temporal.keepKeys", frame.keys, keys);
    return resolved;
}

void TemporalHistory::beginFrame(const RasterView& centre, const std::array<float, 2>& position, double blend,
                                 bool sceneChanged) {
    const RasterView& previous = isEmpty_ ? centre : previous_;
    const std::uint32_t flags = (isEmpty_ ? 0 : kHasHistory) | (sameView(centre, previous) ? kSameView : 0) |
                                (sceneChanged ? kSceneChanged : 0);
    const TemporalFrame frame{{previous.rowX.x, previous.rowX.y, previous.rowX.z, previous.eye.x},
                              {previous.rowY.x, previous.rowY.y, previous.rowY.z, previous.eye.y},
                              {previous.rowW.x, previous.rowW.y, previous.rowW.z, previous.eye.z},
                              previous.depthOffset,
                              previous.depthSlope,
                              {position[0], position[1]},
                              float(1 / blend - 1),
                              flags};
    parameters_.upload(&frame, sizeof frame);
    previous_ = centre;
    isEmpty_ = false;
}

}  // namespace helio
