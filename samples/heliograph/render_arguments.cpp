#include "output_files.hpp"
#include "render_options.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace helio::cli {
namespace {

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

/** Refuses options that the chosen pipeline would leave without effect on the picture. */
void checkPipelineOptions(const CLI::App& command, const RenderOptions& options) {
    if (options.pipeline == Pipeline::Path) {
        for (const char* option :
             {"--shadows", "--shadow-resolution", "--light-size", "--texture-filter", "--light-samples",
              "--depth", "--shading", "--frames", "--frame-rate", "--lightmap", "--lightmap-texcoord"}) {
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
        if (options.normalMapping == NormalMapping::Facets && isLocal) {
            throw CLI::ValidationError("--normal-mapping",
                                       "facets is there for integrators that follow light");
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
         {"--time",    "--max-error",  "--adaptive",       "--denoise",     "--error-map", "--max-depth",
          "--filter",  "--sampler",    "--integrator",     "--patches",     "--roulette",  "--survival",
          "--lights",  "--no-nee",     "--normal-mapping", "--accelerator", "--scheduler", "--guiding",
          "--bounces", "--checkpoint", "--resume"}) {
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

/** Refuses files that could not be written, and what has no effect on those that are; sets what they need. */
void prepareOutputs(const CLI::App& command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
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
}

}  // namespace

void finishRenderArguments(const CLI::App& command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    options.size = parseSize(arguments.size);
    options.nextEventEstimation = !arguments.noNextEvent;
    if (!arguments.shutter.empty()) options.shutter = parseShutter(arguments.shutter);
    arguments.hasEnvironmentImage = !arguments.environment.empty() && !isRadiance(arguments.environment);
    const bool image = arguments.hasEnvironmentImage;
    if (!arguments.environmentMap.empty() && !image)
        throw CLI::ValidationError("--environment-map", "says what the image of --environment is; name one");
    if (!arguments.environment.empty() && !image) options.environment = parseRadiance(arguments.environment);
    checkPipelineOptions(command, options);
    for (const std::string& lightmap : arguments.lightmaps)
        if (lightmap.find('=') == std::string::npos)
            throw CLI::ValidationError("--lightmap", "'" + lightmap + "' is not NODE=FILE");
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
    prepareOutputs(command, arguments);
}

}  // namespace helio::cli
