#pragma once
/** @file
 * Path tracing of a device scene into a film: resumable dispatches of one kernel, and a pass for what each
 * pixel's centre sees first.
 *
 *     DeviceScene scene(device, source, PathTracer::packOptions(options));
 *     Film film(device, width, height);   // cleared, see passes/film
 *     PathTracer tracer(device, scene, camera, placed.transform, options, film);
 *     for (std::uint32_t end = 1; end <= samples; ++end)
 *         while (!tracer.advance(end)) reportProgress(tracer.counters());
 */
#include "passes/film/film.hpp"
#include "passes/pathtrace/camera_frame.hpp"
#include "passes/scene/device_scene.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace helio {

class CausticGuide;
class RadiosityPass;

/** What "unlimited" means for a path: longer ones are cut and counted. */
inline constexpr std::uint32_t kUnlimitedDepth = 65536;

struct PathTraceOptions {
    std::array<std::uint32_t, 2> size = {0, 0};  ///< pixels
    std::uint32_t maxDepth = kUnlimitedDepth;    ///< scatterings at most: 0 emission only, 1 direct light
    bool nextEventEstimation = true;             ///< sample surface lights; else rays must find them
    AcceleratorKind accelerator = AcceleratorKind::Auto;
    Scheduler scheduler = Scheduler::Megakernel;  ///< changes the time alone; not Auto
    bool whitted = false;                         ///< paths go on from mirrors and smooth refraction only
    bool hemisphere = false;                      ///< directions are uniform over the hemisphere
    double roulette = 3, survival = 0;            ///< see RenderOptions
    /** Directions to lights that are asked where the camera's ray arrives, at most 4; one where meters,
     * facets that are followed or comparators over many triangles are asked for. */
    std::uint32_t lightSamples = 1;
    NormalMapping normalMapping = NormalMapping::Folded;  ///< Facets: not with `hemisphere`
    SamplerKind sampler = SamplerKind::Sobol;
    std::uint32_t samples = 64;  ///< per pixel, to come: Stratified and SobolBlue share space out among them
    PixelFilter filter = PixelFilter::Box;
    LightChoice lights = LightChoice::Adaptive;
    Placing placing = Placing::WhereItSaves;
    ShutterTimes shutter = {};  ///< where something moves
    /** Node to world at times evenly over what is rendered, where the camera moves; the first is the one that
     * the tracer is given. */
    std::vector<glm::dmat4> cameraPoses = {};
    std::uint32_t seed = 0;
    bool adaptive = false;  ///< each pixel has its own number of samples, see setSampleEnds()
    int bounces = -1;       ///< light of up to so many scatterings is also summed apart, see bounceLayers()
    /** What is rendered is a meter's paths, placed by the camera's transform, in as many strata as there are
     * pixels; a scene whose coordinates are at most `meterExtent`. */
    std::optional<Meter> meter = {};
    glm::dvec3 meterExtent{0.0};
    /** Where not empty, each pixel has a meter of irradiance of its own: two a pixel, its place (off its
     * surface) and the unit vector that it faces along. `meter` is one of irradiance then. */
    std::vector<glm::vec4> meterPoints = {};
    /** Surfaces shine with what `patches` has solved and give off nothing else; for a maxDepth of 0. */
    bool radiosity = false;
    RadiosityPass* patches = nullptr;  ///< need not be there for packOptions()
    /** Whether the scene is packed for photons, see CausticGuide. */
    bool photonTargets = false;
    const CausticGuide* guide = nullptr;  ///< where its tables guide paths; must outlive the tracer
    bool photons = false;                 ///< `kernel` is photons.comp
    /** Loop turns a dispatch may start with; the result does not depend on it. lavapipe ends loops without a
     * word after 65,535 turns, of which two rays may take 16,000 each. */
    std::uint32_t turnBudget = 30000;
    /** In place of trace.comp: a benchmark's kernel of the same interface. */
    const Kernel* kernel = nullptr;
};

/** Totals since the tracer was made; exact. */
struct PathCounters {
    std::uint64_t cameraRays = 0, bounceRays = 0, shadowRays = 0;
    std::uint64_t truncatedPaths =
        0;  ///< cut at kUnlimitedDepth; paths cut at a lower maxDepth are not counted
    std::uint64_t abandonedRays = 0;  ///< given up in the tree; 0 unless thousands of triangles coincide
};

/** What the ray through each pixel's centre meets first. Rows from the top. */
struct FirstHits {
    std::vector<std::int32_t> instance, triangle;  ///< -1 for a miss; triangle counts within the mesh
    std::vector<float> depth;                      ///< distance along the camera's -z; 0 for a miss
    std::vector<glm::vec3> normal;                 ///< unit shading normal towards the camera; 0 for a miss
    std::vector<glm::vec3> albedo;                 ///< linear base colour; 0 for a miss
};

/** Traces one view of one scene. The device, scene and film must outlive it. Move-only. */
class PathTracer {
public:
    /** `film`: of the options' size, cleared.
     * Compiles the kernels' pipelines; the driver finishes compiling at the first dispatch. */
    PathTracer(Device& device, DeviceScene& scene, const Camera& camera, const glm::dmat4& cameraTransform,
               const PathTraceOptions& options, Film& film);
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;
    PathTracer& operator=(PathTracer&&) noexcept;

    /** How a scene must be packed for these options. */
    static PackOptions packOptions(const Scene& scene, const PathTraceOptions& options);

    /** One dispatch towards `sampleEnd` samples in every pixel; true when all have them and are merged into
     * the film. sampleEnd must not fall from call to call, nor rise before true was returned. At most 4096
     * samples more than were reached before, and 2^24 in all. */
    bool advance(std::uint32_t sampleEnd);

    /** Begins anew with another seed, into a film that the caller has cleared; counters go on. */
    void restart(std::uint32_t seed);
    /** With PathTraceOptions::adaptive, before a batch: what takes the place of sampleEnd in advance(), pixel
     * by pixel from the upper left, under the same conditions. */
    void setSampleEnds(const std::vector<std::uint32_t>& ends);
    /** Loop turns of the next dispatches, see PathTraceOptions::turnBudget: how long one takes. */
    void setTurnBudget(std::uint32_t turns);

    PathCounters counters() const;
    /** For a render that goes on: the counters so far. The film and the state, which importState() gives, are
     * brought back by the caller, after a first advance(). */
    void setCounters(const PathCounters& counters);
    Image importState(Graph& graph);
    /** What the state has of a pixel. */
    std::uint32_t stateFloats() const;
    FirstHits firstHits();

    /** With PathTraceOptions::bounces: see BounceLayers::means(). */
    std::vector<std::vector<float>> bounceLayers(const std::vector<float>& film);

    /** Device times of all dispatches so far, by pass. */
    std::vector<PassTiming> timings() const;
    /** What the scene's features made of trace.comp, for tests and benchmarks that look at the code. */
    struct TraceKernel {
        Kernel kernel;
        SpecConstants constants;
    };
    const TraceKernel& traceKernel() const;

    /** Graphviz of the tracing plan. */
    std::string graphviz() const;
    /** What in the scene and options the kernels do not show (yet), and what the scene did not need. */
    const std::vector<std::pair<std::string, std::string>>& skipped() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace helio
