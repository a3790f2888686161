#pragma once
/** @file
 * First shading of a visibility buffer. Per pixel: perspective-correct attributes with exact derivatives,
 * base colour (factor, vertex colour, texture filtered over mip levels), flat or smooth normal turned to the
 * viewer, and two-sided Lambert reflection of
 *  - emissive surfaces in the light table, by Lambert's formula for polygons cut at the horizon: the exact
 *    irradiance of what nothing covers,
 *  - point, spot and directional lights with glTF's falloff, shadowed by maps where asked (passes/shadow),
 *  - the environment over the whole hemisphere, diffuse and, by split sums, glossy,
 * plus the surface's own emission (front face, or both where double-sided). What is left out is in skipped().
 */
#include "passes/environment/specular_environment.hpp"
#include "passes/mip/mip_chain.hpp"
#include "passes/raster/raster_pipeline.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/shadow/shadow_maps.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace helio {

/** Per pixel, rows from the top; the channels of the path tracer's first hit. */
struct ShadeOutput {
    Buffer color;        ///< vec4: linear RGB radiance, 1 (0 for a miss, whose colour is the environment's)
    Buffer albedoDepth;  ///< vec4: base colour, distance along the viewing axis; 0 for a miss
    Buffer normal;       ///< vec4: unit shading normal towards the viewer, 0; 0 for a miss
    Buffer ids;          ///< ivec2: instance, triangle within it; -1 for a miss
};

/** Of multisampling, per pixel, rows from the top. */
struct MultisampleOutput {
    Buffer color;     ///< vec4: linear RGB radiance, covered share
    Buffer shadings;  ///< uint: triangles that were shaded for the pixel
};

/** What layers are added to, per pixel. */
struct LayerTarget {
    Buffer color;                     ///< vec4: radiance so far, what of the light behind is stopped
    Buffer limit;                     ///< 64 bits: the next layer's keys are below; 0 where the pixel is done
    Buffer albedoDepth, normal, ids;  ///< as ShadeOutput's, of the first layer that stops any light
    Buffer open;  ///< uint: pixels that are not done, added to; where light goes through surfaces, behind it
                  ///< uint: the most refracting layers of a pixel
    /** Where light goes through surfaces (ShadePipeline::transmits): passes/shade/refraction.hpp. */
    Buffer passed;                ///< vec4: shares of light that pass, 1 + refracting layers so far
    std::vector<Binding> behind;  ///< the picture of what refracting layers show
    std::shared_ptr<const std::uint32_t> leftOut;  ///< nearest refracting layers of a pixel, left out
};

/** What layers leave where masks alone are looked at, per pixel. */
struct MaskTarget {
    Buffer keys;   ///< of the visible surfaces, several images' beside each other
    Buffer limit;  ///< 64 bits: the next layer's keys are below; 0 where the pixel is done
    Buffer open;   ///< uint: pixels that are not done, added to
    TextureFilter filter = TextureFilter::Bilinear;  ///< of the masks
};

/** Shades one scene. Must outlive the plans it is declared in, as must the scene. */
class ShadePipeline {
public:
    /** Without shadows. */
    ShadePipeline(Device& device, DeviceScene& scene);
    /** `bounds` are the scene's. Where there are over 16 `lightSamples` emissive surfaces in the light
     * table, a pixel draws so many of them; 0 takes all of them always. */
    ShadePipeline(Device& device, DeviceScene& scene, const Scene::Bounds& bounds, const Shadows& shadows,
                  TextureFilter filter = TextureFilter::Trilinear, std::uint32_t lightSamples = 0,
                  Shading shading = Shading::Material);

    /** The levels that shading samples; run their passes once before (MipChains::needed, declareMips). */
    MipChains& mips() { return mips_; }
    /** Declares the passes that make the mip levels. */
    void declareMips(Graph& graph);

    /** The maps that shading looks up; draw them once before (ShadowMaps::needed, ShadowMaps::declare). */
    ShadowMaps& shadows() { return shadows_; }

    /** Declares rasterization of the scene and its shading. `view` as for RasterPipeline::declare. */
    ShadeOutput declare(Graph& graph, const RasterOutput& raster, std::shared_ptr<const RasterView> view);

    /** Shades the keys of several samples a pixel, each triangle once a pixel: `visibility` holds one image
     * of keys a sample, rasterStride() apart; `view` is that of the pixels' centres. 1 to 32 samples. */
    MultisampleOutput declareMultisample(Graph& graph, Buffer visibility, std::uint32_t samples,
                                         std::shared_ptr<const RasterView> view);

    /** The kernel that shades pixels, with its constants: what the scene's features leave of it. */
    std::pair<Kernel, SpecConstants> surfaceKernel(const RasterView& view);

    /** Whether some surfaces let through part of what is behind: only declareLayer shows it. */
    bool seesThrough() const;
    /** Whether light goes through some of their material (not its alpha). */
    bool transmits() const;
    /** Whether some such surface may deflect it: what is behind is then looked up in a picture. */
    bool refracts() const { return transmits() && (scene_.info().roughFacets || scene_.info().volumes); }
    /** Whether some such surface may be rough: levels of that picture are then read. */
    bool scattersThrough() const { return transmits() && scene_.info().roughFacets; }
    /** Shades the layer of a peeled visibility buffer that is seen through those before, and adds it to the
     * picture: see passes/shade/alpha_layers.hpp. */
    void declareLayer(Graph& graph, Buffer visibility, const LayerTarget& target,
                      std::shared_ptr<const RasterView> view);

    /** Whether some material has an alpha mask. */
    bool masks() const { return scene_.info().alphaMasks; }
    /** Whether some material is blended with what is behind it. */
    bool blends() const { return scene_.info().alphaBlends; }
    /** Looks up the masks of a layer of a peeled visibility buffer: see passes/shade/alpha_masks.hpp. The
     * image's keys begin at `firstKey`, read at every execution. */
    void declareMask(Graph& graph, Buffer visibility, const MaskTarget& target,
                     std::shared_ptr<const RasterView> view, std::shared_ptr<const std::uint32_t> firstKey);

    /** The scene's triangles for RasterPipeline::declare. */
    RasterTriangles triangles(Graph& graph);

    /** Points for which light is found apart from the pixels: corners or triangles; 0 where every pixel finds
     * its own. */
    std::uint64_t cornersShaded() const;

    /** What this shading leaves out of a scene, as WHAT and WHY for the statistics. */
    std::vector<std::pair<std::string, std::string>> skipped() const;

private:
    struct Common;
    Common declareCommon(Graph& graph, std::shared_ptr<const RasterView> view);
    bool inSceneOrder() const { return scene_.info().nodeCount == 0; }
    Buffer declareSlots(Graph& graph);
    std::int32_t filterConstant(TextureFilter filter) const;
    void declareCorners(Graph& graph, std::shared_ptr<const RasterView> view, Common& common);
    void bindScene(Graph& graph, Pass& pass, const Common& common);

    Device& device_;
    DeviceScene& scene_;
    TextureFilter filter_;
    Shading shading_;
    MipChains mips_;
    Shadows::Kind shadowKind_;
    ShadowMaps shadows_;
    std::uint32_t surfaceLights_, lightSamples_;  ///< 0 samples: lights are taken one by one
    DeviceBuffer lightSums_;
    DeviceBuffer environment_;
    bool hasSpecularEnvironment_;
    DeviceBuffer specularEnvironment_;
    std::uint64_t maxStorageBufferRange_;
};

}  // namespace helio
