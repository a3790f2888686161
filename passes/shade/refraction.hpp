#pragma once
/** @file
 * The pictures that refracting layers show (shaders/raster/transmission.glsl). Light that a surface lets on
 * in line is found by peeling alone; what a volume or a rough surface deflects is looked up in a picture
 * without that layer. Picture k leaves out the k nearest refracting layers of a pixel, with all before them
 * that lets light through, and its own refracting layers are looked up in picture k + 1: so layers behind one
 * another are seen through each other, up to kMaxPictures of them.
 */
#include "passes/mip/mip_chain.hpp"
#include "passes/shade/shade.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace helio {

/** A buffer of so many bytes for each pixel of a view. */
DeviceBuffer perPixel(Device& device, const char* name, const RasterView& view, std::uint64_t bytes);

class RefractionPictures {
public:
    /** Refracting layers behind one another that are told apart; those behind are left out of what is seen
     * through the last. */
    static constexpr std::uint32_t kMaxPictures = 4;

    /** `refracts`: some light is deflected; `rough`: by rough surfaces, for which mip levels are made. */
    RefractionPictures(Device& device, const RasterView& view, bool refracts, bool rough);

    /** What LayerTarget takes. */
    void declareTarget(Graph& graph, LayerTarget& target);
    /** Declares the clearing of what layers add to. */
    void declareClear(Graph& graph);
    /** Compiles what makes a drawn picture the one behind. */
    void makeKeep(Device& device, DeviceBuffer& color, DeviceBuffer& albedoDepth);

    /** Draws the picture without LayerTarget::leftOut layers; how many of those a pixel has at most. */
    using DrawPicture = std::function<std::uint32_t()>;
    /** Draws all that are needed, the visible one last; `timings` is given those of plans. */
    void draw(const DrawPicture& picture, const std::function<void(const std::vector<PassTiming>&)>& timings);

private:
    bool refracts_;
    std::vector<glm::uvec4> header_;
    MipChains mips_;
    DeviceBuffer passed_, behind_, behindDepth_, headers_, none_;
    std::shared_ptr<std::uint32_t> leftOut_ = std::make_shared<std::uint32_t>(0);
    Plan keep_;
};

}  // namespace helio
