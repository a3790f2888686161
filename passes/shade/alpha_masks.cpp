#include "passes/shade/alpha_masks.hpp"

#include <map>
#include <utility>

namespace helio {

AlphaMasks::AlphaMasks(Device& device, const RasterPipeline& raster, ShadePipeline& shade, DeviceBuffer& keys,
                       std::shared_ptr<const RasterView> view, TextureFilter filter)
    : limit_(device, "masks.limit", std::uint64_t(view->width) * view->height * 8) {
    {
        Graph graph(device);
        graph.fill("masks.openAll", graph.import(limit_), 0xffffffffu);
        begin_ = graph.compile({.executionsInFlight = 1});
    }
    Graph graph(device);
    const Buffer limit = graph.import(limit_), open = graph.buffer("masks.open", {4}),
                 visibility = graph.buffer("masks.visibility", {limit_.bytes()}),
                 counters = graph.buffer("masks.counters", {sizeof(RasterCounters)});
    graph.fill("masks.clear", visibility, 0);
    graph.fill("masks.clearCounters", counters, 0);
    graph.fill("masks.clearOpen", open, 0);
    raster.declare(graph, shade.triangles(graph), view, {visibility, 0, counters, limit});
    shade.declareMask(graph, visibility, {graph.import(keys), limit, open, filter}, view, firstKey_);
    open_ = graph.readback<std::uint32_t>(open);
    counters_ = graph.readback<RasterCounters>(counters);
    layer_ = graph.compile({.executionsInFlight = 1});
}

AlphaLayers::Drawing AlphaMasks::draw(std::uint64_t firstKey,
                                      const std::function<void(const std::vector<PassTiming>&)>& timings) {
    *firstKey_ = std::uint32_t(firstKey);
    return AlphaLayers::peel(begin_, layer_, open_, counters_, timings);
}

std::uint64_t drawShadowMaps(Device& device, ShadePipeline& shade) {
    ShadowMaps& shadows = shade.shadows();
    if (!shadows.needed()) return 0;
    const RasterPipeline casters(device, {.cullBackFaces = false});  // light meets back faces too
    if (!shade.masks()) {
        Graph graph(device);
        shadows.declare(graph, casters, shade.triangles(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
        return 0;
    }
    const ShadowLayout& layout = shadows.layout();
    std::uint64_t open = 0;
    struct Drawn {
        std::shared_ptr<RasterView> view;
        std::unique_ptr<AlphaMasks> masks;
    };
    std::map<std::pair<std::uint32_t, bool>, Drawn> plans;  // by size and projection
    for (std::size_t face = 0; face < layout.faces.size(); ++face) {
        const RasterView& view = layout.faces[face];
        Drawn& drawn = plans[{view.width, view.orthographic}];
        if (!drawn.masks) {
            drawn.view = std::make_shared<RasterView>(view);
            drawn.masks = std::make_unique<AlphaMasks>(device, casters, shade, shadows.maps(), drawn.view,
                                                       TextureFilter::Bilinear);
        }
        *drawn.view = view;
        open += drawn.masks->draw(layout.offsets[face] / 8).open;
    }
    return open;
}

}  // namespace helio
