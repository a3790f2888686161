#pragma once
/** @file Saves a path-traced render now and then, and goes on from what was saved. */
#include "engine/film/checkpoint.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/render_job.hpp"

#include <heliograph/graph.hpp>

#include <optional>

namespace helio {

/** What decides a path-traced picture's bits. */
std::vector<std::pair<std::string, std::string>> checkpointSettings(const RenderOptions& options,
                                                                    const SceneIdentity& scene,
                                                                    const View& view,
                                                                    const DeviceInfo& device);

/** The checkpoints of one render; does nothing where the options ask for none. */
class Checkpointing {
public:
    /** The tracer and film must have run before: what is brought back is not cleared by a first run. */
    Checkpointing(Device& device, PathTracer& tracer, Film& film, const SceneIdentity& scene,
                  const View& view, RenderJob& job);

    /** Brings back the film, the paths and the counters where the options ask to resume and the file is
     * there, and tells where the render stood. Throws InputError for a file of another render. */
    std::optional<Checkpoint> resume();
    /** Saves if the last save is long enough ago. `reached`: samples in the film; `end`: of the batch under
     * way. */
    void saveWhenDue(std::uint32_t reached, std::uint32_t end);
    /** What adaptive sampling's pilot has found, to be saved too. */
    void setShares(const std::vector<float>& shares) { shares_ = shares; }
    /** Saves. */
    void save(std::uint32_t reached, std::uint32_t end);

private:
    void restore(const Checkpoint& checkpoint);

    Device& device_;
    PathTracer& tracer_;
    Film& film_;
    RenderJob& job_;
    std::vector<std::pair<std::string, std::string>> settings_;
    Plan reading_;
    Readback<float> readFilm_, readState_;
    std::vector<float> shares_;
    double saved_ = 0, took_ = 0;  ///< seconds of rendering at the last save, and of that save
};

}  // namespace helio
