#include "commands.hpp"
#include "console.hpp"
#include "interrupts.hpp"
#include "output_files.hpp"

#include <heliograph/bake.hpp>
#include <heliograph/device.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

namespace helio::cli {
namespace {

struct BakeArguments {
    std::string scene, output, device = "auto", quantity = "occlusion";
    BakeOptions options;
};

int bake(BakeArguments& arguments) {
    checkImageOutput("--output", arguments.output);
    const bool irradiance = arguments.quantity == "irradiance";
    if (irradiance && !holdsEveryChannel(arguments.output))
        throw CLI::ValidationError("--output", "irradiance has no largest value: name an .exr file");
    handleInterrupts();
    arguments.options.progress = [](double) { return !interrupted(); };
    const auto begin = std::chrono::steady_clock::now();
    const Scene scene = load(arguments.scene);
    DeviceOptions options;
    options.device = arguments.device;
    Device device(options);
    ImageF image = irradiance ? bakeIrradiance(device, scene, arguments.options)
                              : bakeAmbientOcclusion(device, scene, arguments.options);
    if (image.data.empty()) {
        say("interrupted: nothing is written");
        return Interrupted;
    }
    double sum = 0, least = double(image.data.front()), most = least;
    for (const float value : image.data) {
        sum += double(value);
        least = std::min(least, double(value));
        most = std::max(most, double(value));
    }
    // What 8 bits hold of it is no colour: renderers read it as it is stored.
    if (!holdsEveryChannel(arguments.output))
        for (float& value : image.data) value = float(srgbDecode(double(value)));
    saveImage(arguments.output, image);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    printLine("wrote {}, {}x{} texels, {} {} each; {} {:.4f} to {:.4f}, mean {:.4f}; {:.2f} s",
              arguments.output, image.width, image.height, arguments.options.samples,
              irradiance ? "paths" : "rays", irradiance ? "irradiance (W/m^2)" : "ambient occlusion", least,
              most, sum / double(image.data.size()), seconds.count());
    return Done;
}

}  // namespace

void addBakeCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<BakeArguments>();
    BakeOptions& options = arguments->options;
    CLI::App* command = app.add_subcommand(
        "bake", "Ambient occlusion or irradiance of one mesh of a scene, as a texture over its coordinates");
    command->add_option("SCENE", arguments->scene, "A file or sample:NAME")->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "Where to write: .exr floats; .png 8 bits, as glTF's occlusionTexture takes them")
        ->required();
    command
        ->add_option(
            "--quantity", arguments->quantity,
            "occlusion (default), or irradiance: all light on the front, as render --lightmap takes it")
        ->check(CLI::IsMember({"occlusion", "irradiance"}));
    command->add_option("--node", options.node, "Whose mesh; default the first that has one");
    command->add_option("--texcoord", options.texcoord, "Set of texture coordinates, each place with its own")
        ->check(CLI::Range(0, 7))
        ->capture_default_str();
    command->add_option("--size", options.size, "Texels each way")
        ->check(CLI::Range(1u, 8192u))
        ->capture_default_str();
    command->add_option("--spp", options.samples, "Rays or paths a texel")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command
        ->add_option("--max-depth", options.maxDepth,
                     "Of irradiance: reflections before the light arrives; default all")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--seed", options.seed, "Of irradiance");
    command
        ->add_option("--distance", options.distance, "What is farther away hides nothing; default no limit")
        ->check(CLI::PositiveNumber);
    command->add_option("--device", arguments->device, "As for render");
    command->callback([arguments, &run] { run = [arguments] { return bake(*arguments); }; });
}

}  // namespace helio::cli
