#include "commands.hpp"
#include "console.hpp"
#include "output_files.hpp"

#include <heliograph/environment.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>

namespace helio::cli {
namespace {

struct ConvertArguments {
    std::string input, output, from, to;
    std::uint32_t size = 0;
};

int convert(const ConvertArguments& arguments) {
    checkImageOutput("--output", arguments.output);
    const TextureImage source = loadTextureImage(arguments.input);
    const EnvironmentMapping from = arguments.from.empty()
                                        ? likelyEnvironmentMapping(source.width, source.height)
                                        : *environmentMapping(arguments.from);
    const EnvironmentImage environment(source, from);
    const TextureImage result = environment.convert(*environmentMapping(arguments.to), arguments.size);
    ImageF image{result.width, result.height, {"R", "G", "B"}, {}, {}};
    const auto& texels = std::get<std::vector<float>>(result.texels);
    image.data.reserve(texels.size() / 4 * 3);
    for (std::size_t i = 0; i < texels.size(); i += 4)
        image.data.insert(image.data.end(), texels.begin() + std::ptrdiff_t(i),
                          texels.begin() + std::ptrdiff_t(i) + 3);
    saveImage(arguments.output, image);
    const EnvironmentImage written(result, *environmentMapping(arguments.to));
    const glm::dvec3 before = environment.mean(), after = written.mean();
    printLine("wrote {}, {}x{}; mean radiance {:.5g} {:.5g} {:.5g}, of {} {:.5g} {:.5g} {:.5g}",
              arguments.output, image.width, image.height, after.x, after.y, after.z, arguments.input,
              before.x, before.y, before.z);
    return Done;
}

}  // namespace

void addConvertEnvironmentCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<ConvertArguments>();
    CLI::App* command = app.add_subcommand(
        "convert-environment", "Turn an image of the surroundings into another mapping of the sphere");
    command->add_option("IMAGE", arguments->input, "An image of the surroundings, +Y up")->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "Where to write: .exr linear floats; .png or .jpg 8 bits, sRGB-encoded")
        ->required();
    command
        ->add_option(
            "--from", arguments->from,
            "latlong, cube (six faces from the top: +X, -X, +Y, -Y, +Z, -Z) or sphere (a mirrored ball); "
            "default by the image's shape, latlong unless 1:6 or square")
        ->check(CLI::IsMember({"latlong", "cube", "sphere"}));
    command->add_option("--to", arguments->to, "latlong, cube or sphere")
        ->required()
        ->check(CLI::IsMember({"latlong", "cube", "sphere"}));
    command
        ->add_option(
            "--size", arguments->size,
            "Width of the lat-long image, a face or the ball; default about as many texels as there are")
        ->check(CLI::Range(1u, 16384u));
    command->callback([arguments, &run] { run = [arguments] { return convert(*arguments); }; });
}

}  // namespace helio::cli
