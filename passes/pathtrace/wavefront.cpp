#include "passes/pathtrace/wavefront.hpp"

#include "passes/pathtrace/kernel_interface.hpp"

#include <heliograph_kernels/pathtrace.hpp>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string>
#include <utility>

namespace helio {
namespace {

constexpr std::uint32_t kShadowQueue = 2;
constexpr std::uint64_t kShadowBytes = 3 * 16;  ///< of a ray in uShadows

/** uLengths of wavefront.glsl with nothing in any queue. */
constexpr std::array<std::uint32_t, 12> kEmpty = {0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0};

}  // namespace

std::uint64_t Wavefront::mostPixels(const Device& device) {
    return std::min<std::uint64_t>(65535ull * 128,
                                   device.info().maxStorageBufferRange / (kShadowBytes * kMostLightSamples));
}

Wavefront::Wavefront(Device& device, std::array<std::uint32_t, 2> size, std::uint32_t lightSamples)
    : pixels_(std::uint64_t(size[0]) * size[1]),
      queues_(device, "wavefront.queues", pixels_ * 3 * 4),
      lengths_(device, "wavefront.lengths", sizeof kEmpty),
      hits_(device, "wavefront.hits", pixels_ * 8),
      shadows_(device, "wavefront.shadows", pixels_ * kShadowBytes * lightSamples) {
    assert(lightSamples <= kMostLightSamples);
    assert(pixels_ > 0 && pixels_ <= mostPixels(device));
}

Pass Wavefront::addPass(Graph& graph, const Interface& interface, std::string_view name,
                        const Kernel& kernel) {
    const Kernel variant = interface.variant(kernel);
    const KernelReflection& reflection = reflect(variant);
    Pass pass =
        graph.compute(std::string(name), variant, {.spec = constantsOf(reflection, interface.constants)});
    pass.reads(bindingsOf(reflection, interface.reads))
        .modifies(bindingsOf(reflection, interface.modifies))
        .modifies(bindingsOf(reflection, {{"uQueues", graph.import(queues_)},
                                          {"uLengths", graph.import(lengths_)},
                                          {"uHits", graph.import(hits_)},
                                          {"uShadows", graph.import(shadows_)}}));
    return pass;
}

void Wavefront::declare(Graph& graph, const Interface& interface) {
    const Buffer lengths = graph.import(lengths_);
    addPass(graph, interface, "begin", shaders::wavefront_begin).record([this](Commands& commands) {
        commands.push(parameters_).dispatchInvocations(mode_ == Mode::Fill ? pixels_ : 1);
    });
    // What a pass is dispatched by, no binding of it may write.
    const auto lengthsNow = [&](const char* name) {
        const Buffer copy = graph.buffer(name, {sizeof kEmpty});
        graph.copy(name, lengths, copy);
        return copy;
    };
    const Buffer paths = lengthsNow("paths");
    const auto overQueue = [&](std::string_view name, const Kernel& kernel, const Buffer& arguments,
                               bool shadows, bool fills) {
        addPass(graph, interface, name, kernel)
            .indirect(arguments)
            .record([this, arguments, shadows, fills](Commands& commands) {
                if (mode_ == Mode::Fill && !fills) return;
                commands.push(parameters_);
                if (mode_ == Mode::Compile)
                    commands.dispatch(1);
                else
                    commands.dispatchIndirect(arguments,
                                              16ull * (shadows ? kShadowQueue : parameters_.budget));
            });
    };
    overQueue("closest", shaders::wavefront_closest, paths, false, false);
    overQueue("shade", shaders::wavefront_shade, paths, false, false);
    overQueue("shadow", shaders::wavefront_shadow, lengthsNow("shadow rays"), true, false);
    overQueue("next", shaders::wavefront_next, paths, false, true);
    read_ = graph.readback<std::array<std::uint32_t, 12>>(lengths);
}

Wavefront::Progress Wavefront::run(Plan& plan, const TraceParameters& parameters, std::uint32_t rounds,
                                   const std::function<void(const Execution&)>& done) {
    lengths_.upload(kEmpty.data(), sizeof kEmpty);
    parameters_ = parameters;
    parameters_.budget = 0;
    if (parameters.sampleEnd == 0) {
        mode_ = Mode::Compile;
        plan.wait(plan.execute());
    }
    mode_ = Mode::Fill;
    parameters_.begin = parameters.begin != 0 ? 3 : 2;
    Execution execution = plan.execute();
    mode_ = Mode::Round;
    parameters_.begin = 0;
    for (std::uint32_t i = 0; i < rounds; ++i) {
        parameters_.budget = 1 - parameters_.budget;
        const Execution before = std::exchange(execution, plan.execute());
        done(before);
    }
    done(execution);
    return {execution, read_.wait(execution).at(0)[(1 - parameters_.budget) * 4 + 3]};
}

}  // namespace helio
