// The statistics as JSON, and the image's metadata.
#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace helio {

std::string_view MeterReading::quantityName() const {
    return std::array{"irradiance", "flux", "radiance", "intensity"}[std::size_t(quantity)];
}
std::string_view MeterReading::unit() const {
    return std::array{"W/m^2", "W", "W/(sr m^2)", "W/sr"}[std::size_t(quantity)];
}
std::string_view MeterReading::photometricUnit() const {
    return std::array{"lx", "lm", "cd/m^2", "cd"}[std::size_t(quantity)];
}

std::string RenderResult::json() const {
    using Json = nlohmann::ordered_json;
    Json passTimes = Json::array(), skippedParts = Json::array();
    for (const PassTime& pass : passes) passTimes.push_back({{"name", pass.name}, {"ms", pass.milliseconds}});
    Json work = Json::object();
    for (const auto& [name, count] : counters) work[name] = count;
    for (const auto& [what, why] : skipped) skippedParts.push_back({{"what", what}, {"why", why}});
    Json statistics = {
        {"version", version},
        {"device", device},
        {"scene", scene},
        {"seed", seed},
        {"spp", samples},
        {"setup_seconds", setupSeconds},
        {"setup_cpu_seconds", setupCpuSeconds},
        {"render_seconds", seconds},
        {"render_cpu_seconds", renderCpuSeconds},
        {"rays", {{"camera", rays.camera}, {"bounce", rays.bounce}, {"shadow", rays.shadow}}},
        {"error",
         {{"relmse", error.relmse}, {"low", error.low}, {"high", error.high}, {"reliable", error.reliable}}},
        {"nan_count", nanCount},
        {"truncated_paths", truncatedPaths},
        {"memory", {{"host_bytes", hostBytes}, {"device_bytes", deviceBytes}}},
        {"passes", passTimes},
        {"features", features},
        {"skipped", skippedParts}};
    if (!counters.empty()) statistics["counters"] = work;
    if (denoised) {
        statistics["denoised"] = {{"biased", true},
                                  {"relmse", denoised->error.relmse},
                                  {"low", denoised->error.low},
                                  {"high", denoised->error.high},
                                  {"reliable", denoised->error.reliable},
                                  {"undenoised_relmse", denoised->undenoised},
                                  {"strength", denoised->strength}};
    }
    if (radiosity) {
        statistics["radiosity"] = {{"patches", radiosity->patches},
                                   {"unknowns", radiosity->unknowns},
                                   {"iterations", radiosity->iterations},
                                   {"converged", radiosity->converged}};
        if (radiosity->denseDifference)
            statistics["radiosity"]["dense_difference"] = *radiosity->denseDifference;
    }
    if (caustics) {
        statistics["caustics"] = {{"guided", caustics->guided},
                                  {"photons", caustics->photons},
                                  {"kept", caustics->kept},
                                  {"cells", caustics->cells},
                                  {"tables", caustics->tables},
                                  {"bytes", caustics->bytes},
                                  {"gain", caustics->gain},
                                  {"seconds", caustics->seconds},
                                  {"cpu_seconds", caustics->cpuSeconds}};
    }
    for (const MeterReading& meter : meters) {
        statistics["meters"].push_back({{"name", meter.name},
                                        {"quantity", meter.quantityName()},
                                        {"unit", meter.unit()},
                                        {"value", meter.value},
                                        {"standard_error", meter.error},
                                        {"photometric", meter.photometric},
                                        {"photometric_unit", meter.photometricUnit()}});
    }
    // Names come from files and may not be UTF-8; numbers that JSON has no text for become null.
    return statistics.dump(2, ' ', false, Json::error_handler_t::replace);
}

namespace {

void addMetadata(ImageF& image, const RenderResult& result, const ErrorEstimate& error) {
    image.metadata["scene"] = result.scene;
    image.metadata["seed"] = std::int64_t(result.seed);
    image.metadata["samples"] = std::int64_t(result.samples);
    image.metadata["seconds"] = result.seconds;
    image.metadata["error"] = error.relmse;
    image.metadata["errorLow"] = error.low;
    image.metadata["errorHigh"] = error.high;
    image.metadata["errorReliable"] = std::int64_t(error.reliable);
    image.metadata["device"] = result.device;
    image.metadata["version"] = result.version;
}

/** Linear colour of a relative error. */
std::array<float, 3> falseColor(double relative) {
    constexpr std::array<std::array<double, 3>, 4> colors = {
        {{0.0, 0.0, 0.0}, {0.15, 0.02, 0.35}, {1.0, 0.35, 0.02}, {1.0, 1.0, 1.0}}};
    const double place = std::clamp(std::log10(std::max(relative, 1e-30)) + 3, 0.0, 3.0);
    const std::size_t below = std::min<std::size_t>(std::size_t(place), 2);
    const double t = place - double(below);
    std::array<float, 3> result{};
    for (std::size_t c = 0; c < 3; ++c)
        result[c] = float((1 - t) * colors[below][c] + t * colors[below + 1][c]);
    return result;
}

}  // namespace

void save(const std::filesystem::path& file, const RenderResult& result, const Display& display) {
    ImageF image = result.image;
    addMetadata(image, result, result.error);
    saveImage(file, image, {display.exposure + result.exposure, display.curve});
}

void saveDenoised(const std::filesystem::path& file, const RenderResult& result, const Display& display) {
    if (!result.denoised)
        throw InputError(file.string(), "", "there is no denoised image",
                         "render with RenderOptions::denoise");
    ImageF image = result.denoised->image;
    addMetadata(image, result, result.denoised->error);
    image.metadata["errorBefore"] = result.denoised->undenoised;
    image.metadata["denoised"] = std::string("biased: filtered over space");
    saveImage(file, image, {display.exposure + result.exposure, display.curve});
}

void saveErrorMap(const std::filesystem::path& file, const RenderResult& result) {
    ImageF image = result.errorMap;
    if (image.data.empty())
        throw InputError(file.string(), "", "there is no error map", "render with RenderOptions::errorMap");
    addMetadata(image, result, result.error);
    if (file.extension() != ".exr" && file.extension() != ".EXR") {
        for (std::size_t i = 0; i < image.data.size(); i += 3) {
            double square = 0;
            for (std::size_t c = 0; c < 3; ++c) square += double(image.data[i + c]) * image.data[i + c] / 3;
            const std::array<float, 3> color = falseColor(std::sqrt(square));
            std::copy(color.begin(), color.end(), image.data.begin() + std::ptrdiff_t(i));
        }
    }
    saveImage(file, image);
}

}  // namespace helio
