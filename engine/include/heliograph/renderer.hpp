#pragma once
/** @file The embedding interface: a scene in, an image with its error and its time out. */
#include <heliograph/accelerator.hpp>
#include <heliograph/device.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace helio {

enum class Pipeline : std::uint8_t { Path, Raster };
enum class PixelFilter : std::uint8_t { Box, Tent, Gaussian, BlackmanHarris };
/** Where samples are taken; shaders/sampling/sampler.glsl says how. The default is Owen-scrambled Sobol,
 * independent from pixel to pixel; SobolBlue correlates neighbours so that error is blue noise over the
 * screen. */
enum class SamplerKind : std::uint8_t { Sobol, Independent, Halton, Stratified, SobolBlue };
/** What of light's ways is followed: all (Path); those that scatter once (Direct); those over mirrors and
 * smooth refraction with direct light at their end (Whitted 1980; rough surfaces are lit by what light
 * sampling finds, which a constant environment is not); the cosine-weighted part of the sky that white opaque
 * surfaces see (AmbientOcclusion: radiance 1 means all of it); Direct by directions that are uniform over the
 * hemisphere and sample no light, slow on purpose (Hemisphere). Radiosity follows no paths: it solves L = E +
 * K L over patches of the surfaces, for small scenes of Lambertian materials without textures or punctual
 * lights, and its picture has no noise but the error of the patches. */
enum class Integrator : std::uint8_t { Path, Direct, Whitted, AmbientOcclusion, Hemisphere, Radiosity };
/** How one of many lights is chosen: by what each brings to the place (tables over space and normal, built
 * where there are more than a few lights), by power, or each with the same chance. */
enum class LightChoice : std::uint8_t { Adaptive, Power, Uniform };
/** Who decides what the path tracer's kernels work on: one kernel whose invocations follow their pixel's
 * paths to the end, or queues of paths that a kernel each takes through one scattering. Auto takes what was
 * found faster: Megakernel (docs/benchmarks.md). The picture is the same bit for bit. */
enum class Scheduler : std::uint8_t { Auto, Megakernel, Wavefront };

/** How the path tracer shows a normal that a map tilts; no light is lost either way. Folded: what the tilted
 * lobe sends under the surface is mirrored at it; fast, but not reciprocal, as plain shading normals are not.
 * Facets: the surface is made of facets along the normal and of upright mirrors between them (Schuessler et
 * al. 2017), between which light is followed: reciprocal, and slower. Materials that light goes through and
 * those with a clear coat are folded still. */
enum class NormalMapping : std::uint8_t { Folded, Facets };

/** Whether paths at rough surfaces also set out to where photons say that light comes from by way of mirrors
 * and glass, which next-event estimation cannot find. Changes noise and time, not the mean. Auto: where
 * photons of this very scene show that it pays. */
enum class Guiding : std::uint8_t { Auto, On, Off };

/** State of a running render, for progress displays. */
struct Progress {
    std::string stage;          ///< "load", "compile" (before and after set-up), "render"
    double fraction = 0;        ///< 0..1 of the samples
    std::uint32_t samples = 0;  ///< per pixel, finished
    double seconds = 0;         ///< rendering so far
    double raysPerSecond = 0;
    double relmse = -1;       ///< estimate so far; negative before there is one
    double secondsLeft = -1;  ///< negative where unknown
};

/** How the raster pipeline antialiases. */
struct Antialiasing {
    enum class Kind : std::uint8_t {
        None,
        Supersampling,  ///< every sample is shaded
        Multisampling,  ///< coverage and depth per sample, one shading per pixel and triangle; up to 16
                        ///< samples
        Fxaa,           ///< a filter of the finished picture, after Lottes
        Temporal        ///< a sample a frame, mixed into those of the frames before
    };
    Kind kind = Kind::None;
    /** Of the samples within the pixel, from its upper left corner, 0 to 1. Equal weights. Temporal: those of
     * the frames in turn. */
    std::vector<std::array<float, 2>> positions;
    /** The frames of Kind::Temporal. */
    struct Temporal {
        std::uint32_t frames = 32;       ///< drawn, the last at RenderOptions::frameTime
        double frameSeconds = 1.0 / 60;  ///< from one to the next
        double blend = 0.1;  ///< weight of a new sample in the long run; the first 1/blend weigh the same
        /** Pixels of the picture for one of a frame, each way, 1 to 4: a temporal upscaler. It is made by
         * hand, nothing is learned: samples count where they lie, see passes/temporal. */
        std::uint32_t upscale = 1;
    };
    Temporal temporal = {};
};
/** By name: none; fxaa; taa; taau2, taau3, taau4 (upscaling); msaa2, msaa4, msaa8, msaa16 (Vulkan's standard
 * positions); supersampling as ssaaN (N points of an even sequence), gridN and jitterN (N x N, at the centres
 * of its cells or anywhere in them), randomN. The seed is that of jitterN and randomN. Throws InputError. */
Antialiasing antialiasing(std::string_view name, std::uint32_t seed = 0);

/** Shadow maps of the raster pipeline's punctual lights. */
struct Shadows {
    enum class Kind : std::uint8_t {
        None,
        Hard,      ///< one texel decides
        Filtered,  ///< percentage-closer filtering over a box of 2 filterRadius texels
        Soft,      ///< percentage-closer soft shadows: penumbras of a light of lightSize
        Variance   ///< Chebyshev's bound from mean and variance over the box
    };
    Kind kind = Kind::Filtered;
    std::uint32_t resolution = 0;  ///< texels of a map each way; 0: 2048, and 1024 for a cube's faces
    float filterRadius = 1.0f;     ///< texels, up to 16
    float lightSize = 0.05f;  ///< radius in scene units; of a directional light the tangent of its half angle
};

/** How the raster pipeline filters textures over a pixel, in full floats. The first four look at the base
 * level alone. */
enum class TextureFilter : std::uint8_t {
    Nearest,
    Bilinear,
    CatmullRom,   ///< bicubic through the texels
    BSpline,      ///< bicubic, smooth
    Trilinear,    ///< over mip levels
    Anisotropic,  ///< up to 16 trilinear samples along the footprint
    Ewa,          ///< elliptical weighted average: a Gaussian over the footprint's ellipse
    Ripmap        ///< over levels halved along u and v by themselves, for footprints along the texture's axes
};

/** How the raster pipeline shades: each pixel by its material; or by Blinn and Phong's model (kd, ks and the
 * exponent are those of the material: shaders/raster/blinn_phong.glsl) at one of three rates. Textures are
 * those of the pixel at every rate; shadows and normal maps are as fine as the rate. */
enum class Shading : std::uint8_t {
    Material,
    Flat,     ///< light of a triangle's centre on its plane
    Gouraud,  ///< light of the corners, interpolated
    Phong     ///< light of the pixel, under the corners' normals interpolated
};

/** How the raster pipeline's z-buffer holds depth. The first tells apart differences of about z 2^-24 at any
 * distance z; the others, there to compare with, run from 0 at the camera's znear to 1 at its zfar (or where
 * the scene ends), beyond which nothing is told apart, and lose precision with the distance's square. */
enum class DepthFormat : std::uint8_t {
    Reversed,  ///< float32 of near / z: 1 at the near plane, 0 infinitely far
    Float,     ///< float32 of far (z - near) / (z (far - near))
    Unorm24,   ///< the same in 2^24 - 1 steps
    Unorm16    ///< the same in 65,535 steps
};

struct RenderOptions {
    std::array<std::uint32_t, 2> size = {1280, 720};  ///< pixels
    Pipeline pipeline = Pipeline::Path;
    std::uint32_t samples = 64;  ///< per pixel
    double maxError = 0;         ///< stop when the upper bound of relMSE is below; 0 never
    /** Path pipeline: more samples where the error is large, as many in all. A quarter of them, 8 to 64 per
     * pixel, are taken everywhere first; where the others go depends on a pixel's neighbours alone, so that
     * its mean stays unbiased. Not with SamplerKind::SobolBlue, which correlates neighbours, nor with 2^20
     * samples or more. */
    bool adaptive = false;
    double maxSeconds = 0;       ///< stop after so many rendering seconds; 0 never
    std::int64_t maxDepth = -1;  ///< scatterings; negative: unlimited (65,536)
    PixelFilter filter = PixelFilter::Box;
    /** From the second scattering on a path goes on with the chance min(1, roulette * throughput), that of
     * its brightest channel, and is worth the more. Changes time and noise, not the mean. */
    double roulette = 3;
    /** Above 0: the chance itself, whatever the throughput. */
    double survival = 0;
    SamplerKind sampler = SamplerKind::Sobol;
    Integrator integrator = Integrator::Path;
    /** Integrator::Radiosity: parts that the surfaces are cut into, about; up to 2048, and no fewer than
     * triangles. */
    std::uint32_t radiosityPatches = 1024;
    bool nextEventEstimation = true;
    LightChoice lights = LightChoice::Adaptive;
    AcceleratorKind accelerator = AcceleratorKind::Auto;  ///< changes the time, not the image
    Scheduler scheduler = Scheduler::Auto;                ///< of the path pipeline; the same
    NormalMapping normalMapping = NormalMapping::Folded;  ///< of the path pipeline
    Guiding guiding = Guiding::Auto;                      ///< of Integrator::Path
    std::uint32_t seed = 0;
    std::string camera;     ///< name or index; empty for the first
    double frameTime = 0;   ///< seconds; the scene is shown as posed() makes it
    std::string animation;  ///< name, index or "none"; empty for the first
    /** Seconds from frameTime on between which the shutter is open, in place of the camera's. The path
     * pipeline shows what moves meanwhile; the raster pipeline shows the pose in which it opens. */
    std::optional<std::array<double, 2>> shutter;
    /** Straight lines in which a vertex goes while the shutter is open; cameras turn smoothly. */
    std::uint32_t motionSteps = 1;
    std::optional<Environment> environment;  ///< replaces the scene's
    bool cullBackFaces = false;
    Antialiasing antialiasing;                               ///< of the raster pipeline
    Shadows shadows;                                         ///< of the raster pipeline
    TextureFilter textureFilter = TextureFilter::Trilinear;  ///< of the raster pipeline
    DepthFormat depthFormat = DepthFormat::Reversed;         ///< of the raster pipeline
    Shading shading = Shading::Material;                     ///< of the raster pipeline
    /** Raster pipeline: emissive surfaces that a pixel draws by their power, where there are over 16 times as
     * many; a picture comes out the same again. 0 takes all of them. Up to 4096. */
    std::uint32_t lightSamples = 64;
    /** Path pipeline: also a filtered picture, see RenderResult::denoised. Takes two samples per pixel at
     * least. */
    bool denoise = false;
    bool errorMap = false;  ///< path pipeline: also RenderResult::errorMap
    /** Path pipeline: also the image's light by how often it scattered, the terms E, K E, K^2 E, ... of the
     * rendering equation's series: channels bounce.0.R .. bounce.N.B for 0 to N = bounces scatterings, and
     * bounce.rest.R .. for more; where nanCount is 0 they sum to R G B. Negative: none. Up to 64, fewer for
     * large images. Not with a checkpoint. */
    std::int32_t bounces = -1;
    bool auxiliary = true;  ///< also albedo, normal, depth, variance, samples, ids
    /** Path pipeline: where the render's state is saved every `checkpointSeconds` of rendering (or more
     * rarely, so that it takes a twentieth of the time at most), when it is cancelled and when it ends;
     * empty: nowhere. */
    std::filesystem::path checkpoint = {};
    double checkpointSeconds = 10;
    /** Goes on from the checkpoint where it is there, to the bits of a render that was never stopped (one
     * with maxSeconds may take other numbers of samples). A checkpoint of another scene, device or options is
     * refused. */
    bool resume = false;
    /** Called between dispatches; return false to cancel: what is done is returned, `cancelled` set. */
    std::function<bool(const Progress&)> progress;
};

/** Rays traced, by kind. */
struct RayCounts {
    std::uint64_t camera = 0, bounce = 0, shadow = 0;
};
/** Estimated relMSE of the image, mean((x - truth)^2 / (truth^2 + 0.01)), with a 95 % interval for the error
 * of this very image, from two independently scrambled halves of the samples. Not reliable with fewer than 8
 * samples, where few pixels carry most of the error (fireflies), or where noise hides the brightness that the
 * error is relative to; with one sample a guess from neighbouring pixels. */
struct ErrorEstimate {
    double relmse = 0, low = 0, high = 0;
    bool reliable = false;
};

/** What one of the scene's meters reads: the mean over 256 times RenderOptions::samples paths, whatever
 * limits of time or error say. */
struct MeterReading {
    std::string name;  ///< the meter's
    Meter::Quantity quantity = Meter::Quantity::Irradiance;
    std::array<double, 3> value{};  ///< R G B, in the quantity's unit
    std::array<double, 3> error{};  ///< standard error of each
    /** lx, lm, cd/m^2 or cd: 683 lm/W times the luminance of R G B, the convention of renderers without
     * spectra. */
    double photometric = 0;
    std::string_view quantityName() const;     ///< "irradiance", ...
    std::string_view unit() const;             ///< "W/m^2", ...
    std::string_view photometricUnit() const;  ///< "lx", ...
};

/** What a render returns: the image and every number about it (contract: statistics). */
struct RenderResult {
    ImageF image;  ///< linear; R G B and the auxiliary channels
    ErrorEstimate error;
    double seconds = 0;  ///< rendering; set-up apart
    /** From the start of the process for its first render, else from the call, to the end of the first
     * (compiling) run of every kernel. CPU seconds are user and system time of the whole process. */
    double setupSeconds = 0, setupCpuSeconds = 0, renderCpuSeconds = 0;
    /** Per pixel, on average where sampling is adaptive; after a cancel some pixels may have more, see the
     * samples channel. */
    std::uint32_t samples = 0;
    RayCounts rays;
    std::uint64_t nanCount = 0, truncatedPaths = 0;
    std::uint64_t hostBytes = 0, deviceBytes = 0;  ///< peaks: resident set, memory handed out by the device
    struct PassTime {
        std::string name;
        double milliseconds = 0;
    };
    std::vector<PassTime> passes;
    /** Work of the raster pipeline, by name: what its stages drew and left out, for all samples. */
    std::vector<std::pair<std::string, std::uint64_t>> counters;
    std::vector<std::string> features;
    std::vector<std::pair<std::string, std::string>> skipped;  ///< what, why
    std::vector<std::string> warnings;
    /** Stops by which what is displayed is exposed: the camera's exposureStops(), 0 where it has none. */
    double exposure = 0;
    /** The picture after an edge-preserving filter, which is biased: it blurs what it takes for noise. Where
     * the two halves of the samples show that filtering would harm, a pixel stays as it was. */
    struct Denoised {
        ImageF image;  ///< R G B, and `strength`: 0 for a pixel left as it was, 1 for one that is filtered
        /** Measured by the halves: that of this image, reliable where that of the image before is and the
         * interval ends within a factor of 1.4 of the estimate. */
        ErrorEstimate error;
        double undenoised = 0;  ///< relMSE of the image before, by the same measure
        double strength = 0;  ///< mean over the pixels
    };
    std::optional<Denoised> denoised;
    /** What Integrator::Radiosity solved. */
    struct Radiosity {
        std::uint32_t patches = 0;
        std::uint32_t unknowns = 0;  ///< sides of patches that light reaches
        std::uint32_t iterations =
            0;  ///< of L <- E + K L, until nothing changed by 1e-9 of the largest source
        bool converged = true;
        /** Largest difference between the iterated solution and that by elimination, relative to the largest
         * radiance; none where there are over 1024 unknowns, which are solved by iteration alone. */
        std::optional<double> denseDifference;
    };
    std::optional<Radiosity> radiosity;
    /** The tables that guide paths to caustics, where photons were traced for them. */
    struct Caustics {
        bool guided = false;  ///< else what photons found did not pay, and paths went unguided
        std::uint64_t photons = 0;
        std::uint64_t kept = 0;   ///< of them, that came to a rough surface by way of mirrors or glass
        std::uint64_t cells = 0;  ///< of the grid over the places where they did
        std::uint64_t tables = 0, bytes = 0;
        double gain = 0;  ///< what the rule of Guiding::Auto goes by: see docs/rendering.md
        double seconds = 0, cpuSeconds = 0;  ///< of photons and tables; rendering times include them
    };
    std::optional<Caustics> caustics;
    /** Of the scene's meters, in the order of their nodes; not of those under `skipped`. */
    std::vector<MeterReading> meters;
    /** Relative standard error of each pixel, R G B: the root of its expected part in relMSE. Empty unless
     * asked for. */
    ImageF errorMap;
    bool cancelled = false;
    std::string scene, device, version;
    std::uint32_t seed = 0;
    /** The contract's statistics as JSON text. */
    std::string json() const;
};

/** What a scene asks for and the path pipeline would leave out: "WHAT", "WHY", the importer's included. Needs
 * no device. The raster pipeline leaves out more, see RenderResult::skipped. */
std::vector<std::pair<std::string, std::string>> leftOut(const Scene& scene);

/** Renders scenes on one device. Keeps what a later render can use again. */
class Renderer {
public:
    explicit Renderer(const DeviceOptions& options = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    Device& device();
    /** Renders. Throws InputError, DeviceError. What is on the device already is used again: the scene where
     * its content (found by fingerprint: geometry, placement, materials, textures, lights, environment) is
     * the last render's, whatever became of its cameras; the film where the size is. A scene in which nothing
     * gives light is lit by an environment of radiance 1, with a warning; an environment in the options
     * prevents that. The raster pipeline takes one sample at each pixel's centre and reports an error of 0
     * that is not reliable. */
    RenderResult render(const Scene& scene, const RenderOptions& options = {});
    /** How often a scene was made ready for the device: does not grow where a render found its scene there.
     */
    std::uint64_t sceneBuilds() const;
    /** Graphviz of the last render's main plan. */
    std::string graphviz() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** Saves a result's image; see saveImage. The camera's exposure adds to the display's. Metadata as the
 * contract says. */
void save(const std::filesystem::path& file, const RenderResult& result, const Display& display = {});
/** Saves the denoised image in the same way; its metadata says `denoised`. Throws InputError where there is
 * none. */
void saveDenoised(const std::filesystem::path& file, const RenderResult& result, const Display& display = {});
/** Saves the error map: as it is (.exr), or in false colours of the channels' root mean square (.png, .jpg),
 * evenly over its logarithm: black 0.001 or less, violet 0.01, orange 0.1, white 1 or more. Throws InputError
 * where there is none. */
void saveErrorMap(const std::filesystem::path& file, const RenderResult& result);

}  // namespace helio
