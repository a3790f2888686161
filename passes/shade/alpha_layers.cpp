#include "passes/shade/alpha_layers.hpp"

#include <algorithm>

namespace helio {

AlphaLayers::AlphaLayers(Device& device, const RasterPipeline& raster, ShadePipeline& shade,
                         std::shared_ptr<const RasterView> view)
    : refraction_(shade.transmits() ? std::make_unique<RefractionPictures>(device, *view, shade.refracts(),
                                                                           shade.scattersThrough())
                                    : nullptr),
      color_(perPixel(device, "layers.color", *view, 16)),
      limit_(perPixel(device, "layers.limit", *view, 8)),
      albedoDepth_(perPixel(device, "layers.albedoDepth", *view, 16)),
      normal_(perPixel(device, "layers.normal", *view, 16)),
      ids_(perPixel(device, "layers.ids", *view, 8)) {
    {
        Graph graph(device);
        graph.fill("layers.clearColor", graph.import(color_), 0);
        graph.fill("layers.openAll", graph.import(limit_), 0xffffffffu);
        graph.fill("layers.clearAlbedo", graph.import(albedoDepth_), 0);
        graph.fill("layers.clearNormal", graph.import(normal_), 0);
        graph.fill("layers.clearIds", graph.import(ids_), 0xffffffffu);  // -1
        if (refraction_) refraction_->declareClear(graph);
        begin_ = graph.compile({.executionsInFlight = 1});
    }
    Graph graph(device);
    const Buffer limit = graph.import(limit_), open = graph.buffer("layers.open", {refraction_ ? 8u : 4u});
    const Buffer visibility = graph.buffer("layers.visibility", {limit_.bytes()}),
                 counters = graph.buffer("layers.counters", {sizeof(RasterCounters)});
    graph.fill("layers.clear", visibility, 0);
    graph.fill("layers.clearCounters", counters, 0);
    graph.fill("layers.clearOpen", open, 0);
    raster.declare(graph, shade.triangles(graph), view, {visibility, 0, counters, limit});
    LayerTarget target{.color = graph.import(color_),
                       .limit = limit,
                       .albedoDepth = graph.import(albedoDepth_),
                       .normal = graph.import(normal_),
                       .ids = graph.import(ids_),
                       .open = open,
                       .passed = {},
                       .behind = {},
                       .leftOut = {}};
    if (refraction_) refraction_->declareTarget(graph, target);
    shade.declareLayer(graph, visibility, target, view);
    open_ = graph.readback<std::uint32_t>(open);
    counters_ = graph.readback<RasterCounters>(counters);
    layer_ = graph.compile({.executionsInFlight = 1});
    if (refraction_) refraction_->makeKeep(device, color_, albedoDepth_);
}

AlphaLayers::Drawing AlphaLayers::draw(const std::function<void(const std::vector<PassTiming>&)>& timings) {
    if (!refraction_) return peel(begin_, layer_, open_, counters_, timings);
    Drawing all;
    all.pictures = 0;
    refraction_->draw(
        [&] {
            const Drawing picture = peel(begin_, layer_, open_, counters_, timings);
            all.layers += picture.layers;
            all.open = std::max(all.open, picture.open);
            all.counters.insert(all.counters.end(), picture.counters.begin(), picture.counters.end());
            ++all.pictures;
            return picture.refracting;
        },
        timings);
    return all;
}

AlphaLayers::Drawing AlphaLayers::peel(Plan& begin, Plan& layer, const Readback<std::uint32_t>& open,
                                       const Readback<RasterCounters>& counters,
                                       const std::function<void(const std::vector<PassTiming>&)>& timings) {
    Drawing drawing;
    const Execution begun = begin.execute();
    begin.wait(begun);
    if (timings) timings(begin.timings(begun));
    do {
        const Execution done = layer.execute();
        const std::vector<std::uint32_t> found = open.wait(done);
        drawing.open = found.at(0);
        if (found.size() > 1) drawing.refracting = std::max(drawing.refracting, found[1]);
        drawing.counters.push_back(counters.wait(done).at(0));
        if (timings) timings(layer.timings(done));
        ++drawing.layers;
    } while (drawing.open > 0 && drawing.layers < kMaxLayers);
    return drawing;
}

}  // namespace helio
