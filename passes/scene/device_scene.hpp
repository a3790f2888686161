#pragma once
/** @file The scene on the device: what packScene made, uploaded, and bound to kernels by name. */
#include "passes/scene/packed_scene.hpp"

#include <heliograph/device.hpp>
#include <heliograph/features.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/scene.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace helio {

/** Uploaded scene. Move-only; must outlive the plans its buffers are imported into. Bindings by the names of
 * shaders/scene: uTriangles, uNodes, uNormals, uTexcoords, uColors, uMaterials, uLights, uTextures, uTexels8,
 * uTexelsFloat, uInstanceFirst. A buffer the scene does not need holds one zero texel. Only where the
 * environment is an image is there a uEnvironmentMap, for kernels compiled with ENVIRONMENT_IMAGE. */
class DeviceScene {
public:
    DeviceScene(Device& device, const Scene& scene, const PackOptions& options = {})
        : DeviceScene(device, scene, {}, options) {}
    /** A scene that moves, see packScene(): uTriangleKeys and uNormalKeys are there, for kernels compiled
     * with MOTION_KEYS. */
    DeviceScene(Device& device, const Scene& scene, std::span<const Scene> later, const PackOptions& options);

    /** Imports the named buffers into a graph and returns read bindings for them, to hand to Pass::reads. */
    std::vector<Binding> bindings(Graph& graph, const std::vector<std::string_view>& names);

    /** The named specialization constants of shaders/scene/features.glsl, with this scene's values. */
    SpecConstants constants(const std::vector<std::string_view>& names) const;

    bool hasEnvironmentImage() const { return info_.environmentSize[0] > 0; }
    /** The ENVIRONMENT_... constants of shaders/scene/environment.glsl; none where it is constant. */
    SpecConstants environmentConstants() const;

    /** Whether lights are chosen by tables: uLightSlots, uLightCells, uLightRanges and uLightOfTriangle are
     * there, for kernels compiled with LIGHT_TABLES and these constants. */
    bool hasLightTables() const { return hasLightTables_; }
    SpecConstants lightTableConstants() const;

    /** Whether there are placed meshes: uPlaced is there, for kernels compiled with INSTANCES and
     * PLACED_BITS. */
    bool hasPlacedMeshes() const { return hasPlacedMeshes_; }

    /** What was packed, without the arrays (they are on the device) but for `textures`. */
    const PackedScene& info() const { return info_; }
    /** Bytes on the device. */
    std::uint64_t deviceBytes() const;
    /** Bytes of the arrays on the host while they were packed. */
    std::uint64_t hostBytes() const { return hostBytes_; }

private:
    struct Named {
        std::string_view name;
        Format view;
        DeviceBuffer buffer;
    };
    PackedScene info_;
    std::uint64_t hostBytes_ = 0;
    bool hasLightTables_ = false, hasPlacedMeshes_ = false;
    std::vector<Named> buffers_;
    SpecConstants constants_;
};

}  // namespace helio
