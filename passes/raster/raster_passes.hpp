#pragma once
/** @file The passes that draw one image: each batch of triangles is set up, listed by tiles and drawn. */
#include "passes/raster/push.hpp"
#include "passes/raster/raster_pipeline.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace helio {

/** Declares them in a graph. Keys and counters are cleared by then. */
class RasterPasses {
public:
    // As in shaders/raster/state.glsl.
    static constexpr std::uint32_t kClipParts = 6;     ///< records that a triangle may become
    static constexpr std::uint32_t kRecordBytes = 64;  ///< of each

    /** `triangles` are some; `options` are those of a RasterPipeline, fitted to the device. */
    RasterPasses(Graph& graph, const RasterTriangles& triangles, std::shared_ptr<const RasterView> view,
                 const RasterTarget& target, const RasterOptions& options,
                 std::uint64_t maxStorageBufferRange);

    void drawAll();
    /** All but what `target.clusters` shows to be hidden; see raster_clusters.hpp. */
    void drawVisible();

private:
    /** What the passes of culling share. */
    struct Culling;

    ComputeOptions projection() const;
    Kernel peeling(const Kernel& plain) const;
    /** What is pushed for a view: a function, since cameras may change between two executions. */
    std::function<RasterPush(std::uint32_t first, std::uint32_t count)> pushOf() const;

    /** The pass that sets up a batch, without its commands. */
    Pass setUp(const Kernel& plain, ComputeOptions options);
    /** Draws what `setUpBatch` sets up; `isFirst`: nothing has been drawn before; `once`: where in
     * `clusterState_` it says whether there is anything to draw. */
    void drawBatch(bool isFirst, std::optional<std::uint64_t> once, const std::function<void()>& setUpBatch);
    /** Records of what has been set up, and the tiles' lists of them. */
    void listBatch(bool isFirst, std::optional<std::uint64_t> once);
    void drawTiles(bool isFirst);
    Pass drawTiles(const char* name, const Kernel& plain, const ComputeOptions& options,
                   std::uint64_t groups);
    void drawPhase(const Culling& culling, std::int32_t phase);
    void cullHidden(const Culling& culling);

    /** Two keys are read and written at a time. */
    bool isPaired() const { return view_->width % 2 == 0; }
    bool isNarrow() const { return options_.tileLanes == 8; }
    /** Four keys are written at a time. */
    bool isFourfold() const { return isNarrow() && view_->width % 4 == 0; }

    Graph& graph_;
    RasterTriangles triangles_;
    std::shared_ptr<const RasterView> view_;
    RasterTarget target_;
    RasterOptions options_;
    Window window_;            ///< of the keys in their buffer
    std::uint32_t batch_ = 0;  ///< triangles
    std::uint64_t entries_ = 0;
    std::vector<Binding> limit_;
    Buffer state_, large_, clipped_, records_, counts_, starts_, tiles_, entry_;
    Buffer clusterState_;  ///< where clusters are culled
};

}  // namespace helio
