#include "tests/bench/price/features.hpp"

#include "tests/bench/price/contender.hpp"
#include "tests/support/scene_features.hpp"
#include "tests/support/specialized_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace helio::test {
namespace {

constexpr std::uint32_t kSize = 128, kSamples = 32;
constexpr int kPairs = 9;

/** A scene ready to be traced. */
struct Priced {
    Priced(Device& device, Scene given) : scene(std::move(given)) {
        PathTraceOptions options;
        options.size = {kSize, kSize};
        const PlacedCamera placed = chooseCamera(scene, {}, 1.0);
        packed.emplace(device, scene, PathTracer::packOptions(scene, options));
        tracer.emplace(device, *packed, scene, placed, options);
        tracer->run(1);  // compiles
    }
    Scene scene;
    std::optional<DeviceScene> packed;
    std::optional<Contender> tracer;
};

void printRow(const std::string& name, const Priced& priced, std::size_t plainInstructions, double ratio) {
    const auto kernel = priced.tracer->kernel();
    const SpecializedKernel code = specialize(kernel.kernel, kernel.constants);
    fmt::print(
        "| {} | {} | {} | {} | {:.2f} |\n", name, code.instructions,
        plainInstructions == 0 ? "" : fmt::format("{:+}", int(code.instructions) - int(plainInstructions)),
        priced.packed->deviceBytes(), ratio);
    std::fflush(stdout);
}

}  // namespace

int printFeaturePrices() {
    Device device{DeviceOptions{}};
    // Lit alike, so that paths of all rooms go as far.
    const auto lit = [] {
        SceneBuilder room = plainRoom();
        room.pointLight({0, 0.5f, 0}, glm::vec3(1.0f));
        return room;
    };
    Priced plain(device, lit().scene);
    const auto kernel = plain.tracer->kernel();
    const std::size_t instructions = specialize(kernel.kernel, kernel.constants).instructions;
    fmt::print(
        "| scene | instructions | more | bytes on the device | CPU time / plain |\n|---|---|---|---|---|\n");
    printRow("a plain room with a point light", plain, 0, 1);
    for (const Feature& feature : features()) {
        SceneBuilder room = lit();
        feature.add(room);
        Priced priced(device, room.scene);
        std::vector<double> ratios;
        for (int pair = 0; pair < kPairs; ++pair) {
            const double own = priced.tracer->run(kSamples);
            ratios.push_back(own / plain.tracer->run(kSamples));
        }
        std::ranges::nth_element(ratios, ratios.begin() + kPairs / 2);
        printRow(feature.name, priced, instructions, ratios[kPairs / 2]);
    }
    return 0;
}

}  // namespace helio::test
