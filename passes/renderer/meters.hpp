#pragma once
/** @file What the scene's meters read, by paths that start at them. */
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/renderer/film_target.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/render_job.hpp"

#include <optional>
#include <vector>

namespace helio {

class MeterReader {
public:
    /** Compiles for the view's meters and runs each once; nothing where there are none. */
    MeterReader(Device& device, PreparedScene& scene, const View& view, const PathTraceOptions& options);
    MeterReader(const MeterReader&) = delete;
    MeterReader& operator=(const MeterReader&) = delete;
    /** Takes the job's samples per pixel in each of 16 x 16 strata; false where the application cancels. */
    bool read(RenderJob& job);

private:
    const View& view_;
    std::optional<FilmTarget> film_;
    std::vector<PathTracer> tracers_;  ///< one a meter
};

}  // namespace helio
