#include "passes/renderer/path_render.hpp"

#include "engine/film/sample_allocation.hpp"
#include "engine/film/variance.hpp"
#include "passes/denoise/denoise.hpp"
#include "passes/pathtrace/bounce_layers.hpp"
#include "passes/pathtrace/caustic_guide.hpp"
#include "passes/pathtrace/wavefront.hpp"
#include "passes/radiosity/radiosity_pass.hpp"
#include "passes/renderer/checkpointing.hpp"
#include "passes/renderer/frame.hpp"
#include "passes/renderer/meters.hpp"
#include "passes/renderer/sample_schedule.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

namespace helio {
namespace {

/** The loop over batches, and what is told about it. */
class PathLoop {
public:
    PathLoop(PathTracer& tracer, FilmTarget& target, Checkpointing& checkpoints, RenderJob& job,
             bool cpuDevice)
        : tracer_(tracer),
          target_(target),
          checkpoints_(checkpoints),
          job_(job),
          cpuDevice_(cpuDevice),
          schedule_(job.options),
          budget_(job.options),
          pilot_(pilotSamples(job.options.samples)) {}

    /** Samples per pixel that the film holds at the end. */
    std::uint32_t run() {
        std::uint32_t reached = 0, underWay = 0;
        if (const auto checkpoint = checkpoints_.resume()) {
            reached = checkpoint->reached;
            underWay = checkpoint->end;
            // What comes next goes by the error at the last end.
            if (reached >= underWay && reached > 0 && judged(reached)) return reached;
            if (!checkpoint->shares.empty()) allocation_.emplace(checkpoint->shares, pilot_);
            if (reached >= underWay) allocate(reached);
        }
        for (;;) {
            std::uint32_t end = underWay > reached ? underWay : nextEnd(reached);
            if (end != reached && !trace(end, reached)) {
                checkpoints_.save(reached, end);
                return reached;
            }
            if (end != reached) {
                reached = end;
                allocate(reached);
                if (!judged(reached)) continue;
            }
            checkpoints_.save(reached, reached);
            return reached;
        }
    }

private:
    std::uint32_t nextEnd(std::uint32_t reached) const {
        const std::uint32_t end = schedule_.next(reached, job_.seconds());
        return job_.options.adaptive && reached < pilot_ ? std::min(end, pilot_) : end;
    }

    /** Once the pilot is done, chooses where the other samples go. */
    void allocate(std::uint32_t reached) {
        if (!job_.options.adaptive || allocation_ || reached < pilot_ || reached >= job_.options.samples)
            return;
        allocation_.emplace(target_.resolve(), pilot_);
        checkpoints_.setShares(allocation_->shares());
    }

    bool timeIsOver() const {
        return job_.options.maxSeconds > 0 && job_.seconds() >= job_.options.maxSeconds;
    }

    /** Traces to the end of a batch; false where the application cancels or the time is over before. */
    bool trace(std::uint32_t end, std::uint32_t reached) {
        if (job_.options.adaptive) {
            const std::size_t pixels = std::size_t(job_.options.size[0]) * job_.options.size[1];
            tracer_.setSampleEnds(allocation_ ? allocation_->samples(end)
                                              : std::vector<std::uint32_t>(pixels, end));
        }
        for (bool done = false; !done;) {
            tracer_.setTurnBudget(budget_.turns());
            const Stopwatch watch;
            done = tracer_.advance(end);
            budget_.took(ownSeconds(watch));
            if (!job_.notify(progress(done ? end : reached)) && !done) return false;
            if (!done && timeIsOver()) return false;
            checkpoints_.saveWhenDue(done ? end : reached, end);
        }
        return true;
    }

    /** Wall time; on a CPU device no more than its own share of a machine that has other work too, which
     * would only make dispatches short and dear. */
    double ownSeconds(const Stopwatch& watch) const {
        const double wall = watch.seconds();
        if (!cpuDevice_) return wall;
        const double cores = std::max(1u, std::thread::hardware_concurrency());
        return std::min(wall, 1.25 * watch.cpuSeconds() / cores);
    }

    /** Whether nothing more is to be done; estimates the error where somebody wants to know it. */
    bool judged(std::uint32_t reached) {
        if (job_.result.cancelled || reached >= job_.options.samples) return true;
        if (reached < 8) return false;
        const bool decides = job_.options.maxError > 0;
        // For the display alone, an estimate may take a fiftieth of the time.
        if (!decides && (!job_.options.progress || job_.seconds() < 50 * estimateSeconds_)) return false;
        const Stopwatch watch;
        const ErrorEstimate error = estimateError(target_.resolve());
        estimateSeconds_ = watch.seconds();
        relmse_ = error.relmse;
        if (!decides) return false;
        schedule_.judged(reached, error);
        // A tail that few samples have not met yet looks like no error at all.
        return error.high < job_.options.maxError && (error.reliable || reached >= 64);
    }

    Progress progress(std::uint32_t reached) const {
        const PathCounters counters = tracer_.counters();
        const double paths =
            double(job_.options.samples) * job_.options.size[0] * double(job_.options.size[1]);
        Progress progress;
        progress.stage = "render";
        progress.samples = reached;
        progress.fraction = std::min(1.0, double(counters.cameraRays) / paths);
        progress.seconds = job_.seconds();
        if (progress.seconds > 0) {
            progress.raysPerSecond =
                double(counters.cameraRays + counters.bounceRays + counters.shadowRays) / progress.seconds;
        }
        progress.relmse = relmse_;
        if (progress.fraction > 0) {
            progress.secondsLeft = progress.seconds * (1 - progress.fraction) / progress.fraction;
            if (job_.options.maxSeconds > 0) {
                const double limit = std::max(0.0, job_.options.maxSeconds - progress.seconds);
                progress.secondsLeft = std::min(progress.secondsLeft, limit);
            }
        }
        return progress;
    }

    PathTracer& tracer_;
    FilmTarget& target_;
    Checkpointing& checkpoints_;
    RenderJob& job_;
    bool cpuDevice_;
    SampleSchedule schedule_;
    TurnBudget budget_;
    std::uint32_t pilot_;
    std::optional<SampleAllocation> allocation_;  ///< of adaptive sampling, after the pilot
    double relmse_ = -1, estimateSeconds_ = 0;
};

void addFirstHits(Frame& frame, const FirstHits& hits) {
    frame.add({"albedo.R", "albedo.G", "albedo.B"}, &hits.albedo.data()->x, 3);
    frame.add({"normal.X", "normal.Y", "normal.Z"}, &hits.normal.data()->x, 3);
    frame.add({"depth.Z"}, hits.depth.data(), 1);
    const std::vector<float> instance(hits.instance.begin(), hits.instance.end());
    const std::vector<float> triangle(hits.triangle.begin(), hits.triangle.end());
    frame.add({"id.instance"}, instance.data(), 1);
    frame.add({"id.triangle"}, triangle.data(), 1);
}

void addBounces(Frame& frame, const std::vector<std::vector<float>>& layers) {
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const std::string name = k + 1 < layers.size() ? fmt::format("bounce.{}", k) : "bounce.rest";
        frame.add({name + ".R", name + ".G", name + ".B"}, layers[k].data(), 3);
    }
}

void noteCounters(const PathCounters& counters, RenderResult& result) {
    result.rays = {counters.cameraRays, counters.bounceRays, counters.shadowRays};
    result.truncatedPaths = counters.truncatedPaths;
    if (counters.truncatedPaths > 0) {
        result.warnings.push_back(
            fmt::format("{} paths were cut after {} scatterings: the picture is darker than it should be",
                        counters.truncatedPaths, kUnlimitedDepth));
    }
    if (counters.abandonedRays > 0) {
        result.warnings.push_back(fmt::format(
            "{} rays were given up in the tree: thousands of triangles coincide", counters.abandonedRays));
    }
}

void addDenoised(Device& device, const FilmImages& film, const FirstHits& hits, RenderJob& job) {
    DenoiseGuides guides;
    for (std::size_t i = 0; i < hits.depth.size(); ++i) {
        guides.geometry.emplace_back(hits.normal[i], hits.depth[i]);
        guides.albedo.emplace_back(hits.albedo[i], hits.instance[i] >= 0 ? 1.0f : 0.0f);
    }
    const Denoised denoised = denoise(device, film, guides, job.result.error);
    Frame frame(film.width, film.height);
    frame.add({"R", "G", "B"}, &denoised.picture.data()->x, 4);
    frame.add({"strength"}, &denoised.picture.data()->x, 4, 3);
    job.result.denoised = {frame.image(), denoised.error, denoised.undenoised, denoised.strength};
    job.addTimings(denoised.timings);
}

/** Solves for the light of the patches; false where the application cancels. */
bool solveRadiosity(RadiosityPass& pass, RenderJob& job) {
    RenderResult& result = job.result;
    const auto goOn = [&](double fraction) {
        return job.notify({.stage = "radiosity", .fraction = fraction});
    };
    if (!pass.solve(goOn, result.radiosity.emplace())) return false;
    job.addTimings(pass.timings());
    result.skipped.emplace_back(
        "the error of patches",
        "the error told is that of antialiasing; other --patches show how far light changes");
    if (!result.radiosity->converged)
        result.warnings.emplace_back("the light between patches did not come to rest: it is too dark");
    return true;
}

/** What Guiding::Auto asks for: a picture whose paths take longer than the compilation of one more kernel,
 * and caustics that bring noise worth the price of tables (causticVariance; docs/benchmarks.md). */
constexpr double kLeastGuidedPaths = 1 << 20, kLeastCausticVariance = 0.5;

/** Tables that guide paths to caustics, where they are asked for or pay. */
std::optional<CausticGuide> guideCaustics(Device& device, DeviceScene& scene, const PathTraceOptions& options,
                                          RenderJob& job) {
    const bool decides = job.options.guiding == Guiding::Auto;
    const double paths = double(options.size[0]) * options.size[1] * options.samples;
    const bool possible = options.photonTargets && CausticGuide::possible(scene, options);
    if (!possible && job.options.guiding == Guiding::On) {
        job.result.skipped.emplace_back(
            "guiding",
            "nothing throws light of lamps on rough surfaces, or the paths asked for cannot be guided");
    }
    if (!possible || (decides && paths < kLeastGuidedPaths)) return std::nullopt;
    std::optional<CausticGuide> guide;
    guide.emplace(device, scene, options);
    const Stopwatch watch;
    guide->trace();
    RenderResult::Caustics& caustics = job.result.caustics.emplace();
    caustics.photons = guide->photons();
    caustics.kept = guide->found().kept;
    caustics.cells = guide->found().cellCount();
    caustics.tables = guide->found().tables;
    caustics.bytes = guide->bytes();
    caustics.seconds = watch.seconds();
    caustics.cpuSeconds = watch.cpuSeconds();
    job.charge(caustics.seconds, caustics.cpuSeconds);
    job.addTimings(guide->timings());
    caustics.gain = guide->found().gain;
    caustics.guided = !guide->found().empty() && (!decides || caustics.gain >= kLeastCausticVariance);
    if (!caustics.guided) guide.reset();
    return guide;
}

/** What limits of time and error did not bring. */
void warnOfLimits(const FilmImages& film, RenderJob& job) {
    RenderResult& result = job.result;
    if (job.options.maxError > 0 && !result.cancelled) {
        if (result.error.high >= job.options.maxError)
            result.warnings.push_back(
                fmt::format("the error limit of {} was not reached", job.options.maxError));
        else if (!result.error.reliable)
            result.warnings.emplace_back("the error limit was met by an estimate that is not reliable");
    }
    std::size_t empty = 0;
    for (std::size_t i = 3; i < film.mean.size(); i += 4) empty += film.mean[i] == 0 && film.variance[i] == 0;
    if (empty > 0 && !result.cancelled)
        result.warnings.push_back(fmt::format("the time was over when {} pixels had no sample yet", empty));
}

/** Device times without those of set-up, which hold the driver's compilation. */
std::vector<PassTiming> timingsSince(const std::vector<PassTiming>& before, std::vector<PassTiming> now) {
    for (const PassTiming& timing : before) {
        const auto found = std::ranges::find(now, timing.name, &PassTiming::name);
        if (found != now.end()) found->milliseconds -= timing.milliseconds;
    }
    return now;
}

}  // namespace

void checkPathSize(const RenderOptions& options, const Device& device) {
    const std::array<std::uint32_t, 2>& size = options.size;
    // The path tracer keeps 4 x 2 texels of state per pixel, the film 2 x 3, in images of at most 16384
    // texels.
    if (size[0] > 4096 || size[1] > kMaxFilmHeight)
        throw InputError("", "size",
                         fmt::format("{}x{} pixels are too many for the path pipeline", size[0], size[1]),
                         fmt::format("give at most 4096x{}", kMaxFilmHeight));
    const std::uint64_t queued = Wavefront::mostPixels(device);
    if (options.scheduler == Scheduler::Wavefront && std::uint64_t(size[0]) * size[1] > queued)
        throw InputError("", "scheduler",
                         fmt::format("{}x{} pixels are too many for the wavefront", size[0], size[1]),
                         fmt::format("give at most {} pixels, or the megakernel", queued));
    const int most = BounceLayers::most(size);
    if (options.bounces > most)
        throw InputError("", "bounces",
                         fmt::format("{} bounces apart at {}x{} pixels", options.bounces, size[0], size[1]),
                         fmt::format("give at most {}", most));
}

PathTraceOptions pathTraceOptions(const RenderOptions& options, const ShutterTimes& shutter) {
    PathTraceOptions result;
    result.size = options.size;
    result.maxDepth = options.maxDepth < 0
                          ? kUnlimitedDepth
                          : std::uint32_t(std::min<std::int64_t>(options.maxDepth, kUnlimitedDepth));
    result.nextEventEstimation = options.nextEventEstimation;
    result.accelerator = options.accelerator;
    if (options.scheduler == Scheduler::Wavefront) result.scheduler = Scheduler::Wavefront;
    const bool once = options.integrator == Integrator::Direct ||
                      options.integrator == Integrator::Hemisphere ||
                      options.integrator == Integrator::AmbientOcclusion;
    if (once) result.maxDepth = std::min(result.maxDepth, 1u);
    result.radiosity = options.integrator == Integrator::Radiosity;
    result.photonTargets = options.integrator == Integrator::Path && options.guiding != Guiding::Off;
    if (result.radiosity) result.maxDepth = 0;
    result.whitted = options.integrator == Integrator::Whitted;
    result.hemisphere = options.integrator == Integrator::Hemisphere;
    result.normalMapping = options.normalMapping;
    if (result.hemisphere) result.nextEventEstimation = false;
    result.roulette = options.roulette;
    result.survival = options.survival;
    result.sampler = options.sampler;
    result.samples = options.samples;
    result.lights = options.lights;
    result.filter = options.filter;
    result.shutter = shutter;
    result.seed = options.seed;
    result.adaptive = options.adaptive;
    result.bounces = int(options.bounces);
    return result;
}

std::uint32_t lightSamples(const DeviceScene& scene, const Scene::Bounds& bounds, const glm::dvec3& eye) {
    const bool outside =
        glm::any(glm::lessThan(eye, bounds.lower)) || glm::any(glm::greaterThan(eye, bounds.upper));
    return scene.hasEnvironmentImage() && outside ? 4 : 1;
}

void renderPaths(Device& device, PreparedScene& scene, const View& view, FilmTarget& target, RenderJob& job,
                 std::optional<PatchList> patches) {
    RenderResult& result = job.result;
    target.clear();
    PathTraceOptions traceOptions = pathTraceOptions(job.options, view.shutter);
    traceOptions.cameraPoses = view.poses;
    traceOptions.lightSamples = lightSamples(scene.deviceScene, scene.bounds, glm::dvec3(view.transform[3]));
    std::optional<RadiosityPass> radiosity;
    if (patches) {
        radiosity.emplace(device, scene.deviceScene, std::move(*patches));
        traceOptions.patches = &*radiosity;
    }
    const std::optional<CausticGuide> guide = guideCaustics(device, scene.deviceScene, traceOptions, job);
    PathTraceOptions guidedOptions = traceOptions;
    if (guide) guidedOptions.guide = &*guide;
    PathTracer tracer(device, scene.deviceScene, view.camera, view.transform, guidedOptions, target.film());
    job.graphviz = tracer.graphviz();
    // Every kernel runs once before the clock of rendering starts: the driver compiles at the first dispatch.
    // The pass of first hits needs no second run.
    tracer.advance(0);
    target.resolve();
    FirstHits hits;
    if (job.options.auxiliary || job.options.denoise) hits = tracer.firstHits();
    MeterReader meters(device, scene, view, traceOptions);
    const std::vector<PassTiming> compiling = tracer.timings();
    if (!job.notify({.stage = "compile"})) return;
    Checkpointing checkpoints(device, tracer, target.film(), scene.identity, view, job);
    job.beginRendering();
    if (radiosity && !solveRadiosity(*radiosity, job)) return;

    result.samples = PathLoop(tracer, target, checkpoints, job, device.info().type == "cpu").run();
    if (!result.cancelled) meters.read(job);
    const FilmImages film = target.resolve();
    result.error = estimateError(film);
    if (radiosity) result.error.reliable = false;  // it knows nothing of the patches
    if (job.options.denoise) addDenoised(device, film, hits, job);
    job.finish();
    if (job.options.errorMap) {
        Frame map(film.width, film.height);
        map.add({"R", "G", "B"}, relativeStandardErrors(film).data(), 3);
        result.errorMap = map.image();
    }
    warnOfLimits(film, job);

    Frame frame(film.width, film.height);
    frame.add({"R", "G", "B"}, film.mean.data(), 4);
    if (job.options.auxiliary) {
        addFirstHits(frame, hits);
        const bool stratified = job.options.sampler != SamplerKind::Independent;
        const std::vector<float> variance = stratified ? varianceOfMean(film) : film.variance;
        frame.add({"variance.R", "variance.G", "variance.B"}, variance.data(), 4);
        frame.add({"samples"}, film.mean.data(), 4, 3);
    }
    if (job.options.bounces >= 0) addBounces(frame, tracer.bounceLayers(film.mean));
    result.image = frame.image();
    for (std::size_t i = 3; i < film.variance.size(); i += 4)
        result.nanCount += std::uint64_t(film.variance[i]);
    if (result.nanCount > 0) {
        result.warnings.push_back(
            fmt::format("{} samples were not finite and are left out", result.nanCount));
    }
    noteCounters(tracer.counters(), result);
    for (const auto& skipped : tracer.skipped()) result.skipped.push_back(skipped);
    const PackedScene& info = scene.deviceScene.info();
    if (job.options.integrator == Integrator::Whitted && info.environmentSize[0] == 0 &&
        info.environment != glm::vec3(0.0f)) {
        result.skipped.emplace_back(
            "constant environment on rough surfaces",
            "--integrator whitted samples lights, and a constant environment is none");
    }
    job.addTimings(target.timings());
    job.addTimings(timingsSince(compiling, tracer.timings()));
}

}  // namespace helio
