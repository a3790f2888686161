#pragma once
/** @file
 * Shadow maps of a scene's punctual lights: one map for a directional light (orthographic, over the scene's
 * bounds) and a spot, six for a point light or a spot wider than a map can show. A map is what the rasterizer
 * leaves: depth and id of the nearest triangle. Receivers compare the depth of their own plane at the texel's
 * centre, so that a plane never shadows itself whatever its tilt; no bias has to be chosen.
 */
#include "passes/raster/raster_pipeline.hpp"
#include "passes/scene/packed_scene.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace helio {

/** The faces that lights' maps have, without a device. */
struct ShadowLayout {
    /** `lights` are the rows of PackedScene::lights. */
    ShadowLayout(std::span<const glm::vec4> lights, std::uint32_t lightCount, const Scene::Bounds& bounds,
                 const Shadows& options);

    std::vector<RasterView> faces;
    std::vector<std::uint64_t> offsets;  ///< bytes of each face's keys, and of all at the end
    std::vector<glm::uvec4> table;       ///< as shaders/raster/shadow.glsl reads it
    std::uint32_t lightsWithout = 0;     ///< punctual lights for which there was no room
};

/** The maps on the device. Must outlive the plans it is declared in. */
class ShadowMaps {
public:
    ShadowMaps(Device& device, std::span<const glm::vec4> lights, std::uint32_t lightCount,
               const Scene::Bounds& bounds, const Shadows& options);

    /** Declares the passes that draw all maps. They stay in memory: run once for a scene. */
    void declare(Graph& graph, const RasterPipeline& raster, const RasterTriangles& triangles);
    /** Read bindings for a pass that shades. */
    std::vector<Binding> bindings(Graph& graph);
    bool needed() const { return !layout_.faces.empty(); }
    const ShadowLayout& layout() const { return layout_; }
    /** The keys, ShadowLayout::offsets apart. */
    DeviceBuffer& maps() { return maps_; }

private:
    ShadowLayout layout_;
    DeviceBuffer table_, filter_, maps_;
};

}  // namespace helio
