#pragma once
/** @file A path tracer whose runs are timed. */
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/scene/device_scene.hpp"
#include "tests/bench/timing.hpp"

#include <vector>

namespace helio::test {

/** A tracer that goes on from run to run. */
class Contender {
public:
    Contender(Device& device, DeviceScene& packed, const Scene& scene, const PlacedCamera& placed,
              const PathTraceOptions& options)
        : device_(device),
          film_(device, options.size[0], options.size[1]),
          tracer_((clear(), device), packed, scene.cameras[std::size_t(placed.camera)], placed.transform,
                  options, film_) {}
    /** CPU seconds of the next samples. */
    double run(std::uint32_t samples) {
        end_ += samples;
        const double start = bench::cpuSeconds();
        while (!tracer_.advance(end_)) {
        }
        return bench::cpuSeconds() - start;
    }
    /** What is traced with. */
    auto kernel() const { return tracer_.traceKernel(); }
    std::vector<glm::vec4> picture() {
        Graph graph(device_);
        const ResolvedFilm resolved = declareFilmResolve(graph, film_, film_.import(graph));
        const auto mean = graph.readback<glm::vec4>(resolved.mean);
        Plan plan = graph.compile();
        return mean.wait(plan.execute());
    }

private:
    void clear() {
        Graph graph(device_);
        declareFilmClear(graph, film_, film_.import(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    Device& device_;
    Film film_;
    PathTracer tracer_;
    std::uint32_t end_ = 0;
};

}  // namespace helio::test
