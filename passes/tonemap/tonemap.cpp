#include "passes/tonemap/tonemap.hpp"

#include <heliograph_kernels/tonemap.hpp>

#include <cassert>
#include <cmath>

namespace helio {

Buffer declareTonemap(Graph& graph, Buffer linear, std::uint32_t width, std::uint32_t height,
                      const TonemapOptions& options) {
    assert(width > 0 && height > 0);
    struct Push {
        float scale;
        std::uint32_t width, height;
    };
    const Push push{std::exp2(options.exposure), width, height};
    const Buffer encoded = graph.buffer("tonemap.encoded", {std::uint64_t(width) * height * 4});
    graph
        .compute("tonemap", shaders::tonemapEncode,
                 {.spec = {{"TONE_CURVE", std::uint32_t(options.curve)}}})
        .reads({{"uLinear", linear}})
        .overwrites({{"uEncoded", encoded}})
        .record([push](Commands& c) { c.push(push).dispatchOver(push.width, push.height); });
    return encoded;
}

}  // namespace helio
