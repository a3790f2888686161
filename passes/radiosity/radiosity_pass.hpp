#pragma once
/** @file
 * Radiosity: the rendering equation L = E + K L of a diffuse scene as a system over patches of constant
 * radiance (Goral et al., "Modeling the interaction of light between diffuse surfaces", 1984), both sides of
 * each.
 *
 *     RadiosityPass pass(device, scene, cutIntoPatches(packed, 1024));
 *     pass.solve([](double fraction) { return true; });   // then uPatchSlots, uPatchRadiance hold the light
 */
#include "passes/radiosity/patches.hpp"
#include "passes/scene/device_scene.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <functional>
#include <vector>

namespace helio {

class RadiosityPass {
public:
    /** Compiles the kernel and runs it once. The device and the scene must outlive the pass; the scene has a
     * tree (PackOptions), and `list` is of the same packing. Not movable: its plan refers to it. */
    RadiosityPass(Device& device, DeviceScene& scene, PatchList list);
    RadiosityPass(const RadiosityPass&) = delete;
    RadiosityPass& operator=(const RadiosityPass&) = delete;

    /** Form factors on the device, then both solutions. Calls `goOn` with the fraction done; false where that
     * asked to stop, and nothing is solved. Patches are black before. */
    bool solve(const std::function<bool(double)>& goOn, RenderResult::Radiosity& report);

    /** For kernels that include patch_radiance.glsl. */
    std::vector<Binding> bindings(Graph& graph);
    /** Device times of all dispatches so far. */
    const std::vector<PassTiming>& timings() const { return timings_; }

private:
    bool formFactors(const std::function<bool(double)>& goOn);
    bool solveChannel(int channel, const std::vector<std::size_t>& lit,
                      const std::function<bool(double)>& goOn, RenderResult::Radiosity& report);
    std::vector<std::size_t> litSides() const;
    void runRows(std::uint32_t first, std::uint32_t rows);
    void uploadRadiance();
    double skyShare(std::size_t side, std::size_t point) const;

    struct Parameters {
        std::uint32_t count, firstRow, rows;
    };
    Device& device_;
    PatchList list_;
    glm::dvec3 environment_;
    std::uint32_t rowsAtOnce_;
    DeviceBuffer places_, slots_, radianceBuffer_, factorBuffer_;
    Parameters parameters_{};
    Plan plan_;
    /** From each patch's points to each patch: 3 points x 2 sides of the receiver; negative where the other
     * is seen from behind. */
    std::vector<float> factors_;
    /** Light that leaves each side (patch * 2 + side), and that of its three points. */
    std::vector<glm::dvec3> radiance_;
    std::vector<glm::dvec3> pointRadiance_;
    std::vector<PassTiming> timings_;
};

}  // namespace helio
