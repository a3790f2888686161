#pragma once
/** @file The raster pipeline of the renderer. */
#include "passes/antialias/antialias.hpp"
#include "passes/raster/raster_pipeline.hpp"
#include "passes/renderer/frame.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/render_job.hpp"
#include "passes/shade/alpha_masks.hpp"
#include "passes/shade/shade.hpp"
#include "passes/temporal/temporal.hpp"

#include <heliograph/graph.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace helio {

/** How a scene is packed for rasterization. */
PackOptions rasterPackOptions();

/** Which of several frames is drawn. */
struct TemporalStep {
    std::shared_ptr<TemporalHistory> history;  ///< none: a picture of its own
    std::uint32_t frame = 0, frames = 1;
    bool sceneChanged = false;  ///< since the last frame
};

/** The compiled plans of one scene, size, culling and antialiasing; the camera and the samples' positions may
 * differ from run to run. Must not outlive the scene. Not movable. */
class RasterSession {
public:
    RasterSession(Device& device, PreparedScene& scene, const RasterView& view, const RenderOptions& options,
                  const TemporalStep& step);
    RasterSession(const RasterSession&) = delete;
    RasterSession& operator=(const RasterSession&) = delete;

    bool fits(const RasterView& view, const RenderOptions& options, const TemporalStep& step) const;
    /** `lens`: where the camera has one; supersampling takes a point of it for every sample. Of several
     * frames the last (or that at which the application cancels) gives the picture. */
    void render(const RasterView& view, const std::optional<ThinLens>& lens, RenderJob& job,
                const TemporalStep& step);

private:
    using Kind = Antialiasing::Kind;
    void makeMips(Device& device);
    void makeShadows(Device& device);
    void makeClusters(Device& device, DeviceScene& scene);
    void makeCentrePlan(Device& device);
    void makeSupersamplePlan(Device& device);
    void declareSamples(Graph& graph, Buffer visibility, std::uint64_t stride);
    void makeMultisamplePlan(Device& device);
    void makeTemporalPlan(Device& device, const TemporalStep& step);
    /** Draws a frame; whether it is the last. */
    bool drawFrame(const RasterView& view, RenderJob& job, const TemporalStep& step,
                   std::vector<float>& color);
    /** Instead of the other plans but multisampling's, where surfaces let light through. */
    void makeLayers(Device& device);
    void drawLayers(const RasterView& view, RenderJob& job);
    void drawMaskedSamples(RenderJob& job);
    bool layeredPicture(const RasterView& view, const std::optional<ThinLens>& lens, RenderJob& job,
                        std::vector<float>& color);
    /** The picture, vec4 a pixel; false where the application cancels. */
    bool picture(const RasterView& view, const std::optional<ThinLens>& lens, RenderJob& job,
                 std::vector<float>& color);
    /** First hits, per pixel. */
    struct Auxiliary {
        std::vector<float> albedoDepth, normal;
        std::vector<std::int32_t> ids;
    };
    Auxiliary auxiliary(const RasterView& view, RenderJob& job);
    void addAuxiliary(Frame& frame, const Auxiliary& hits, std::uint32_t sampleCount) const;
    void addWork(const RasterCounters& counters);
    void noteCounters(RenderResult& result) const;

    std::array<std::uint32_t, 2> size_;
    bool cull_, auxiliary_;
    Kind asked_, kind_;  ///< multisampling is supersampling where surfaces let light through
    std::size_t sampleCount_;
    std::shared_ptr<RasterView> view_;
    DepthFormat depth_;
    RasterPipeline raster_;
    Shadows shadows_;
    TextureFilter filter_;
    std::uint32_t lightSamples_;
    Shading shading_;
    ShadePipeline shade_;
    std::unique_ptr<RasterClusters> clusters_;  ///< of large scenes, to cull what is hidden
    /** The pixels' centres: first hits, and without samples the picture. */
    Plan plan_;
    Readback<float> color_, albedoDepth_, normal_;
    Readback<std::int32_t> ids_;
    Readback<RasterCounters> counters_;
    /** One sample (supersampling) or all of them. */
    Plan samplePlan_;
    std::vector<std::shared_ptr<RasterView>> sampleViews_;
    std::shared_ptr<AddWeight> weight_ = std::make_shared<AddWeight>();
    std::optional<DeviceBuffer> sum_;
    Readback<float> sampleColor_;
    /** Multisampling with alpha masks: the samples' keys, found before they are shaded. */
    std::optional<DeviceBuffer> sampleKeys_;
    std::shared_ptr<RasterView> maskView_;
    std::unique_ptr<AlphaMasks> masks_;
    Readback<std::uint32_t> shadings_;
    std::shared_ptr<RasterView> layerView_;
    std::unique_ptr<AlphaLayers> layers_;
    std::shared_ptr<TemporalHistory> history_;
    std::unique_ptr<AlphaLayers> hitLayers_;  ///< of the picture's pixels, where frames have fewer
    AlphaLayers::Drawing drawn_;              ///< most layers and open pixels of this picture
    std::uint64_t openTexels_ = 0;            ///< of shadow maps
    RasterCounters work_;
    std::uint64_t shaded_ = 0, corners_ = 0;
};

/** Rasterizes and shades; fills in the job's result. There is no Monte Carlo error: relMSE is 0, and not
 * reliable, since the aliasing of one sample is not measured. */
void renderRaster(Device& device, PreparedScene& scene, const View& view, RenderJob& job,
                  const TemporalStep& step = {});

}  // namespace helio
