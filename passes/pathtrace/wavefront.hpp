#pragma once
/** @file The wavefront scheduler: paths wait in queues and kernels take them one scattering further, see
 * wavefront.glsl. */
#include "passes/pathtrace/parameters.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/kernel.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace helio {

/** Directions to lights that paths ask at most where the camera's ray arrives (LIGHTS_ASKED). */
inline constexpr std::uint32_t kMostLightSamples = 4;

/** Rounds of kernels over a picture's pixels. State between calls is trace.comp's: either can go on with it.
 */
class Wavefront {
public:
    /** What its kernels share with trace.comp. Those that a kernel does not have are left out. */
    struct Interface {
        std::function<Kernel(const Kernel&)> variant;  ///< of a kernel, for the scene
        SpecConstants constants;
        std::vector<Binding> reads, modifies;  ///< of the graph that the constructor is given
    };

    /** Pixels of a picture at most: 65,535 workgroups of 128, and what a storage buffer of shadow rays holds.
     */
    static std::uint64_t mostPixels(const Device& device);

    /** `lightSamples`: LIGHTS_ASKED of its kernels, at most kMostLightSamples. */
    Wavefront(Device& device, std::array<std::uint32_t, 2> size, std::uint32_t lightSamples);

    /** Declares the passes of a round. */
    void declare(Graph& graph, const Interface& interface);
    struct Progress {
        Execution execution;     ///< the last
        std::uint32_t left = 0;  ///< pixels that are not done
    };
    /** After the graph was compiled to `plan`: takes all pixels through `rounds` rounds, each a scattering.
     * `parameters.begin`: nothing was begun yet. `parameters.sampleEnd` 0 runs every kernel once, on nothing,
     * for the driver to compile. `done` is called with each execution. */
    Progress run(Plan& plan, const TraceParameters& parameters, std::uint32_t rounds,
                 const std::function<void(const Execution&)>& done);

private:
    Pass addPass(Graph& graph, const Interface& interface, std::string_view name, const Kernel& kernel);

    std::uint64_t pixels_;
    DeviceBuffer queues_, lengths_, hits_, shadows_;
    Readback<std::array<std::uint32_t, 12>> read_;
    TraceParameters parameters_{};
    enum class Mode { Compile, Fill, Round };
    Mode mode_ = Mode::Round;  ///< of the next execution; Fill: the queue, by all pixels with samples to go
};

}  // namespace helio
