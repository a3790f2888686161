#include "commands.hpp"
#include "console.hpp"
#include "interrupts.hpp"
#include "output_files.hpp"
#include "progress_display.hpp"

#include <heliograph/environment.hpp>
#include <heliograph/error.hpp>
#include <heliograph/features.hpp>
#include <heliograph/file.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/surfaces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>

namespace helio::cli {
namespace {

/** Where vertex normals come from. */
enum class Normals { File, Flat, Equal, Area, Angle };

struct RenderArguments {
    std::string scene;
    std::vector<std::string> outputs;
    std::string size = "1280x720";
    std::string environment, environmentMap;
    std::string stats, graph, errorMap;
    std::string device = "auto";
    std::string antialiasing;
    std::uint32_t frames = 32;
    double frameRate = 60;
    std::string shutter;
    Display display;
    Normals normals = Normals::File;
    std::uint32_t displacement = 0;
    bool noNextEvent = false, validate = false, quiet = false;
    LoadOptions load;
    RenderOptions options;
};

/** Parses the whole text as a number, or throws the usage error. */
template <typename T>
T parseNumber(std::string_view text, const std::string& option, const std::string& expected) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, expected));
    }
    return value;
}

std::array<std::uint32_t, 2> parseSize(const std::string& text) {
    const std::size_t cross = text.find('x');
    const std::string expected = "a size such as 1280x720";
    if (cross == std::string::npos) throw CLI::ValidationError("--size", "'" + text + "' is not " + expected);
    const std::string_view view(text);
    const std::array<std::uint32_t, 2> size = {
        parseNumber<std::uint32_t>(view.substr(0, cross), "--size", expected),
        parseNumber<std::uint32_t>(view.substr(cross + 1), "--size", expected)};
    if (size[0] == 0 || size[1] == 0 || std::uint64_t(size[0]) * size[1] > 1u << 28) {
        throw CLI::ValidationError("--size", "'" + text + "' is outside 1x1 to 2^28 pixels");
    }
    return size;
}

/** Whether the text reads as R,G,B, right or wrong, and not as the name of a file. */
bool isRadiance(const std::string& text) {
    return text.find_first_not_of("0123456789+-.,eE") == std::string::npos ||
           (text.find(',') != std::string::npos && !std::filesystem::exists(text));
}

/** OPEN,CLOSE in seconds. */
std::array<double, 2> parseShutter(const std::string& text) {
    const std::size_t comma = text.find(',');
    const std::string expected = "OPEN,CLOSE in seconds, such as 0,0.02";
    if (comma == std::string::npos)
        throw CLI::ValidationError("--shutter", "'" + text + "' is not " + expected);
    const std::string_view view(text);
    const std::array<double, 2> times = {parseNumber<double>(view.substr(0, comma), "--shutter", expected),
                                         parseNumber<double>(view.substr(comma + 1), "--shutter", expected)};
    if (!(times[0] <= times[1]) || !(std::abs(times[0]) <= 1e6 && std::abs(times[1]) <= 1e6)) {
        throw CLI::ValidationError("--shutter", "'" + text + "' closes before it opens");
    }
    return times;
}

/** R,G,B: a constant radiance. */
Environment parseRadiance(const std::string& text) {
    Environment environment;
    std::string_view rest(text);
    for (int channel = 0; channel < 3; ++channel) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (channel == 2)) {
            throw CLI::ValidationError("--environment", "'" + text + "' is neither R,G,B nor a file");
        }
        const float value =
            parseNumber<float>(rest.substr(0, comma), "--environment", "a radiance of R,G,B or a file");
        if (!(value >= 0) || value > 1e30f) {
            throw CLI::ValidationError("--environment", "'" + text + "' is not a radiance of 0 to 1e30");
        }
        environment.radiance[channel] = value;
        rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return environment;
}

/** What the scene asked for and was not done, a line each; what it did not ask for, in one line. */
void printSkipped(const Scene& scene, const RenderResult& result) {
    const std::vector<SceneFeatures::Absent> absent = SceneFeatures(scene).absent();
    std::string unneeded;
    for (const auto& [what, why] : result.skipped) {
        const bool notAsked =
            std::any_of(absent.begin(), absent.end(),
                        [&name = what](const SceneFeatures::Absent& a) { return a.name == name; });
        if (notAsked) {
            unneeded += (unneeded.empty() ? "" : ", ") + what;
        } else {
            printLine("left out {}: {}", what, why);
        }
    }
    if (!unneeded.empty()) printLine("unneeded {}", unneeded);
}

void printSummary(const RenderArguments& arguments, const Scene& scene, const RenderResult& result) {
    if (arguments.outputs.empty()) printLine("no -o FILE was given: no image was written");
    printLine("device   {}", result.device);
    printLine("time     {:.3f} s rendering, {:.3f} s set-up", result.seconds, result.setupSeconds);
    printLine("samples  {} per pixel, {}x{} pixels", result.samples, result.image.width, result.image.height);
    if (arguments.options.pipeline == Pipeline::Path) {
        const RayCounts& rays = result.rays;
        const double total = double(rays.camera + rays.bounce + rays.shadow);
        printLine("rays     {:.3g} M, {:.2f} M/s", total * 1e-6,
                  result.seconds > 0 ? total * 1e-6 / result.seconds : 0.0);
        const ErrorEstimate& error = result.error;
        printLine("error    relMSE {}", error.reliable
                                            ? fmt::format("{:.3g} (95 % interval {:.3g} to {:.3g})",
                                                          error.relmse, error.low, error.high)
                                            : fmt::format("{:.3g} (not reliable)", error.relmse));
        if (result.denoised) {
            printLine("denoised relMSE {:.3g}, {:.3g} before (biased; measured by halves)",
                      result.denoised->relmse, result.denoised->undenoised);
        }
        if (result.radiosity) {
            const RenderResult::Radiosity& radiosity = *result.radiosity;
            printLine("patches  {}, {} sides lit, {} iterations{}", radiosity.patches, radiosity.unknowns,
                      radiosity.iterations,
                      radiosity.denseDifference
                          ? fmt::format(", {:.2g} from the dense solution", *radiosity.denseDifference)
                          : "");
        }
        for (const MeterReading& meter : result.meters) {
            const auto& [r, g, b] = meter.value;
            printLine("meter    {}: {} {:.6g} {:.6g} {:.6g} {} (+- {:.2g}), {:.4g} {}", meter.name,
                      meter.quantityName(), r, g, b, meter.unit(), *std::ranges::max_element(meter.error),
                      meter.photometric, meter.photometricUnit());
        }
    } else {
        printLine("error    not measured");
    }
    printSkipped(scene, result);
}

/** Refuses options that the chosen pipeline would leave without effect on the picture. */
void checkPipelineOptions(const CLI::App& command, const RenderOptions& options) {
    if (options.pipeline == Pipeline::Path) {
        for (const char* option : {"--shadows", "--shadow-resolution", "--light-size", "--texture-filter",
                                   "--light-samples", "--depth", "--shading", "--frames", "--frame-rate"}) {
            if (command.count(option) > 0) {
                throw CLI::ValidationError(option, "is there for --pipeline raster only");
            }
        }
        if (command.count("--aa") > 0) {
            throw CLI::ValidationError("--aa",
                                       "is there for --pipeline raster only; paths have --spp and --filter");
        }
        if (options.adaptive && options.sampler == SamplerKind::SobolBlue) {
            throw CLI::ValidationError("--adaptive", "needs a sampler that does not correlate neighbours");
        }
        if (options.integrator == Integrator::Radiosity) {
            for (const char* option :
                 {"--max-depth", "--lights", "--no-nee", "--bounces", "--roulette", "--survival"})
                if (command.count(option) > 0)
                    throw CLI::ValidationError(option, "is there for integrators that follow paths");
        } else if (command.count("--patches") > 0) {
            throw CLI::ValidationError("--patches", "is there for --integrator radiosity only");
        }
        const bool isLocal = options.integrator == Integrator::AmbientOcclusion ||
                             options.integrator == Integrator::Hemisphere;
        if (isLocal && command.count("--lights") > 0) {
            throw CLI::ValidationError("--lights", "is there for integrators that choose among lights");
        }
        if (options.integrator == Integrator::AmbientOcclusion && command.count("--environment") > 0) {
            throw CLI::ValidationError("--environment", "has no effect on --integrator ao; leave it out");
        }
        if (options.integrator == Integrator::Whitted && !options.nextEventEstimation) {
            throw CLI::ValidationError("--no-nee", "leaves --integrator whitted without direct light");
        }
        if (options.bounces >= 0 && !options.checkpoint.empty()) {
            throw CLI::ValidationError("--bounces", "is not kept by a --checkpoint; leave one of them out");
        }
        if (options.cullBackFaces) {
            throw CLI::ValidationError("--cull", "back is there for --pipeline raster only, so far");
        }
        return;
    }
    if (command.count("--light-size") > 0 && options.shadows.kind != Shadows::Kind::Soft) {
        throw CLI::ValidationError("--light-size", "is there for --shadows pcss only");
    }
    if (command.count("--shadow-resolution") > 0 && options.shadows.kind == Shadows::Kind::None) {
        throw CLI::ValidationError("--shadow-resolution", "has no effect on --shadows none; leave it out");
    }
    // --spp and --seed stay: scripts give them to every pipeline, and the samples are reported as left out.
    for (const char* option :
         {"--time", "--max-error", "--adaptive", "--denoise", "--error-map", "--max-depth", "--filter",
          "--sampler", "--integrator", "--patches", "--roulette", "--survival", "--lights", "--no-nee",
          "--accelerator", "--bounces", "--checkpoint", "--resume"}) {
        if (command.count(option) > 0) {
            throw CLI::ValidationError(
                option,
                "is there for --pipeline path only, the raster pipeline takes one sample at each "
                "pixel's centre and shades direct light; leave it out");
        }
    }
}

/** Refuses what PNG and JPEG images alone go by where there is none. */
void checkDisplayOptions(const CLI::App& command, const std::vector<std::string>& outputs) {
    if (std::ranges::any_of(outputs, [](const std::string& file) { return !holdsEveryChannel(file); }))
        return;
    for (const char* option : {"--tonemap", "--exposure"}) {
        if (command.count(option) > 0) {
            throw CLI::ValidationError(option,
                                       "has no effect: an EXR image holds linear light as it is; "
                                       "name a .png or .jpg with -o");
        }
    }
}

/** Writes every file that can be written and says which; throws the first failure after the last. */
class OutputWriter {
public:
    template <typename Write>
    void write(const std::string& file, bool isQuiet, const Write& write) {
        try {
            write();
            if (!isQuiet) printLine("wrote {}", file);
        } catch (const Error& error) {
            if (failure_) {
                say("warning: {}", error.what());
            } else {
                failure_ = std::current_exception();
            }
        }
    }
    void throwFailure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::exception_ptr failure_;
};

/** NAME.EXT to NAME.denoised.EXT. */
std::string denoisedName(const std::filesystem::path& file) {
    return (file.parent_path() / (file.stem().string() + ".denoised" + file.extension().string())).string();
}

int reportNothingWritten() {
    say("interrupted before the first sample: nothing was written");
    return Interrupted;
}

void reportValidation(Renderer& renderer) {
    const std::vector<std::string> messages = renderer.device().validationMessages();
    for (const std::string& message : messages) say("validation: {}", message);
    if (!messages.empty()) throw DeviceError(fmt::format("validation reported {} messages", messages.size()));
}

void chooseNormals(Scene& scene, Normals normals) {
    switch (normals) {
        case Normals::File:
            return;
        case Normals::Flat:
            return flatNormals(scene);
        case Normals::Equal:
            return smoothNormals(scene, NormalWeight::Equal);
        case Normals::Area:
            return smoothNormals(scene, NormalWeight::Area);
        case Normals::Angle:
            return smoothNormals(scene, NormalWeight::Angle);
    }
}

int render(const CLI::App& command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    options.size = parseSize(arguments.size);
    options.nextEventEstimation = !arguments.noNextEvent;
    if (!arguments.shutter.empty()) options.shutter = parseShutter(arguments.shutter);
    const bool image = !arguments.environment.empty() && !isRadiance(arguments.environment);
    if (!arguments.environmentMap.empty() && !image)
        throw CLI::ValidationError("--environment-map", "says what the image of --environment is; name one");
    if (!arguments.environment.empty() && !image) options.environment = parseRadiance(arguments.environment);
    checkPipelineOptions(command, options);
    if (!arguments.antialiasing.empty()) {
        try {
            options.antialiasing = antialiasing(arguments.antialiasing, options.seed);
        } catch (const InputError& error) {
            throw CLI::ValidationError("--aa", error.what());
        }
    }
    if (options.antialiasing.kind == Antialiasing::Kind::Temporal) {
        options.antialiasing.temporal.frames = arguments.frames;
        options.antialiasing.temporal.frameSeconds = 1 / arguments.frameRate;
    } else {
        for (const char* option : {"--frames", "--frame-rate"})
            if (command.count(option) > 0)
                throw CLI::ValidationError(option, "is there for --aa taa and taauN, which mix frames");
    }
    for (const std::string& output : arguments.outputs) checkImageOutput("--output", output);
    if (!arguments.errorMap.empty()) checkImageOutput("--error-map", arguments.errorMap);
    options.errorMap = !arguments.errorMap.empty();
    if (options.denoise && options.samples < 2)
        throw CLI::ValidationError("--denoise", "needs two samples per pixel at least");
    if (options.denoise && arguments.outputs.empty())
        throw CLI::ValidationError("--denoise", "has no effect without an image; name one with -o");
    checkDisplayOptions(command, arguments.outputs);
    for (const std::string& output : {arguments.stats, arguments.graph}) {
        if (!output.empty()) checkTextOutput(output);
    }
    if (!options.checkpoint.empty()) checkTextOutput(options.checkpoint.string());

    // Only EXR files hold more than the picture: without one, the pass of first hits is not even compiled.
    options.auxiliary = std::ranges::any_of(arguments.outputs, holdsEveryChannel);
    if (options.bounces >= 0 && !options.auxiliary)
        throw CLI::ValidationError("--bounces",
                                   "has no effect without an image that holds it; name a .exr with -o");

    handleInterrupts();
    ProgressDisplay display(arguments.quiet);
    options.progress = [&](const Progress& progress) {
        display.update(progress);
        return !interrupted();
    };

    std::optional<Scene> loaded = loadShowingProgress(arguments.scene, display, arguments.load);
    if (!loaded || interrupted()) return reportNothingWritten();
    Scene& scene = *loaded;
    chooseNormals(scene, arguments.normals);
    if (arguments.displacement > 0) displace(scene, arguments.displacement);
    if (image) {
        options.environment = Environment{.radiance = glm::vec3(1.0f), .image = int(scene.images.size())};
        scene.images.push_back(loadTextureImage(arguments.environment));
        if (!arguments.environmentMap.empty() && arguments.environmentMap != "latlong")
            scene.images.back() =
                EnvironmentImage(scene.images.back(), *environmentMapping(arguments.environmentMap))
                    .convert(EnvironmentMapping::LatLong);
    }
    DeviceOptions device;
    device.device = arguments.device;
    device.validation = arguments.validate;
    Renderer renderer(device);
    const RenderResult result = renderer.render(scene, options);
    display.finish();
    for (const std::string& warning : result.warnings) say("warning: {}", warning);
    if (result.samples == 0 && result.cancelled) return reportNothingWritten();

    OutputWriter writer;
    for (const std::string& output : arguments.outputs) {
        writer.write(output, arguments.quiet, [&] { save(output, result, arguments.display); });
    }
    if (result.denoised) {
        for (const std::string& output : arguments.outputs) {
            const std::string file = denoisedName(output);
            writer.write(file, arguments.quiet, [&] { saveDenoised(file, result, arguments.display); });
        }
    }
    if (!arguments.errorMap.empty()) {
        writer.write(arguments.errorMap, arguments.quiet, [&] { saveErrorMap(arguments.errorMap, result); });
    }
    if (!arguments.stats.empty()) {
        writer.write(arguments.stats, true, [&] { writeTextFile(arguments.stats, result.json() + "\n"); });
    }
    if (!arguments.graph.empty()) {
        writer.write(arguments.graph, true, [&] { writeTextFile(arguments.graph, renderer.graphviz()); });
    }
    if (!arguments.quiet) printSummary(arguments, scene, result);
    writer.throwFailure();
    if (arguments.validate) reportValidation(renderer);
    return result.cancelled && interrupted() ? Interrupted : Done;
}

template <typename Enum>
CLI::Option* addChoice(CLI::App* command, const std::string& name, Enum& value,
                       const std::vector<std::pair<std::string, Enum>>& choices, const std::string& help) {
    return command->add_option_function<std::string>(
        name,
        [&value, choices, name](const std::string& text) {
            std::string known;
            for (const auto& [key, choice] : choices) {
                if (key == text) {
                    value = choice;
                    return;
                }
                known += (known.empty() ? "" : ", ") + key;
            }
            throw CLI::ValidationError(name, "'" + text + "' is not one of " + known);
        },
        help);
}

}  // namespace

void addRenderCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<RenderArguments>();
    RenderOptions& options = arguments->options;
    CLI::App* command = app.add_subcommand("render", "Render a scene");
    command
        ->add_option("SCENE", arguments->scene,
                     "A .gltf, .glb, .obj, .ply or .stl file, or sample:NAME (see heliograph info)")
        ->required();
    command
        ->add_option("-o,--output", arguments->outputs,
                     "Image to write, may be repeated: .exr linear with every channel, .png or .jpg sRGB")
        ->allow_extra_args(false);
    addChoice<Pipeline>(command, "--pipeline", options.pipeline,
                        {{"path", Pipeline::Path}, {"raster", Pipeline::Raster}},
                        "path (default): unbiased path tracing; raster: z-buffer, direct light, shadow maps");
    command->add_option("--size", arguments->size, "Pixels, WxH; the vertical field of view is kept")
        ->capture_default_str();
    command->add_option("--camera", options.camera, "Name or index of the camera; default the first");
    command->add_option("--variant", arguments->load.variant,
                        "Name of the material variant to show (KHR_materials_variants)");
    command
        ->add_option("--frame-time", options.frameTime,
                     "Seconds at which animations, skins and morph targets are evaluated")
        ->check(CLI::Number)
        ->capture_default_str();
    command->add_option("--shutter", arguments->shutter,
                        "OPEN,CLOSE in seconds from --frame-time on: what moves meanwhile is blurred (path)");
    command
        ->add_option("--motion-steps", options.motionSteps,
                     "Straight lines in which vertices go while the shutter is open")
        ->check(CLI::Range(1u, 64u))
        ->capture_default_str();
    command->add_option("--animation", options.animation,
                        "Name or index of the animation; default the first; none for the pose of the nodes");
    command->add_option("--environment", arguments->environment,
                        "R,G,B: constant radiance from everywhere; or a lat-long image file, +Y up");
    command
        ->add_option(
            "--environment-map", arguments->environmentMap,
            "What the environment's image is: latlong (default), cube, sphere; see convert-environment")
        ->check(CLI::IsMember({"latlong", "cube", "sphere"}));
    command->add_option("--spp", options.samples, "Samples per pixel")
        ->check(CLI::Range(1u, (1u << 24) - 1))
        ->capture_default_str();
    command->add_flag("--adaptive", options.adaptive,
                      "Take more of the samples where the error is large, --spp on average; the mean stays "
                      "unbiased");
    command->add_option("--time", options.maxSeconds, "Stop after so many seconds of rendering")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--max-error", options.maxError, "Stop when the upper bound of the relMSE is below this")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--max-depth", options.maxDepth,
                     "Scatterings at most: 0 emission only, 1 direct light; default unlimited (65536)")
        ->check(CLI::Range(0, 65536));
    addChoice<PixelFilter>(command, "--filter", options.filter,
                           {{"box", PixelFilter::Box},
                            {"tent", PixelFilter::Tent},
                            {"gaussian", PixelFilter::Gaussian},
                            {"blackman-harris", PixelFilter::BlackmanHarris}},
                           "Pixel filter: box (default), tent, gaussian, blackman-harris");
    addChoice<Integrator>(
        command, "--integrator", options.integrator,
        {{"path", Integrator::Path},
         {"direct", Integrator::Direct},
         {"whitted", Integrator::Whitted},
         {"ao", Integrator::AmbientOcclusion},
         {"hemisphere", Integrator::Hemisphere},
         {"radiosity", Integrator::Radiosity}},
        "path (default): all of light's ways; direct: one scattering; whitted: mirrors, then "
        "direct light; ao: ambient occlusion; hemisphere: direct light by uniform directions; radiosity: all "
        "of diffuse light, solved over patches");
    command
        ->add_option("--patches", options.radiosityPatches,
                     "Parts that --integrator radiosity cuts the surfaces into, about")
        ->check(CLI::Range(1u, 2048u))
        ->capture_default_str();
    addChoice<SamplerKind>(
        command, "--sampler", options.sampler,
        {{"sobol", SamplerKind::Sobol},
         {"sobol-blue", SamplerKind::SobolBlue},
         {"halton", SamplerKind::Halton},
         {"stratified", SamplerKind::Stratified},
         {"independent", SamplerKind::Independent}},
        "sobol (default): Owen-scrambled; sobol-blue: error as blue noise over the screen; "
        "halton; stratified; independent");
    addChoice<LightChoice>(command, "--lights", options.lights,
                           {{"adaptive", LightChoice::Adaptive},
                            {"power", LightChoice::Power},
                            {"uniform", LightChoice::Uniform}},
                           "Choice among lights: adaptive (default) by place and normal; power; uniform");
    command
        ->add_option("--roulette", options.roulette,
                     "Paths go on with the chance min(1, this times their throughput), default 3")
        ->check(CLI::Range(1e-3, 1e30));
    command->add_option("--survival", options.survival, "That chance itself, whatever the throughput")
        ->check(CLI::Range(1e-3, 1.0))
        ->excludes("--roulette");
    command->add_flag("--no-nee", arguments->noNextEvent, "Trace without next-event estimation");
    addChoice<AcceleratorKind>(
        command, "--accelerator", options.accelerator,
        {{"auto", AcceleratorKind::Auto},
         {"bvh", AcceleratorKind::Bvh},
         {"brute-force", AcceleratorKind::BruteForce},
         {"grid", AcceleratorKind::Grid},
         {"octree", AcceleratorKind::Octree},
         {"kd-tree", AcceleratorKind::KdTree},
         {"bsp", AcceleratorKind::Bsp}},
        "auto (default); bvh, brute-force, grid, octree, kd-tree, bsp: same image, other times");
    addChoice<bool>(command, "--cull", options.cullBackFaces, {{"none", false}, {"back", true}},
                    "none (default) or back: faces the raster pipeline leaves out");
    command->add_option(
        "--aa", arguments->antialiasing,
        "Antialiasing of the raster pipeline: none (default), fxaa, msaa2, msaa4, msaa8, msaa16; "
        "each sample shaded: ssaaN, gridN, jitterN (N x N), randomN; or a sample a frame, mixed over "
        "--frames: taa, and taau2, taau3, taau4 from frames of 1/2, 1/3, 1/4 the size each way");
    command
        ->add_option("--frames", arguments->frames,
                     "Frames that --aa taa draws; the picture is the last, at --frame-time")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command->add_option("--frame-rate", arguments->frameRate, "Of those frames, a second")
        ->check(CLI::Range(1e-6, 1e6))
        ->capture_default_str();
    addChoice<TextureFilter>(
        command, "--texture-filter", options.textureFilter,
        {{"nearest", TextureFilter::Nearest},
         {"bilinear", TextureFilter::Bilinear},
         {"bicubic", TextureFilter::CatmullRom},
         {"bspline", TextureFilter::BSpline},
         {"trilinear", TextureFilter::Trilinear},
         {"anisotropic", TextureFilter::Anisotropic},
         {"ewa", TextureFilter::Ewa}},
        "Of the raster pipeline: nearest, bilinear, bicubic, bspline, trilinear (default), "
        "anisotropic, ewa");
    addChoice<DepthFormat>(command, "--depth", options.depthFormat,
                           {{"reversed", DepthFormat::Reversed},
                            {"float", DepthFormat::Float},
                            {"unorm24", DepthFormat::Unorm24},
                            {"unorm16", DepthFormat::Unorm16}},
                           "Depth of the raster pipeline: reversed (default, float32 without a far plane); "
                           "to compare, over the camera's znear to zfar: float, unorm24, unorm16");
    addChoice<Shading>(
        command, "--shading", options.shading,
        {{"material", Shading::Material},
         {"flat", Shading::Flat},
         {"gouraud", Shading::Gouraud},
         {"phong", Shading::Phong}},
        "Of the raster pipeline: material (default), each pixel by its material; flat, gouraud "
        "or phong: Blinn and Phong's model once for each triangle, corner or pixel");
    addChoice<Normals>(command, "--normals", arguments->normals,
                       {{"file", Normals::File},
                        {"flat", Normals::Flat},
                        {"equal", Normals::Equal},
                        {"area", Normals::Area},
                        {"angle", Normals::Angle}},
                       "file (default): the scene's own; flat: none; or the mean of those of the triangles "
                       "around, equal, by area or by angle");
    command
        ->add_option(
            "--displace", arguments->displacement,
            "Cut each triangle that has a map of heights into N x N and move the corners by it; without "
            "this the map tilts normals")
        ->check(CLI::Range(1u, 1024u));
    command
        ->add_option("--light-samples", options.lightSamples,
                     "Emissive surfaces that a pixel of the raster pipeline draws where there are over 16 "
                     "times as many; "
                     "default 64, 0: all")
        ->check(CLI::Range(0u, 4096u));
    addChoice<Shadows::Kind>(
        command, "--shadows", options.shadows.kind,
        {{"none", Shadows::Kind::None},
         {"hard", Shadows::Kind::Hard},
         {"pcf", Shadows::Kind::Filtered},
         {"pcss", Shadows::Kind::Soft},
         {"variance", Shadows::Kind::Variance}},
        "Shadow maps of the raster pipeline's punctual lights: none, hard, pcf (default), pcss "
        "(of lights of --light-size), variance");
    command
        ->add_option("--shadow-resolution", options.shadows.resolution,
                     "Texels of a shadow map each way; default 2048, 1024 for faces of a point light's cube")
        ->check(CLI::Range(16u, 4096u));
    command
        ->add_option(
            "--light-size", options.shadows.lightSize,
            "Radius of punctual lights for pcss; of directional ones the tangent of their half angle")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command
        ->add_option(
            "--bounces", options.bounces,
            "Also write the light that scattered 0, 1, ... N times and more often, apart, into .exr images")
        ->check(CLI::Range(0, 64));
    command->add_flag("--denoise", options.denoise,
                      "Also write each image filtered, as NAME.denoised.EXT: smoother, and biased");
    command->add_option(
        "--error-map", arguments->errorMap,
        "Image of each pixel's relative standard error: .exr as numbers, .png or .jpg in colours");
    addChoice<ToneCurve>(command, "--tonemap", arguments->display.curve,
                         {{"none", ToneCurve::None},
                          {"reinhard", ToneCurve::Reinhard},
                          {"filmic", ToneCurve::Filmic},
                          {"aces", ToneCurve::Aces}},
                         "Tone curve of PNG and JPEG images: none (default), reinhard, filmic, aces");
    command
        ->add_option("--exposure", arguments->display.exposure,
                     "Stops by which PNG and JPEG images are brighter, on top of the camera's own exposure")
        ->check(CLI::Range(-100.0, 100.0))
        ->capture_default_str();
    command->add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
    command
        ->add_option("--device", arguments->device, "auto, an index or part of a name from heliograph info")
        ->capture_default_str();
    command->add_option(
        "--checkpoint", options.checkpoint,
        "File in which the render's state is saved now and then, on interruption and at the end");
    command->add_flag("--resume", options.resume, "Go on from the --checkpoint file where it is there")
        ->needs("--checkpoint");
    command->add_option("--stats", arguments->stats, "Write the statistics as JSON");
    command->add_option("--graph", arguments->graph, "Write the render graph for Graphviz");
    command->add_flag("--validate", arguments->validate,
                      "Run under Vulkan validation; a message is a failure");
    command->add_flag("--quiet", arguments->quiet, "Print only warnings and errors");
    command->callback(
        [arguments, command, &run] { run = [arguments, command] { return render(*command, *arguments); }; });
}

}  // namespace helio::cli
