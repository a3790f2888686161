#pragma once
/** @file
 * Surfaces that let light through (alpha masks and blending), in any order: the scene is drawn layer by
 * layer, nearest first, each pass leaving out what is not behind the layer before. This is depth peeling on
 * the rasterizer's keys, which tell equal depths apart by the triangle's id; exact for any number of layers
 * up to kMaxLayers, in memory that does not grow with them. (Everitt, Interactive Order-Independent
 * Transparency, 2001.) Where light goes through surfaces their order tells exactly what thin walls show, and
 * pictures of what lies behind what volumes and rough surfaces do (RefractionPictures).
 */
#include "passes/raster/raster_pipeline.hpp"
#include "passes/shade/refraction.hpp"
#include "passes/shade/shade.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace helio {

class AlphaLayers {
public:
    /** Layers of a pixel at most; what lies behind is left out. */
    static constexpr std::uint32_t kMaxLayers = 256;

    /** Must not outlive the pipelines; `view` is read at every drawing. */
    AlphaLayers(Device& device, const RasterPipeline& raster, ShadePipeline& shade,
                std::shared_ptr<const RasterView> view);

    struct Drawing {
        std::uint32_t layers = 0;
        std::uint32_t open = 0;                ///< pixels with more than kMaxLayers layers
        std::uint32_t refracting = 0;          ///< most refracting layers of a pixel, of those left out
        std::uint32_t pictures = 1;            ///< the visible one and those of what refracting layers show
        std::vector<RasterCounters> counters;  ///< of every layer
    };
    /** Draws all layers. `timings` is given those of each plan. */
    Drawing draw(const std::function<void(const std::vector<PassTiming>&)>& timings = {});
    /** Runs `begin` once and `layer` until no pixel is open, at most kMaxLayers times. */
    static Drawing peel(Plan& begin, Plan& layer, const Readback<std::uint32_t>& open,
                        const Readback<RasterCounters>& counters,
                        const std::function<void(const std::vector<PassTiming>&)>& timings);

    /** What the last drawing left, as LayerTarget says. */
    DeviceBuffer& color() { return color_; }
    DeviceBuffer& albedoDepth() { return albedoDepth_; }
    DeviceBuffer& normal() { return normal_; }
    DeviceBuffer& ids() { return ids_; }
    /** Graphviz of a layer's plan. */
    std::string graphviz() const { return layer_.graphviz(); }

private:
    std::unique_ptr<RefractionPictures> refraction_;  ///< where light goes through surfaces
    DeviceBuffer color_, limit_, albedoDepth_, normal_, ids_;
    Plan begin_, layer_;
    Readback<std::uint32_t> open_;
    Readback<RasterCounters> counters_;
};

}  // namespace helio
