// Long experiments on the error estimate; see --help.
#include "samples/heliograph/bench/bench_scenes.hpp"
#include "tests/bench/error/coverage.hpp"
#include "tests/bench/error/table.hpp"
#include "tests/support/error_scenes.hpp"

#include <heliograph/device.hpp>
#include <heliograph/scene.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace {

helio::Scene sceneOf(const std::string& name) {
    const bool isBench = name == "furnace" || name == "irradiance";
    return isBench ? helio::cli::benchScene(name) : helio::test::errorScene(name);
}

int coverage(const std::vector<std::string>& scenes, const helio::test::CoverageOptions& options) {
    helio::Device device;
    fmt::print("{}x{}, {} samples, {} seeds\n", options.size, options.size, options.samples, options.seeds);
    fmt::print(
        "| scene | true relMSE | estimate / true | in the interval | above it | below it | reliable | "
        "in it where reliable | high / low | offset | spread |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& scene : scenes) {
        const helio::test::Coverage c = helio::test::measureCoverage(device, sceneOf(scene), scene, options);
        const double percent = 100.0 / c.seeds;
        fmt::print(
            "| {} | {:.3g} | {:.4f} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} % | {:.3f} | {:.2f} "
            "| {:.2f} "
            "|\n",
            scene, c.truth, c.estimate / c.truth, c.covered * percent, c.above * percent, c.below * percent,
            c.reliable * percent, 100.0 * c.coveredReliable / std::max(1u, c.reliable), std::exp(c.width),
            c.offset, c.spread);
        std::fflush(stdout);
    }
    return 0;
}

int table(const std::vector<std::string>& scenes, const helio::test::TableOptions& options) {
    helio::Device device;
    fmt::print("{}x{}, mean of {} seeds\n", options.size, options.size, options.seeds);
    fmt::print(
        "| scene | samples | plain | adaptive / plain | denoised / plain | at worst | plain measured / true "
        "| "
        "denoised measured / true | reliable | in its interval | farthest from the truth |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    const std::vector<std::uint32_t> samples = {4, 8, 16, 64};
    for (const std::string& scene : scenes) {
        const auto rows = helio::test::measureRows(device, sceneOf(scene), samples, options);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const helio::test::TableRow& row = rows[i];
            fmt::print(
                "| {} | {} | {:.3g} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {} of {} | {} | {:.2f} "
                "|\n",
                scene, samples[i], row.plain, row.adaptive / row.plain, row.denoised / row.plain, row.worst,
                row.plainMeasured / row.plain, row.denoisedMeasured / row.denoised, row.reliable,
                options.seeds, row.held, row.farthest);
        }
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app("Experiments on the error estimate");
    app.require_subcommand(1);
    helio::test::CoverageOptions options;
    std::vector<std::string> scenes = {"cornell", "plates", "room", "spheres"};
    CLI::App* command =
        app.add_subcommand("coverage", "How often the 95 % interval of the relMSE holds the true one");
    command
        ->add_option(
            "scenes", scenes,
            "Samples, furnace, irradiance, room, spheres, or those of tests/support/held_out_scenes.hpp")
        ->capture_default_str();
    command->add_option("--seeds", options.seeds)->capture_default_str();
    command->add_option("--spp", options.samples)->capture_default_str();
    command->add_option("--size", options.size)->capture_default_str();
    command->add_option("--keep", options.keep, "Folder in which the films are kept");
    command->add_option("--judge", options.judge, "Folder of kept films to judge, in place of rendering");
    helio::test::TableOptions tableOptions;
    std::vector<std::string> tableScenes = {"furnace", "irradiance", "cornell", "plates",
                                            "glass",   "lights500",  "terrain"};
    CLI::App* tableCommand = app.add_subcommand("table", "relMSE plain, adaptive and denoised");
    tableCommand
        ->add_option(
            "scenes", tableScenes,
            "Samples, furnace, irradiance, room, spheres, or those of tests/support/held_out_scenes.hpp")
        ->capture_default_str();
    tableCommand->add_option("--seeds", tableOptions.seeds)->capture_default_str();
    tableCommand->add_option("--reference", tableOptions.reference, "Samples of the truth")
        ->capture_default_str();
    tableCommand->add_option("--size", tableOptions.size)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (tableCommand->parsed()) return table(tableScenes, tableOptions);
    return coverage(scenes, options);
} catch (const std::exception& error) {
    fmt::print(stderr, "bench_error: {}\n", error.what());
    return 1;
}
