#include "tests/accuracy/path_render.hpp"

#include "passes/film/film.hpp"
#include "passes/pathtrace/caustic_guide.hpp"
#include "passes/scene/device_scene.hpp"
#include "tests/support/device.hpp"

#include <cmath>
#include <optional>

namespace helio::test {

PathTraceOptions independentOptions(std::uint32_t size, std::uint32_t maxDepth) {
    PathTraceOptions o;
    o.size = {size, size};
    o.sampler = SamplerKind::Independent;
    o.maxDepth = maxDepth;
    return o;
}

Traced trace(Scene scene, const PathTraceOptions& options, std::uint32_t samples, std::uint32_t step,
             const std::string& camera) {
    Traced result;
    result.width = options.size[0];
    result.height = options.size[1];
    const PlacedCamera placed = chooseCamera(scene, camera, double(result.width) / result.height);
    DeviceScene uploaded(device(), scene, PathTracer::packOptions(scene, options));
    Film film(device(), result.width, result.height);
    {
        Graph graph(device());
        declareFilmClear(graph, film, film.import(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    std::optional<CausticGuide> guide;
    PathTraceOptions guided = options;
    if (options.photonTargets && CausticGuide::possible(uploaded, options)) {
        guide.emplace(device(), uploaded, options);
        guide->trace();
        result.guideTables = guide->found().tables;
        if (!guide->found().empty()) guided.guide = &*guide;
    }
    PathTracer tracer(device(), uploaded, scene.cameras[std::size_t(placed.camera)], placed.transform, guided,
                      film);
    for (std::uint32_t end = std::min(step, samples);; end = std::min(end + step, samples)) {
        while (!tracer.advance(end)) {
        }
        if (end == samples) break;
    }
    result.counters = tracer.counters();
    result.hits = tracer.firstHits();
    Graph graph(device());
    const ResolvedFilm resolved = declareFilmResolve(graph, film, film.import(graph));
    const auto mean = graph.readback<glm::vec4>(resolved.mean);
    const auto variance = graph.readback<glm::vec4>(resolved.variance);
    Plan plan = graph.compile();
    const Execution execution = plan.execute();
    for (const glm::vec4& texel : mean.wait(execution)) result.mean.emplace_back(texel);
    for (const glm::vec4& texel : variance.wait(execution)) {
        result.variance.emplace_back(texel);
        result.rejected += std::uint64_t(texel.w);
    }
    return result;
}

Estimate estimate(const Traced& image, int channel, const std::function<bool(std::size_t)>& wanted) {
    Estimate e;
    double variance = 0;
    for (std::size_t i = 0; i < image.mean.size(); ++i) {
        if (!wanted(i)) continue;
        e.mean += image.mean[i][channel];
        variance += image.variance[i][channel];
        ++e.pixels;
    }
    e.mean /= double(e.pixels);
    e.error = std::sqrt(variance) / double(e.pixels);
    return e;
}

}  // namespace helio::test
