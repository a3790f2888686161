#include "passes/renderer/lighting.hpp"
#include "passes/renderer/motion.hpp"
#include "passes/renderer/path_render.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/raster_render.hpp"
#include "passes/renderer/render_job.hpp"
#include "passes/renderer/scene_warnings.hpp"

#include <heliograph/error.hpp>
#include <heliograph/pose.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

void refuse(bool bad, const char* option, const std::string& fault, const char* remedy) {
    if (bad) throw InputError("", option, fault, remedy);
}

void checkAntialiasing(const Antialiasing& antialiasing) {
    using Kind = Antialiasing::Kind;
    const std::size_t count = antialiasing.positions.size();
    const bool samples = antialiasing.kind == Kind::Supersampling ||
                         antialiasing.kind == Kind::Multisampling || antialiasing.kind == Kind::Temporal;
    refuse(samples != (count > 0), "antialiasing", fmt::format("{} positions of samples", count),
           "give positions for supersampling, multisampling and temporal antialiasing, and for nothing else");
    refuse(antialiasing.kind == Kind::Multisampling && count > 16, "antialiasing",
           fmt::format("multisampling with {} samples", count), "give at most 16");
    for (const auto& position : antialiasing.positions)
        for (const float c : position)
            refuse(!(c >= 0 && c <= 1), "antialiasing", fmt::format("a sample at {} of its pixel", c),
                   "give positions from 0 to 1");
}

void checkTemporal(const RenderOptions& options) {
    if (options.antialiasing.kind != Antialiasing::Kind::Temporal) return;
    const Antialiasing::Temporal& temporal = options.antialiasing.temporal;
    refuse(options.pipeline != Pipeline::Raster, "antialiasing",
           "frames are mixed by the raster pipeline only", "leave it out");
    refuse(temporal.frames == 0 || temporal.frames > 65536, "antialiasing.temporal",
           fmt::format("{} frames", temporal.frames), "give 1 to 65536");
    refuse(!(temporal.frameSeconds >= 0 && temporal.frameSeconds <= 1e6), "antialiasing.temporal",
           fmt::format("frames {} s apart", temporal.frameSeconds), "give a time of at least 0");
    refuse(!(temporal.blend >= 1e-6 && temporal.blend <= 0.5), "antialiasing.temporal",
           fmt::format("a blend of {}", temporal.blend), "give 1e-6 to 0.5");
    refuse(temporal.upscale < 1 || temporal.upscale > 4 || options.size[0] % temporal.upscale != 0 ||
               options.size[1] % temporal.upscale != 0,
           "antialiasing.temporal",
           fmt::format("{}x{} pixels upscaled by {}", options.size[0], options.size[1], temporal.upscale),
           "give 1 to 4, and a size that is a multiple of it each way");
    refuse(options.depthFormat != DepthFormat::Reversed, "antialiasing.temporal",
           "surfaces are known again by their reversed depth", "leave the depth format out");
}

void check(const RenderOptions& options) {
    const auto [width, height] = options.size;
    refuse(width == 0 || height == 0, "size", fmt::format("{}x{} pixels", width, height),
           "give at least 1x1");
    refuse(options.samples == 0 || options.samples >= (1u << 24), "samples",
           fmt::format("{} samples per pixel", options.samples), "give 1 to 16777215");
    refuse(!(options.maxError >= 0), "maxError", "is negative or not a number", "give 0 for no limit");
    refuse(!(options.maxSeconds >= 0), "maxSeconds", "is negative or not a number", "give 0 for no limit");
    refuse(!std::isfinite(options.frameTime), "frameTime", "is not finite", "give a time in seconds");
    if (options.shutter) {
        const auto [open, close] = *options.shutter;
        refuse(!(open >= -1e6 && close <= 1e6), "shutter", fmt::format("from {} to {}", open, close),
               "give seconds");
        refuse(!(close >= open), "shutter", fmt::format("closes at {} before it opens at {}", close, open),
               "give a close of at least open");
    }
    refuse(options.motionSteps == 0 || options.motionSteps > 64, "motionSteps",
           fmt::format("{} steps", options.motionSteps), "give 1 to 64");
    checkAntialiasing(options.antialiasing);
    checkTemporal(options);
    const Shadows& shadows = options.shadows;
    refuse(shadows.resolution != 0 && (shadows.resolution < 16 || shadows.resolution > 4096),
           "shadows.resolution", fmt::format("{} texels", shadows.resolution), "give 16 to 4096, or 0");
    refuse(!(shadows.filterRadius > 0 && shadows.filterRadius <= 16), "shadows.filterRadius",
           fmt::format("{} texels", shadows.filterRadius), "give up to 16");
    refuse(!(shadows.lightSize >= 0 && shadows.lightSize < 1e30f), "shadows.lightSize",
           fmt::format("{}", shadows.lightSize), "give a size that is not negative");
    refuse(options.lightSamples > 4096, "lightSamples",
           fmt::format("{} lights of a pixel", options.lightSamples),
           "give at most 4096, or 0 for all lights");
    refuse(options.pipeline == Pipeline::Raster && options.integrator != Integrator::Path, "integrator",
           "the raster pipeline traces no paths", "leave it out");
    refuse((options.denoise || options.errorMap) && options.pipeline == Pipeline::Raster, "denoise, errorMap",
           "the raster pipeline has no halves of samples to go by", "leave it out");
    refuse(options.denoise && options.samples < 2, "denoise", "one sample says nothing of its noise",
           "take two samples per pixel or more");
    refuse(options.adaptive && options.pipeline == Pipeline::Raster, "adaptive",
           "the raster pipeline takes equal samples", "leave it out");
    refuse(options.adaptive && options.sampler == SamplerKind::SobolBlue, "adaptive",
           "this sampler correlates neighbours, and a pixel's number of samples would depend on its own",
           "choose another sampler");
    refuse(options.adaptive && options.samples >= (1u << 20), "adaptive",
           fmt::format("{} samples per pixel, of which some pixels would take 16 times as many",
                       options.samples),
           "give at most 1048575");
    refuse(!(options.roulette >= 1e-3 && options.roulette <= 1e30), "roulette",
           fmt::format("{}", options.roulette), "give 0.001 or more");
    refuse(!(options.survival >= 0 && options.survival <= 1), "survival", fmt::format("{}", options.survival),
           "give a chance of up to 1, or 0 for none");
    refuse(options.normalMapping == NormalMapping::Facets &&
               (options.pipeline == Pipeline::Raster || options.integrator == Integrator::Hemisphere ||
                options.integrator == Integrator::AmbientOcclusion),
           "normalMapping", "there is no light to follow between facets", "leave it out");
    refuse(options.radiosityPatches == 0 || options.radiosityPatches > kMostPatches, "radiosityPatches",
           fmt::format("{} patches", options.radiosityPatches), "give 1 to 2048");
    refuse(options.integrator == Integrator::Radiosity && (options.maxDepth >= 0 || options.bounces >= 0),
           "maxDepth, bounces", "radiosity has the light of all bounces at once", "leave them out");
    refuse(options.integrator == Integrator::Radiosity && options.maxSeconds > 0, "maxSeconds",
           "the light of patches takes its time to solve", "leave it out");
    refuse(options.bounces >= 0 && options.pipeline == Pipeline::Raster, "bounces",
           "the raster pipeline has direct light alone", "leave it out");
    refuse(options.bounces >= 0 && !options.checkpoint.empty(), "bounces",
           "a checkpoint does not keep light by its bounces", "leave one of them out");
    refuse(options.resume && options.checkpoint.empty(), "resume", "there is no checkpoint to resume from",
           "name the file as checkpoint");
    refuse(options.pipeline == Pipeline::Raster && !options.checkpoint.empty(), "checkpoint",
           "the raster pipeline is done at once", "leave it out");
    if (!options.environment) return;
    const Environment& environment = *options.environment;
    for (int c = 0; c < 3; ++c) {
        const float radiance = environment.radiance[c];
        refuse(!(radiance >= 0) || radiance > 0x1p100f, "environment", fmt::format("radiance {}", radiance),
               "give numbers from 0 to 2^100 (1.27e30), the most that a picture holds");
    }
}

void check(const std::optional<Environment>& environment, const Scene& scene) {
    if (!environment) return;
    refuse(environment->image >= int(scene.images.size()), "environment",
           fmt::format("image {} does not exist", environment->image),
           "add it to the scene's images, see loadTextureImage");
    const double length = glm::dot(environment->rotation, environment->rotation);
    refuse(!(length > 0.5 && length < 2), "environment", "its rotation is no unit quaternion",
           "give a rotation");
}

/** Before the scene is prepared: what is too large to cut, and what patches leave out. */
void checkPatches(const Scene& scene, RenderResult& result) {
    refuse(scene.triangleCount() > kMostPatches, "radiosity",
           fmt::format("the scene has {} triangles", scene.triangleCount()),
           "give at most 2048, or render by paths");
    refuse(scene.shapeCount() > 0, "radiosity", "patches are cut from triangles, and the scene has shapes",
           "give meshes in their place, or render by paths");
    const bool isSmooth = std::ranges::any_of(scene.meshes, [](const Mesh& mesh) {
        return std::ranges::any_of(mesh.primitives, [](const Primitive& p) { return !p.normals.empty(); });
    });
    if (isSmooth) result.skipped.emplace_back("geometry.normals", "patches are flat, whatever normals say");
}

/** The patches of a scene as it was prepared. */
PatchList patchesOf(const Scene& scene, const std::optional<Environment>& environment, PackOptions pack,
                    const PreparedScene& prepared, std::uint32_t count) {
    refuse(prepared.deviceScene.info().motionKeys > 0, "radiosity", "the scene moves",
           "close the shutter, or render by paths");
    Scene lit = scene;
    lit.environment = environment;
    pack.origin = prepared.origin;
    return cutIntoPatches(packScene(lit, pack), count);
}

/** A black picture: what there is when a render is cancelled before its first sample. */
ImageF blackImage(const std::array<std::uint32_t, 2>& size) {
    return {size[0], size[1], {"R", "G", "B"}, std::vector<float>(std::size_t(size[0]) * size[1] * 3), {}};
}

template <typename T>
void removeRepeated(std::vector<T>& list) {
    std::vector<T> kept;
    for (T& entry : list) {
        if (std::ranges::find(kept, entry) == kept.end()) kept.push_back(std::move(entry));
    }
    list = std::move(kept);
}

}  // namespace

void RenderJob::addTimings(const std::vector<PassTiming>& timings) {
    for (const PassTiming& timing : timings) {
        const auto known = std::ranges::find(result.passes, timing.name, &RenderResult::PassTime::name);
        if (known == result.passes.end()) {
            result.passes.push_back({timing.name, timing.milliseconds});
        } else {
            known->milliseconds += timing.milliseconds;
        }
    }
}

struct Renderer::Impl {
    explicit Impl(const DeviceOptions& options) : device(options), scenes(device) {}

    /** `frame`: of how many. */
    void run(const Scene& scene, const Motion& motion, RenderJob& job, std::uint32_t frame = 0,
             std::uint32_t frames = 1);
    void runFrames(const Scene& scene, RenderJob& job);
    /** What the frames before left, where there are several. */
    TemporalStep temporalStep(const PreparedScene& prepared, bool moves, const RenderOptions& options,
                              std::uint32_t frame, std::uint32_t frames);
    FilmTarget& film(const std::array<std::uint32_t, 2>& size) {
        if (!target || target->film().width() != size[0] || target->film().height() != size[1]) {
            target.reset();
            target = std::make_unique<FilmTarget>(device, size[0], size[1]);
        }
        return *target;
    }

    Device device;
    SceneCache scenes;
    std::unique_ptr<FilmTarget> target;
    std::shared_ptr<TemporalHistory> temporal;
    SceneIdentity lastFrame;
    std::string graphviz;
};

TemporalStep Renderer::Impl::temporalStep(const PreparedScene& prepared, bool moves,
                                          const RenderOptions& options, std::uint32_t frame,
                                          std::uint32_t frames) {
    const std::uint32_t upscale = options.antialiasing.temporal.upscale,
                        triangles = moves ? prepared.deviceScene.info().triangleCount : 0;
    if (!temporal || !temporal->fits(options.size, upscale, triangles))
        temporal = std::make_shared<TemporalHistory>(device, options.size, upscale, triangles);
    if (frame == 0) temporal->restart();
    const bool changed = frame > 0 && !(prepared.identity == lastFrame);
    lastFrame = prepared.identity;
    return {temporal, frame, frames, changed};
}

/** A render for each frame, the last at the options' time. */
void Renderer::Impl::runFrames(const Scene& scene, RenderJob& job) {
    const std::uint32_t frames = job.options.antialiasing.temporal.frames;
    const double frameSeconds = job.options.antialiasing.temporal.frameSeconds;
    for (std::uint32_t frame = 0; frame < frames && !job.result.cancelled; ++frame) {
        RenderOptions options = job.options;
        options.frameTime -= frameSeconds * (frames - 1 - frame);
        const Motion motion = motionOf(scene, options);
        run(motion.first ? *motion.first : scene, motion, job, frame, frames);
    }
}

void Renderer::Impl::run(const Scene& scene, const Motion& motion, RenderJob& job, std::uint32_t frame,
                         std::uint32_t frames) {
    const RenderOptions& options = job.options;
    if (frame == 0 && !job.notify({.stage = "load"})) return;
    View view = chooseView(scene, options.camera, double(options.size[0]) / options.size[1]);
    const std::optional<Environment> environment = chooseEnvironment(scene, options, job.result.warnings);
    // What ambient occlusion shows is no luminance, and no more is the light of a scene that has none.
    const bool isGiven = environment == (options.environment ? options.environment : scene.environment);
    if (view.camera.exposure && options.integrator != Integrator::AmbientOcclusion) {
        if (isGiven)
            job.result.exposure = exposureStops(*view.camera.exposure);
        else
            job.result.warnings.emplace_back(
                "the camera's exposure is left out: it is meant for the light of the scene, which has none");
    }
    warnOfTexcoords(scene, job.result.warnings);
    const bool path = options.pipeline == Pipeline::Path;
    if (options.integrator == Integrator::Radiosity) checkPatches(scene, job.result);
    const PackOptions pack = path ? PathTracer::packOptions(scene, pathTraceOptions(options, motion.shutter))
                                  : rasterPackOptions();
    PreparedScene& prepared = scenes.prepare(scene, environment, motion.later, pack);
    view.transform[3] -= glm::dvec4(prepared.origin, 0.0);
    view.poses = motion.cameraPoses;
    for (glm::dmat4& pose : view.poses) pose[3] -= glm::dvec4(prepared.origin, 0.0);
    view.shutter = motion.shutter;
    job.result.features = prepared.features;
    job.result.skipped = prepared.skipped;
    job.result.skipped.insert(job.result.skipped.end(), motion.skipped.begin(), motion.skipped.end());
    for (const PlacedMeter& placed : scene.placedMeters()) {
        view.meters.emplace_back(scene.meters[std::size_t(placed.meter)], placed.transform);
        view.meters.back().second[3] -= glm::dvec4(prepared.origin, 0.0);
    }
    const bool readsMeters = path && options.integrator != Integrator::Radiosity &&
                             options.integrator != Integrator::AmbientOcclusion;
    if (!readsMeters && !view.meters.empty()) {
        view.meters.clear();
        job.result.skipped.emplace_back("meters", "they are read by integrators that follow paths of light");
    }
    job.result.warnings.insert(job.result.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
    const glm::dvec3 eye(view.transform[3]);
    warnOfExtent(prepared.bounds, eye, job.result.warnings);
    if (frame == 0) warnOfEye(scene, prepared.bounds, prepared.origin, eye, job.result.warnings);
    if (frame == 0 && !job.notify({.stage = "compile"})) return;
    if (path) {
        std::optional<PatchList> patches;
        if (options.integrator == Integrator::Radiosity)
            patches = patchesOf(scene, environment, pack, prepared, options.radiosityPatches);
        renderPaths(device, prepared, view, film(options.size), job, std::move(patches));
    } else {
        TemporalStep step;
        if (options.antialiasing.kind == Antialiasing::Kind::Temporal)
            step = temporalStep(prepared, motion.first.has_value(), options, frame, frames);
        renderRaster(device, prepared, view, job, step);
    }
}

Renderer::Renderer(const DeviceOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Device& Renderer::device() {
    return impl_->device;
}

std::string Renderer::graphviz() const {
    return impl_->graphviz;
}

std::uint64_t Renderer::sceneBuilds() const {
    return impl_->scenes.builds();
}

RenderResult Renderer::render(const Scene& scene, const RenderOptions& options) {
    RenderJob job(options);
    RenderResult& result = job.result;
    check(options);
    if (options.pipeline == Pipeline::Path) checkPathSize(options, impl_->device);
    Motion motion = motionOf(scene, options);
    std::optional<Scene>& still = motion.first;  // only a scene that moves is copied
    check(options.environment, scene);
    if (options.integrator == Integrator::AmbientOcclusion) still = whiteScene(still ? *still : scene);
    result.scene = scene.name;
    result.device = impl_->device.info().name;
    result.version = version();
    result.seed = options.seed;
    result.warnings = scene.warnings;
    if (options.antialiasing.kind == Antialiasing::Kind::Temporal)
        impl_->runFrames(scene, job);
    else
        impl_->run(still ? *still : scene, motion, job);
    job.finish();
    if (result.image.data.empty()) result.image = blackImage(options.size);
    if (!job.graphviz.empty()) impl_->graphviz = job.graphviz;
    removeRepeated(result.skipped);
    removeRepeated(result.warnings);
    result.hostBytes = peakHostBytes();
    result.deviceBytes = impl_->device.memory().peakUsedBytes;
    return std::move(job.result);
}

}  // namespace helio
