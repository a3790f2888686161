#include "passes/renderer/checkpointing.hpp"

#include <heliograph/error.hpp>
#include <heliograph/version.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/film.hpp>

#include <algorithm>

namespace helio {

std::vector<std::pair<std::string, std::string>> checkpointSettings(const RenderOptions& options,
                                                                    const SceneIdentity& scene,
                                                                    const View& view,
                                                                    const DeviceInfo& device) {
    std::string camera = fmt::format("{} {} {} {}", view.camera.perspective, view.camera.yfov,
                                     view.camera.ymag, view.camera.znear);
    const ThinLens lens = view.camera.lens.value_or(ThinLens{});
    camera += fmt::format(" {} {} {} {} {} {}", int(view.camera.projection), view.camera.fieldOfView,
                          lens.apertureDiameter, lens.focusDistance, lens.blades, lens.bladeRotation);
    if (view.camera.lensTable) {
        const LensTable& table = *view.camera.lensTable;
        camera += fmt::format(" {} {} {} {}", table.scale, table.filmHeight, table.focusDistance, table.stop);
        for (const LensSurface& s : table.surfaces)
            camera += fmt::format(" {} {} {} {}", s.radius, s.thickness, s.ior, s.diameter);
    }
    camera += fmt::format(" {} {}", view.shutter.rolling, view.shutter.open);
    std::vector<glm::dmat4> places = view.poses;
    places.push_back(view.transform);
    for (const glm::dmat4& place : places)
        for (glm::length_t c = 0; c < 4; ++c)
            for (glm::length_t r = 0; r < 3; ++r) camera += fmt::format(" {}", place[c][r]);
    return {{"version", std::string(version())},
            {"device", device.name},
            {"scene", fmt::format("{:016x}{:016x}", scene.words[0], scene.words[1])},
            {"camera", camera},
            {"size", fmt::format("{}x{}", options.size[0], options.size[1])},
            {"number of samples", std::to_string(options.samples)},
            {"error limit", fmt::format("{}", options.maxError)},
            {"time limit", fmt::format("{}", options.maxSeconds)},
            {"depth limit", std::to_string(options.maxDepth)},
            {"pixel filter", std::to_string(int(options.filter))},
            {"integrator", std::to_string(int(options.integrator))},
            {"roulette", fmt::format("{} {}", options.roulette, options.survival)},
            {"normal mapping", std::to_string(int(options.normalMapping))},
            {"patches",
             options.integrator == Integrator::Radiosity ? std::to_string(options.radiosityPatches) : "none"},
            {"sampler", std::to_string(int(options.sampler))},
            {"adaptive sampling", options.adaptive ? "on" : "off"},
            {"accelerator", std::to_string(int(options.accelerator))},
            {"choice of lights", std::to_string(int(options.lights))},
            {"guiding", std::to_string(int(options.guiding))},
            {"next-event estimation", options.nextEventEstimation ? "on" : "off"},
            {"seed", std::to_string(options.seed)}};
}

Checkpointing::Checkpointing(Device& device, PathTracer& tracer, Film& film, const SceneIdentity& scene,
                             const View& view, RenderJob& job)
    : device_(device), tracer_(tracer), film_(film), job_(job) {
    if (job.options.checkpoint.empty()) return;
    settings_ = checkpointSettings(job.options, scene, view, device.info());
    Graph graph(device);
    readFilm_ = graph.readback<float>(film.import(graph));
    readState_ = graph.readback<float>(tracer_.importState(graph));
    reading_ = graph.compile({.executionsInFlight = 1});
}

std::optional<Checkpoint> Checkpointing::resume() {
    if (!job_.options.resume) return std::nullopt;
    if (!std::filesystem::exists(job_.options.checkpoint)) {
        job_.result.warnings.push_back(
            fmt::format("{} is not there: the render begins anew", job_.options.checkpoint.string()));
        return std::nullopt;
    }
    Checkpoint checkpoint = loadCheckpoint(job_.options.checkpoint, settings_);
    restore(checkpoint);
    shares_ = checkpoint.shares;
    checkpoint.film = {};
    checkpoint.state = {};
    job_.goOnAfter(checkpoint.seconds, checkpoint.cpuSeconds);
    saved_ = job_.seconds();
    return checkpoint;
}

void Checkpointing::restore(const Checkpoint& checkpoint) {
    const std::uint64_t pixels = std::uint64_t(film_.width()) * film_.height();
    if (checkpoint.film.size() != pixels * 24 || checkpoint.state.size() != pixels * tracer_.stateFloats() ||
        (!checkpoint.shares.empty() && checkpoint.shares.size() != pixels))
        throw InputError(job_.options.checkpoint.string(), "", "is damaged", "render again without --resume");
    DeviceBuffer film = makeBuffer(device_, "checkpoint.film", checkpoint.film);
    DeviceBuffer state = makeBuffer(device_, "checkpoint.state", checkpoint.state);
    Graph graph(device_);
    const auto bring = [&](const char* name, DeviceBuffer& from, Image to) {
        graph.compute(name, shaders::imageRestore)
            .reads({{"uSaved", graph.import(from), Format::RGBA32F}})
            .overwrites({{"uImage", to}})
            .record([to](Commands& c) { c.dispatchOver(to); });
    };
    bring("checkpoint.film", film, film_.import(graph));
    bring("checkpoint.state", state, tracer_.importState(graph));
    Plan plan = graph.compile();
    plan.wait(plan.execute());
    const auto& c = checkpoint.counters;
    tracer_.setCounters({c[0], c[1], c[2], c[3], c[4]});
}

void Checkpointing::saveWhenDue(std::uint32_t reached, std::uint32_t end) {
    if (job_.options.checkpoint.empty()) return;
    // Saving takes a twentieth of the time at most.
    const double pause = std::max(job_.options.checkpointSeconds, 20 * took_);
    if (job_.seconds() >= saved_ + pause) save(reached, end);
}

void Checkpointing::save(std::uint32_t reached, std::uint32_t end) {
    if (job_.options.checkpoint.empty()) return;
    const Stopwatch watch;
    const PathCounters c = tracer_.counters();
    Checkpoint checkpoint;
    checkpoint.settings = settings_;
    checkpoint.shares = shares_;
    checkpoint.reached = reached;
    checkpoint.end = end;
    checkpoint.seconds = job_.seconds();
    checkpoint.cpuSeconds = job_.cpuSeconds();
    checkpoint.counters = {c.cameraRays, c.bounceRays, c.shadowRays, c.truncatedPaths, c.abandonedRays};
    const Execution execution = reading_.execute();
    checkpoint.film = readFilm_.wait(execution);
    checkpoint.state = readState_.wait(execution);
    saveCheckpoint(job_.options.checkpoint, checkpoint);
    took_ = watch.seconds();
    saved_ = job_.seconds();
}

}  // namespace helio
