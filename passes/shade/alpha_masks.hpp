#pragma once
/** @file
 * Visibility through alpha masks: like AlphaLayers it peels, but keeps the keys alone, each of the first
 * surface whose mask does not let all through. For what is shaded later or never: samples of multisampling,
 * and shadow maps. Blended surfaces count as opaque where they stop any light.
 */
#include "passes/shade/alpha_layers.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace helio {

class AlphaMasks {
public:
    /** Keys go to `keys`. Must not outlive the pipelines or the keys; `view` is read at every drawing, its
     * size and kind of projection may not change. Masks are sampled with `filter`. */
    AlphaMasks(Device& device, const RasterPipeline& raster, ShadePipeline& shade, DeviceBuffer& keys,
               std::shared_ptr<const RasterView> view, TextureFilter filter);

    /** Draws an image's keys, all of them, from `firstKey` on. */
    AlphaLayers::Drawing draw(std::uint64_t firstKey,
                              const std::function<void(const std::vector<PassTiming>&)>& timings = {});

private:
    DeviceBuffer limit_;
    std::shared_ptr<std::uint32_t> firstKey_ = std::make_shared<std::uint32_t>(0);
    Plan begin_, layer_;
    Readback<std::uint32_t> open_;
    Readback<RasterCounters> counters_;
};

/** Draws the shadow maps of a scene, with its masks where it has any: once, before it is shaded. Returns the
 * texels with more than AlphaLayers::kMaxLayers masks before each other. */
std::uint64_t drawShadowMaps(Device& device, ShadePipeline& shade);

}  // namespace helio
