#include "passes/pathtrace/path_tracer.hpp"

#include "passes/intersect/tree_access.hpp"
#include "passes/pathtrace/bounce_layers.hpp"
#include "passes/pathtrace/camera_frame.hpp"
#include "passes/pathtrace/caustic_guide.hpp"
#include "passes/pathtrace/kernel_interface.hpp"
#include "passes/pathtrace/parameters.hpp"
#include "passes/pathtrace/unrolled_scene.hpp"
#include "passes/pathtrace/wavefront.hpp"
#include "passes/radiosity/radiosity_pass.hpp"
#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/pathtrace.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <map>
#include <optional>

namespace helio {
namespace {

/** uCounters of trace.comp. */
struct DeviceCounters {
    std::uint32_t open, unused;
    std::uint64_t camera, bounce, shadow, cut, abandoned;
};
static_assert(sizeof(DeviceCounters) == 48);

const std::vector<std::string_view> kSurfaceBuffers = {"uTriangles", "uNodes",   "uNormals",
                                                       "uTexcoords", "uColors",  "uMaterials",
                                                       "uTextures",  "uTexels8", "uTexelsFloat"};
const std::vector<std::string_view> kSurfaceConstants = {"HAS_NORMALS",         "HAS_COLORS",
                                                         "HAS_BASE_TEXTURES",   "HAS_FLOAT_TEXTURES",
                                                         "HAS_LINEAR_TEXTURES", "TRIANGLE_COUNT"};

/** Rows of texels that uState has a pixel: of paths, and of guided ones. */
constexpr std::array<std::uint32_t, 2> kStateRows = {2, 3};

/** Loop turns of a dispatch of the megakernel for which the wavefront makes one round. */
constexpr std::uint32_t kTurnsOfRound = 1000;

/** PathTraceOptions::turnBudget at most where several lights are asked: a turn of the kernel's loop may take
 * 8000 turns of others for each ray, and a dispatch has 65,535. */
constexpr std::uint32_t kTurnsBesideLights = 24000;

/** Workgroups of 8 x 8 pixels in rows that a dispatch may have. */
std::array<std::uint32_t, 2> groupsFor(const std::array<std::uint32_t, 2>& size) {
    const std::uint64_t tiles = std::uint64_t((size[0] + 7) / 8) * ((size[1] + 7) / 8);
    constexpr std::uint64_t most = 65535;
    const std::uint64_t rows = (tiles + most - 1) / most;
    return {std::uint32_t((tiles + rows - 1) / rows), std::uint32_t(rows)};
}

}  // namespace

struct PathTracer::Impl {
    Impl(Device& device, DeviceScene& sceneIn, const Camera& camera, const glm::dmat4& transform,
         const PathTraceOptions& optionsIn, Film& film)
        : device_(device),
          scene_(sceneIn),
          options_(optionsIn),
          frame_(optionsIn.meter
                     ? meterFrame(*optionsIn.meter, transform, optionsIn.meterExtent)
                     : cameraFrame(camera, transform, double(optionsIn.size[0]) / double(optionsIn.size[1]))),
          camera_(cameraTable(camera, double(optionsIn.size[0]) / double(optionsIn.size[1]),
                              optionsIn.shutter, optionsIn.cameraPoses)),
          orthographic_(!camera.perspective),
          state_(device, "pathtrace.state", optionsIn.size[0] * 4,
                 optionsIn.size[1] * kStateRows[optionsIn.guide != nullptr], Format::RGBA32F),
          counters_(device, "pathtrace.counters", sizeof(DeviceCounters)) {
        assert(film.width() == options_.size[0] && film.height() == options_.size[1]);
        assert(options_.turnBudget >= 1 && options_.turnBudget <= 33000);
        const DeviceCounters zero{};
        counters_.upload(&zero, sizeof zero);
        skipped_ = scene_.info().skipped;
        if (scene_.info().materialFeatures != 0)
            materialDefines_["SURFACE_MATERIALS"] = fmt::format("0x{:x}u", scene_.info().materialFeatures);
        const std::uint32_t maps = pack::kNormalMapFeature | pack::kBumpFeature;
        if (options_.normalMapping == NormalMapping::Facets && (scene_.info().materialFeatures & maps) != 0) {
            assert(!options_.hemisphere && "directions are not the surface's own");
            materialDefines_["TILTED_FACETS"] = "1";
        }
        if (!camera_.texels.empty()) table_.emplace(makeBuffer(device, "pathtrace.camera", camera_.texels));
        assert((scene_.info().motionKeys == 0 || options_.shutter != ShutterTimes{}) && "no time to move in");
        unrolled_ = scene_.info().nodeCount == 0 && scene_.info().triangleCount > 0;
        if (unrolled_ || !scene_.info().writtenOut.empty()) generated_ = unrolledScene(scene_.info());
        if (options_.scheduler == Scheduler::Wavefront) {
            assert(options_.kernel == nullptr);
            wavefront_.emplace(device, options_.size, lightSamples());
        }
        declareTrace(film);
    }

    /** LIGHTS_ASKED of the kernels. */
    std::uint32_t lightSamples() const {
        assert(options_.lightSamples >= 1 && options_.lightSamples <= kMostLightSamples);
        const PackedScene& info = scene_.info();
        const bool folds = !materialDefines_.contains("TILTED_FACETS");  // walks judge one
        // Comparators may test every triangle for each ray, and a dispatch has only so many turns.
        const bool quick = info.accelerator == AcceleratorKind::Bvh || info.triangleCount <= 2000;
        const bool draws = options_.nextEventEstimation && !options_.meter && !options_.photons;
        return folds && quick && draws ? options_.lightSamples : 1;
    }

    SpecConstants constants() const {
        SpecConstants spec = scene_.constants(kSurfaceConstants);
        if (!unrolled_) {
            spec["STACK_SIZE"] = std::int32_t(scene_.info().treeDepth + 1);
            if (scene_.info().accelerator == AcceleratorKind::Bvh) spec.merge(accessConstants(access_));
        }
        if (scene_.info().splitTree) spec["SPLIT_TREE"] = true;
        if (scene_.hasPlacedMeshes()) spec.merge(scene_.constants({"PLACED_BITS"}));
        spec["ORTHOGRAPHIC"] = orthographic_;
        spec.merge(SpecConstants(camera_.constants));
        if (scene_.info().hasShapes())
            spec.merge(scene_.constants(
                {"LISTED_SHAPES", "SHAPES_IN_TREE", "HAS_SPHERES", "HAS_FLAT_SHAPES", "HAS_TORI"}));
        if (!materialDefines_.empty())
            spec.merge(scene_.constants({"ALBEDO_TABLES", "HAS_ROUGH_FACETS", "HAS_TILTED_LOBES"}));
        return spec;
    }

    /** The kernel as built, or for more than diffuse surfaces, with what needs bindings of its own, or with
     * the scene written out or another accelerator. */
    Kernel kernel(const Kernel& built, std::map<std::string, std::string> defines = {}) const {
        defines.insert(materialDefines_.begin(), materialDefines_.end());
        if (scene_.info().accelerator != AcceleratorKind::Bvh)
            defines.merge(acceleratorVariant(scene_.info().accelerator).defines);
        else if (!unrolled_)
            defines.merge(accessDefines(access_, device_, scene_.info()));
        if (scene_.info().solidTextures) defines["SOLID_TEXTURES"] = "1";
        if (scene_.info().hasShapes()) defines["SHAPES"] = "1";
        if (scene_.hasPlacedMeshes()) defines["INSTANCES"] = "1";
        if (table_) defines["CAMERA_TABLE"] = "1";
        if (scene_.info().motionKeys > 0) defines["MOTION_KEYS"] = std::to_string(scene_.info().motionKeys);
        if (generated_.empty() && defines.empty()) return built;
        return compileVariant(built, {.defines = defines, .generated = generated_});
    }

    std::vector<std::string_view> surfaceBuffers() const {
        std::vector<std::string_view> names = kSurfaceBuffers;
        if (!materialDefines_.empty()) names.push_back("uTangents");
        if (scene_.info().solidTextures) names.push_back("uSolidPoints");
        if (scene_.hasPlacedMeshes()) names.push_back("uPlaced");
        if (scene_.info().motionKeys > 0) {
            std::erase(names, "uNormals");
            names.insert(names.end(), {"uTriangleKeys", "uNormalKeys"});
        }
        return names;
    }

    /** The camera's table, for cameras that have one. */
    std::vector<Binding> cameraBinding(Graph& graph) {
        if (!table_) return {};
        return {{"uCamera", graph.import(*table_)}};
    }

    void declareTrace(Film& film) {
        Graph graph(device_);
        const Image state = graph.import(state_);
        const Image filmImage = film.import(graph);
        const Buffer counters = graph.import(counters_);
        SpecConstants spec = constants();
        spec.merge(scene_.constants({"HAS_EMISSION", "HAS_EMISSION_TEXTURES", "HAS_AREA_LIGHTS",
                                     "HAS_PUNCTUAL_LIGHTS", "HAS_ENVIRONMENT", "LIGHT_COUNT",
                                     "HAS_TRIANGLE_LIGHTS", "LIGHT_BITS"}));
        std::map<std::string, std::string> defines;
        std::vector<std::string_view> buffers = {"uLights"};
        if (scene_.hasEnvironmentImage()) {
            defines["ENVIRONMENT_IMAGE"] = "1";
            buffers.push_back("uEnvironmentMap");
            spec.merge(scene_.environmentConstants());
        }
        if (scene_.hasLightTables()) {
            defines["LIGHT_TABLES"] = "1";
            buffers.insert(buffers.end(), {"uLightSlots", "uLightCells", "uLightRanges", "uLightOfTriangle"});
            spec.merge(scene_.lightTableConstants());
        }
        if (scene_.info().solidAngles != 0)
            defines["SOLID_ANGLES"] = std::to_string(scene_.info().solidAngles);
        std::vector<Binding> ends;
        if (options_.adaptive) {
            defines["ADAPTIVE"] = "1";
            const std::vector<std::uint32_t> none(std::size_t(options_.size[0]) * options_.size[1], 0);
            sampleEnds_.emplace(makeBuffer(device_, "pathtrace.sampleEnds", none));
            ends.push_back({"uSampleEnds", graph.import(*sampleEnds_), Format::R32UI});
        }
        std::vector<Binding> bounces;
        if (options_.bounces >= 0) {
            bounces_.emplace(device_, options_.size, options_.bounces);
            defines.merge(bounces_->defines());
            spec.merge(bounces_->constants());
            bounces.push_back({"uBounces", bounces_->import(graph)});
        }
        if (lightSamples() > 1) defines["LIGHTS_ASKED"] = std::to_string(lightSamples());
        if (options_.meter) defines["METER"] = "1";
        std::vector<Binding> points;
        if (!options_.meterPoints.empty()) {
            assert(options_.meterPoints.size() == std::size_t(options_.size[0]) * options_.size[1] * 2);
            defines["METER_POINTS"] = "1";
            meterPoints_.emplace(makeBuffer(device_, "pathtrace.meterPoints", options_.meterPoints));
            points.push_back({"uMeterPoints", graph.import(*meterPoints_)});
        }
        std::vector<Binding> caustics;
        if (options_.guide) {
            defines["GUIDED"] = "1";
            caustics = options_.guide->bindings(graph);
            spec.merge(options_.guide->constants());
        }
        if (options_.photons) {
            const PhotonTargets& targets = scene_.info().photonTargets;
            photonTargets_.emplace(makeBuffer(device_, "photons.targets", targets.slots));
            caustics = {{"uPhotonTargets", graph.import(*photonTargets_), Format::R32UI}};
            spec["PHOTON_TARGETS"] = std::int32_t(targets.slots.size());
            spec["PHOTON_AREA"] = targets.area;
            spec["PHOTON_EXTENT"] = targets.extent;
        }
        std::vector<Binding> patches;
        if (options_.radiosity) {
            assert(options_.maxDepth == 0 && options_.patches != nullptr);
            defines["RADIOSITY"] = "1";
            spec["HAS_EMISSION"] = false;
            patches = options_.patches->bindings(graph);
        }
        spec["SAMPLER_KIND"] = std::uint32_t(options_.sampler);
        spec["FILTER_KIND"] = std::uint32_t(options_.filter);
        const bool usesStrata =
            options_.sampler == SamplerKind::Stratified || options_.sampler == SamplerKind::SobolBlue;
        // Of the two halves of a pixel's samples each.
        if (usesStrata) spec["SAMPLER_STRATA"] = std::uint32_t(std::bit_width((options_.samples - 1) / 2));
        if (options_.roulette != PathTraceOptions{}.roulette) spec["ROULETTE"] = float(options_.roulette);
        if (options_.survival > 0) spec["SURVIVAL"] = float(options_.survival);
        spec["WHITTED"] = options_.whitted;
        spec["HEMISPHERE"] = options_.hemisphere;
        spec["NEXT_EVENT"] = options_.nextEventEstimation;
        const bool seesThrough = (scene_.info().materialFeatures & pack::kAlphaFeature) != 0;
        spec["COUNT_TURNS"] = !unrolled_ || seesThrough || scene_.info().listedShapes > 0;
        std::vector<Binding> reads,
            modifies = {{"uState", state}, {"uFilm", filmImage}, {"uCounters", counters}};
        for (const std::vector<Binding>& some :
             {scene_.bindings(graph, surfaceBuffers()), scene_.bindings(graph, buffers), cameraBinding(graph),
              ends, patches, points, caustics})
            reads.insert(reads.end(), some.begin(), some.end());
        modifies.insert(modifies.end(), bounces.begin(), bounces.end());
        if (wavefront_) {
            const auto variant = [&](const Kernel& built) { return kernel(built, defines); };
            wavefront_->declare(graph, {variant, spec, reads, modifies});
        } else {
            traceKernel_ = {kernel(options_.kernel ? *options_.kernel : shaders::trace, defines), spec};
            if (options_.photons) {
                const KernelReflection& reflection = reflect(traceKernel_.kernel);
                reads = bindingsOf(reflection, reads);
                modifies = bindingsOf(reflection, modifies);
                spec = traceKernel_.constants = constantsOf(reflection, spec);
            }
            graph.compute(options_.photons ? "photons" : "trace", traceKernel_.kernel, {.spec = spec})
                .reads(reads)
                .modifies(modifies)
                .record([this](Commands& commands) {
                    const auto groups = groupsFor(options_.size);
                    commands.push(parameters_).dispatch(groups[0], groups[1]);
                });
        }
        counted_ = graph.readback<DeviceCounters>(counters);
        plan_ = graph.compile();
    }

    bool advance(std::uint32_t sampleEnd) {
        assert(sampleEnd < (1u << 24));
        const std::uint32_t open = 0;
        counters_.upload(&open, sizeof open);
        parameters_ = {
            frame_,
            glm::vec4(scene_.info().environment, 0.0f),
            options_.size,
            sampleEnd,
            options_.seed,
            std::min(options_.maxDepth, kUnlimitedDepth),
            options_.maxDepth >= kUnlimitedDepth ? 1u : 0u,
            lightSamples() > 1 ? std::min(options_.turnBudget, kTurnsBesideLights) : options_.turnBudget,
            begun_ ? 0u : 1u};
        // What a meter receives counts as the first scattering.
        if (options_.meter && frame_.forward.w > 0.5f)
            parameters_.maxDepth = std::min(parameters_.maxDepth + 1, kUnlimitedDepth);
        begun_ = true;
        if (wavefront_) {
            const auto [execution, left] =
                wavefront_->run(plan_, parameters_, std::max(1u, options_.turnBudget / kTurnsOfRound),
                                [this](const Execution& done) { addTimings(done); });
            last_ = counted_.wait(execution).at(0);
            last_.open = left;
        } else {
            const Execution execution = plan_.execute();
            last_ = counted_.wait(execution).at(0);
            addTimings(execution);
        }
        return last_.open == 0;
    }

    void addTimings(const Execution& execution) {
        for (const PassTiming& timing : plan_.timings(execution)) {
            const auto known = std::ranges::find(timings_, timing.name, &PassTiming::name);
            if (known == timings_.end())
                timings_.push_back(timing);
            else
                known->milliseconds += timing.milliseconds;
        }
    }

    FirstHits firstHits() {
        const std::size_t pixels = std::size_t(options_.size[0]) * options_.size[1];
        Graph graph(device_);
        const Image ids = graph.image("first_hit.ids", {options_.size, Format::RGBA32F});
        const Image normals = graph.image("first_hit.normals", {options_.size, Format::RGBA32F});
        const Image albedos = graph.image("first_hit.albedos", {options_.size, Format::RGBA32F});
        const FirstHitParameters parameters{frame_, options_.size};
        graph.compute("first hit", kernel(shaders::first_hit), {.spec = constants()})
            .reads(scene_.bindings(graph, surfaceBuffers()))
            .reads(scene_.bindings(graph, {"uInstanceFirst"}))
            .reads(cameraBinding(graph))
            .overwrites({{"uIds", ids}, {"uNormal", normals}, {"uAlbedo", albedos}})
            .record([&](Commands& commands) {
                const auto groups = groupsFor(options_.size);
                commands.push(parameters).dispatch(groups[0], groups[1]);
            });
        const auto readIds = graph.readback<glm::vec4>(ids);
        const auto readNormals = graph.readback<glm::vec4>(normals);
        const auto readAlbedos = graph.readback<glm::vec4>(albedos);
        Plan plan = graph.compile();
        const Execution execution = plan.execute();
        FirstHits hits;
        for (const glm::vec4& texel : readIds.wait(execution)) {
            hits.instance.push_back(std::int32_t(texel.x));
            hits.triangle.push_back(std::int32_t(texel.y));
            hits.depth.push_back(texel.z);
        }
        for (const glm::vec4& texel : readNormals.wait(execution)) hits.normal.emplace_back(texel);
        for (const glm::vec4& texel : readAlbedos.wait(execution)) hits.albedo.emplace_back(texel);
        assert(hits.depth.size() == pixels);
        (void)pixels;
        return hits;
    }

    Device& device_;
    DeviceScene& scene_;
    PathTraceOptions options_;
    CameraFrame frame_;
    CameraTable camera_;
    std::optional<DeviceBuffer> table_;
    bool orthographic_;
    bool unrolled_ = false;
    TreeAccess access_ = keptTreeAccess(device_);
    std::string generated_;
    std::map<std::string, std::string> materialDefines_;
    DeviceImage state_;
    DeviceBuffer counters_;
    std::optional<DeviceBuffer> sampleEnds_;  ///< of adaptive sampling
    std::optional<DeviceBuffer> meterPoints_;
    std::optional<DeviceBuffer> photonTargets_;  ///< of PathTraceOptions::photons
    std::optional<BounceLayers> bounces_;
    std::optional<Wavefront> wavefront_;
    TraceParameters parameters_{};
    TraceKernel traceKernel_;
    Plan plan_;
    Readback<DeviceCounters> counted_;
    DeviceCounters last_{};
    bool begun_ = false;
    std::vector<PassTiming> timings_;
    std::vector<std::pair<std::string, std::string>> skipped_;
};

PathTracer::PathTracer(Device& device, DeviceScene& scene, const Camera& camera,
                       const glm::dmat4& cameraTransform, const PathTraceOptions& options, Film& film)
    : impl_(std::make_unique<Impl>(device, scene, camera, cameraTransform, options, film)) {}
PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;

PackOptions PathTracer::packOptions(const Scene& scene, const PathTraceOptions& options) {
    const bool choose = options.accelerator == AcceleratorKind::Auto;
    const bool moves = options.shutter != ShutterTimes{};
    const bool splits = options.accelerator == AcceleratorKind::SplitBvh;
    const bool onDevice = options.accelerator == AcceleratorKind::DeviceBvh;
    const bool tree = choose || splits || onDevice || options.accelerator == AcceleratorKind::Bvh;
    const Placing placing = tree && !moves && !options.radiosity ? options.placing : Placing::Flatten;
    return {.tree = !choose || moves || options.radiosity || placing == Placing::Always ||
                    scene.triangleCount() > kWrittenOutTriangles || scene.shapeCount() > kListedShapes,
            .writeOutLargest = choose && !moves && !options.radiosity,
            .accelerator = tree ? AcceleratorKind::Bvh : options.accelerator,
            .spatialSplits = splits && !options.radiosity,  // patches are found by their slots
            .deviceTree = onDevice,
            .sampleSurfaces = options.nextEventEstimation && !options.radiosity,
            .raysFindEnvironment = !options.whitted,
            .lights = options.lights,
            .placing = placing,
            .photons = options.photonTargets};
}

bool PathTracer::advance(std::uint32_t sampleEnd) {
    return impl_->advance(sampleEnd);
}

void PathTracer::restart(std::uint32_t seed) {
    impl_->options_.seed = seed;
    impl_->begun_ = false;
}

void PathTracer::setSampleEnds(const std::vector<std::uint32_t>& ends) {
    assert(impl_->sampleEnds_ && ends.size() * 4 == impl_->sampleEnds_->bytes());
    impl_->sampleEnds_->upload(ends.data(), ends.size() * 4);
}

void PathTracer::setTurnBudget(std::uint32_t turns) {
    assert(turns >= 1 && turns <= 33000);
    impl_->options_.turnBudget = turns;
}

PathCounters PathTracer::counters() const {
    const DeviceCounters& c = impl_->last_;
    return {c.camera, c.bounce, c.shadow, c.cut, c.abandoned};
}

void PathTracer::setCounters(const PathCounters& c) {
    assert(impl_->begun_);
    impl_->last_ = {0, 0, c.cameraRays, c.bounceRays, c.shadowRays, c.truncatedPaths, c.abandonedRays};
    impl_->counters_.upload(&impl_->last_, sizeof impl_->last_);
}

std::uint32_t PathTracer::stateFloats() const {
    return kStateRows[impl_->options_.guide != nullptr] * 4 * 4;
}

Image PathTracer::importState(Graph& graph) {
    return graph.import(impl_->state_);
}

FirstHits PathTracer::firstHits() {
    return impl_->firstHits();
}

std::vector<std::vector<float>> PathTracer::bounceLayers(const std::vector<float>& film) {
    assert(impl_->bounces_);
    return impl_->bounces_->means(film);
}

std::vector<PassTiming> PathTracer::timings() const {
    return impl_->timings_;
}

const PathTracer::TraceKernel& PathTracer::traceKernel() const {
    return impl_->traceKernel_;
}

std::string PathTracer::graphviz() const {
    return impl_->plan_.graphviz();
}

const std::vector<std::pair<std::string, std::string>>& PathTracer::skipped() const {
    return impl_->skipped_;
}

}  // namespace helio
