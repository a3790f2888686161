#include "commands.hpp"
#include "console.hpp"
#include "interrupts.hpp"
#include "progress_display.hpp"
#include "render_options.hpp"

#include <heliograph/bake.hpp>
#include <heliograph/environment.hpp>
#include <heliograph/error.hpp>
#include <heliograph/features.hpp>
#include <heliograph/file.hpp>
#include <heliograph/surfaces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>

namespace helio::cli {
namespace {

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

std::string describe(const ErrorEstimate& error) {
    return error.reliable
               ? fmt::format("{:.3g} (95 % interval {:.3g} to {:.3g})", error.relmse, error.low, error.high)
               : fmt::format("{:.3g} (not reliable)", error.relmse);
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
        printLine("error    relMSE {}", describe(result.error));
        if (result.denoised) {
            printLine("denoised relMSE {}, biased; {:.3g} before by the same measure",
                      describe(result.denoised->error), result.denoised->undenoised);
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
    finishRenderArguments(command, arguments);
    RenderOptions& options = arguments.options;
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
    for (const std::string& lightmap : arguments.lightmaps) {
        const std::size_t sign = lightmap.find('=');
        setLightmap(scene, lightmap.substr(0, sign), arguments.lightmapTexcoord,
                    loadImage(lightmap.substr(sign + 1)));
    }
    if (arguments.hasEnvironmentImage) {
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

}  // namespace

void addRenderCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand("render", "Render a scene");
    addRenderOptions(*command, *arguments);
    command->callback(
        [arguments, command, &run] { run = [arguments, command] { return render(*command, *arguments); }; });
}

}  // namespace helio::cli
