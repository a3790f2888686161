/** @file
 * Random scenes through the path tracer: every sample must be finite.
 *   stability_soak [SAMPLES] [PROGRESS_FILE] [FIRST_SCENE]
 * Runs until so many samples (default 1e9) have been taken. With a PROGRESS_FILE it goes on where an earlier
 * run was stopped, even by kill -9. Prints each scene that gave a sample or pixel that is not finite, and
 * exits 1 if any did.
 */
#include "tests/stability/random_scenes.hpp"

#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace {

using namespace helio;

struct Soak {
    std::uint64_t next = 0, samples = 0, scenes = 0, rejected = 0, pixels = 0, refused = 0;
    void save(const std::string& file) const {
        if (file.empty()) return;
        std::ofstream(file + ".new") << next << ' ' << samples << ' ' << scenes << ' ' << rejected << ' '
                                     << pixels << ' ' << refused << '\n';
        std::filesystem::rename(file + ".new", file);
    }
    void load(const std::string& file) {
        if (std::ifstream in(file); in) in >> next >> samples >> scenes >> rejected >> pixels >> refused;
    }
};

RenderOptions optionsOf(std::uint64_t number) {
    RenderOptions options;
    options.size = {64, 64};
    options.samples = 512;
    options.seed = std::uint32_t(number);
    options.maxDepth = 64;
    constexpr std::array lights{LightChoice::Adaptive, LightChoice::Power, LightChoice::Uniform};
    options.lights = lights[number % 3];
    options.nextEventEstimation = number % 7 != 0;
    options.environment = Environment{};
    return options;
}

void run(Renderer& renderer, Soak& soak) {
    const std::uint64_t number = soak.next++;
    const Scene scene = test::randomScene(number);
    RenderOptions options = optionsOf(number);
    if (scene.environment) options.environment.reset();
    RenderResult result;
    try {
        result = renderer.render(scene, options);
    } catch (const InputError& error) {
        ++soak.refused;
        fmt::print("scene {} is refused: {}\n", number, error.what());
        return;
    }
    std::uint64_t pixels = 0;
    for (float value : result.image.data) pixels += std::isfinite(value) ? 0 : 1;
    const std::uint64_t taken = std::uint64_t(options.size[0]) * options.size[1] * result.samples;
    if (result.nanCount > 0 || pixels > 0)
        fmt::print("scene {}: {} samples and {} values of the image are not finite\n", number,
                   result.nanCount, pixels);
    ++soak.scenes;
    soak.samples += taken;
    soak.rejected += result.nanCount;
    soak.pixels += pixels;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const double wanted = argc > 1 ? std::atof(argv[1]) : 1e9;
        const std::string file = argc > 2 ? argv[2] : "";
        Soak soak;
        if (argc > 3) soak.next = std::strtoull(argv[3], nullptr, 10);
        if (!file.empty()) soak.load(file);
        std::optional<Renderer> renderer;
        while (double(soak.samples) < wanted) {
            // A renderer keeps the kernels of all scenes it has met, and no two of these are alike.
            if (!renderer || soak.next % 20 == 0) renderer.emplace();
            run(*renderer, soak);
            soak.save(file);
            if (soak.next % 20 == 0)
                fmt::print("{} scenes, {:.3g} of {:.3g} samples, {} not finite\n", soak.scenes,
                           double(soak.samples), wanted, soak.rejected);
            std::fflush(stdout);
        }
        fmt::print("{} scenes ({} refused), {} samples: {} samples and {} values of images not finite\n",
                   soak.scenes, soak.refused, soak.samples, soak.rejected, soak.pixels);
        return soak.rejected + soak.pixels > 0 ? 1 : 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "stability_soak: {}\n", error.what());
        return 2;
    }
}
