#include "bench_runner.hpp"

#include "bench_scenes.hpp"
#include "bench_sizes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace helio::cli {
namespace {

using Json = BenchRecord::Json;

/** Seeds of the two halves of references; those of points count from 0. */
constexpr std::uint32_t kReferenceSeeds[] = {1000001, 1000002};
/** The samples at which pictures of a series are kept: few enough that errors show. */
constexpr std::uint32_t kPictureSamples = 16;

std::uint32_t pictureSamples(const BenchCase& measured) {
    std::uint32_t best = measured.samples.front();
    for (const std::uint32_t samples : measured.samples)
        if (samples <= kPictureSamples) best = samples;
    return best;
}

/** The options of the method that a case's truth is rendered with. */
RenderOptions referenceOptions(const BenchCase& measured, const BenchSettings& settings, std::uint32_t seed) {
    RenderOptions options;
    options.pipeline = measured.options.pipeline;
    options.maxDepth = measured.options.maxDepth;
    options.seed = seed;
    options.samples = settings.reference;
    if (options.pipeline == Pipeline::Raster)
        options.antialiasing = antialiasing(fmt::format("jitter{}", settings.referenceSide), seed);
    // The integral of the bilinear texture over the pixel is what every filter is after.
    if (measured.group == "filters") options.textureFilter = TextureFilter::Bilinear;
    return options;
}

Json describe(const RenderResult& result, const PictureError& error, std::uint32_t samples,
              std::uint32_t seed) {
    const ErrorEstimate& estimate = result.denoised ? result.denoised->error : result.error;
    return {{"samples", samples},
            {"seed", seed},
            {"seconds", result.seconds},
            {"cpu_seconds", result.renderCpuSeconds},
            {"setup_seconds", result.setupSeconds},
            {"rays", result.rays.camera + result.rays.bounce + result.rays.shadow},
            {"mse", error.mse},
            {"relmse", error.relmse},
            {"estimate", estimate.relmse},
            {"low", estimate.low},
            {"high", estimate.high},
            {"reliable", estimate.reliable}};
}

}  // namespace

BenchRunner::BenchRunner(Renderer& renderer, BenchRecord& record, const BenchSettings& settings,
                         Callbacks callbacks)
    : renderer_(renderer), record_(record), settings_(settings), callbacks_(std::move(callbacks)) {}

bool BenchRunner::run(const std::vector<BenchCase>& cases) {
    std::string loaded;
    Scene scene;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const BenchCase& measured = cases[i];
        for (const std::uint32_t samples : measured.samples) {
            for (std::uint32_t repeat = 0; repeat < settings_.repeats; ++repeat) {
                if (record_.has(measured, samples, repeat)) continue;
                if (repeat == 0) {
                    callbacks_.report(fmt::format("{}/{} {} {}, {} {}", i + 1, cases.size(), measured.scene,
                                                  measured.method, samples,
                                                  measured.unit.empty() ? "samples" : measured.unit));
                }
                if (!measured.unit.empty()) {
                    if (callbacks_.interrupted()) return false;
                    measureSize(measured, samples, repeat);
                    continue;
                }
                if (loaded != measured.scene) {
                    scene = benchScene(measured.scene);
                    loaded = measured.scene;
                }
                if (!makeTruth(measured, scene)) return false;
                if (!measure(measured, scene, samples, repeat)) return false;
            }
        }
    }
    record_.finish(cases);
    return true;
}

std::optional<RenderResult> BenchRunner::render(const Scene& scene, RenderOptions options) {
    options.size = settings_.size;
    options.auxiliary = false;
    options.progress = [&](const Progress&) { return !callbacks_.interrupted(); };
    RenderResult result = renderer_.render(scene, options);
    if (result.cancelled || callbacks_.interrupted()) return std::nullopt;
    return result;
}

bool BenchRunner::makeTruth(const BenchCase& measured, const Scene& scene) {
    const std::string key = measured.truth();
    if (truthKey_ == key) return true;
    const auto& [width, height] = settings_.size;
    const std::filesystem::path file = record_.picture(key + ".truth.exr");
    const Json known = record_.truth(key);
    Json description;
    if (const auto closed = closedForm(measured.scene, settings_.size)) {
        truth_ = {};
        for (const double value : *closed) truth_.rgb.insert(truth_.rgb.end(), 3, value);
        description = {{"kind", "closed form"}};
    } else if (known.is_object() && std::filesystem::exists(file)) {
        const ImageF image = loadImage(file);
        truth_ = truthFromHalves(image, image);
        truth_.residual = known.value("residual_relmse", 0.0);
        truth_.residualMse = known.value("residual_mse", 0.0);
        truthKey_ = key;
        return true;
    } else {
        callbacks_.report(fmt::format("reference of {}", key));
        std::vector<ImageF> halves;
        double seconds = 0;
        for (const std::uint32_t seed : kReferenceSeeds) {
            std::optional<RenderResult> half = render(scene, referenceOptions(measured, settings_, seed));
            if (!half) return false;
            seconds += half->seconds;
            halves.push_back(std::move(half->image));
        }
        truth_ = truthFromHalves(halves[0], halves[1]);
        const bool isRaster = measured.options.pipeline == Pipeline::Raster;
        description = {{"kind", "reference"},
                       {"samples", 2 * (isRaster ? settings_.referenceSide * settings_.referenceSide
                                                 : settings_.reference)},
                       {"residual_relmse", truth_.residual},
                       {"residual_mse", truth_.residualMse},
                       {"seconds", seconds}};
    }
    const ImageF picture = truthPicture(truth_, width, height);
    if (description["kind"] == "reference") saveImage(file, picture);
    const std::filesystem::path shown = record_.picture(key + ".truth.png");
    saveImage(shown, picture, displayOf(truth_));
    description["picture"] = shown.filename().string();
    record_.setTruth(key, description);
    truthKey_ = key;
    return true;
}

void BenchRunner::measureSize(const BenchCase& measured, std::uint32_t size, std::uint32_t repeat) {
    Device& device = renderer_.device();
    const SizeResult result = measured.group == "mips"
                                  ? measureMips(device, measured.scene == "floats", size, repeat)
                                  : measureTraversal(device,
                                                     {.coherent = measured.scene == "coherent",
                                                      .closest = measured.method == "closest",
                                                      .count = settings_.rays},
                                                     size, repeat);
    record_.add(measured, {{"samples", size},
                           {"seed", repeat},
                           {"seconds", result.seconds},
                           {"cpu_seconds", result.cpuSeconds},
                           {"items", result.items},
                           {"mse", result.mse},
                           {"relmse", result.relmse}});
}

bool BenchRunner::measure(const BenchCase& measured, const Scene& scene, std::uint32_t samples,
                          std::uint32_t repeat) {
    const std::optional<RenderResult> result = render(scene, measured.with(samples, repeat));
    if (!result) return false;
    const ImageF& image = measured.denoised ? result->denoised->image : result->image;
    Json point = describe(*result, pictureError(image, truth_), samples, repeat);
    if (samples == pictureSamples(measured) && repeat == 0) {
        const std::string name = fmt::format("{}.{}", measured.truth(), measured.method);
        saveImage(record_.picture(name + ".png"), image, displayOf(truth_));
        saveImage(record_.picture(name + ".difference.png"), differencePicture(image, truth_));
        point["picture"] = name + ".png";
        point["difference"] = name + ".difference.png";
    }
    record_.add(measured, point);
    return true;
}

}  // namespace helio::cli
