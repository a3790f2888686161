#pragma once
/** @file The raster pipeline of the renderer. */
#include "passes/raster/raster_pipeline.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/render_job.hpp"
#include "passes/shade/shade.hpp"

#include <heliograph/graph.hpp>

#include <cstdint>
#include <memory>

namespace helio {

/** How a scene is packed for rasterization. */
PackOptions rasterPackOptions();

/** The compiled plan of one scene, size and culling; the camera may differ from run to run. Must not outlive
 * the scene. Not movable. */
class RasterSession {
public:
    RasterSession(Device& device, PreparedScene& scene, const RasterView& view, const RenderOptions& options);
    RasterSession(const RasterSession&) = delete;
    RasterSession& operator=(const RasterSession&) = delete;

    bool fits(const RasterView& view, const RenderOptions& options) const {
        return options.size == size_ && options.cullBackFaces == cull_ &&
               view.orthographic == view_->orthographic;
    }
    /** One sample at every pixel's centre. */
    void render(const RasterView& view, RenderJob& job);

private:
    void makeMips(Device& device);

    std::array<std::uint32_t, 2> size_;
    bool cull_, auxiliary_ = true;
    std::shared_ptr<RasterView> view_;
    RasterPipeline raster_;
    ShadePipeline shade_;
    Plan plan_;
    Readback<float> color_, albedoDepth_, normal_;
    Readback<std::int32_t> ids_;
};

/** Rasterizes and shades; fills in the job's result. There is no Monte Carlo error: relMSE is 0, and not
 * reliable, since the aliasing of one sample is not measured. */
void renderRaster(Device& device, PreparedScene& scene, const View& view, RenderJob& job);

}  // namespace helio
