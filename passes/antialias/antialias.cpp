#include "passes/antialias/antialias.hpp"

#include <glm/glm.hpp>
#include <heliograph_kernels/antialias.hpp>

#include <algorithm>
#include <utility>

namespace helio {

RasterView shiftedView(const RasterView& view, const std::array<float, 2>& position) {
    RasterView shifted = view;
    const double x = 0.5 - double(position[0]), y = 0.5 - double(position[1]);
    if (view.orthographic) {
        shifted.eye -= view.rowX * (x / glm::dot(view.rowX, view.rowX));
        shifted.eye -= view.rowY * (y / glm::dot(view.rowY, view.rowY));
    } else {
        shifted.rowX += x * view.rowW;
        shifted.rowY += y * view.rowW;
    }
    return shifted;
}

void declareAdd(Graph& graph, Buffer color, Buffer sum, std::uint32_t pixels,
                std::shared_ptr<const AddWeight> weight) {
    struct Push {
        std::uint32_t first, pixels;
        float weight;
        std::uint32_t begins;
    };
    graph.compute("antialias.add", shaders::antialiasAdd)
        .reads({{"uColor", color, Format::RGBA32F}})
        .modifies({{"uSum", sum}})
        .record([pixels, weight = std::move(weight)](Commands& c) {
            // A dispatch has at most 65,535 workgroups of 64.
            constexpr std::uint32_t most = 1u << 21;
            for (std::uint32_t first = 0; first < pixels; first += most)
                c.push(Push{first, pixels, weight->weight, weight->begins ? 1u : 0u})
                    .dispatchInvocations(std::min(most, pixels - first));
        });
}

Buffer declareFxaa(Graph& graph, Buffer color, std::array<std::uint32_t, 2> size) {
    const Buffer filtered = graph.buffer("antialias.filtered", {std::uint64_t(size[0]) * size[1] * 16});
    graph.compute("antialias.fxaa", shaders::antialiasFxaa)
        .reads({{"uColor", color, Format::RGBA32F}})
        .overwrites({{"uFiltered", filtered}})
        .record([size](Commands& c) { c.push(size).dispatchOver(size[0], size[1]); });
    return filtered;
}

}  // namespace helio
