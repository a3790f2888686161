// The statistics as JSON, and the image's metadata.
#include <heliograph/renderer.hpp>

#include <nlohmann/json.hpp>

namespace helio {

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
    // Names come from files and may not be UTF-8; numbers that JSON has no text for become null.
    return statistics.dump(2, ' ', false, Json::error_handler_t::replace);
}

void save(const std::filesystem::path& file, const RenderResult& result, const Display& display) {
    ImageF image = result.image;
    image.metadata["scene"] = result.scene;
    image.metadata["seed"] = std::int64_t(result.seed);
    image.metadata["samples"] = std::int64_t(result.samples);
    image.metadata["seconds"] = result.seconds;
    image.metadata["error"] = result.error.relmse;
    image.metadata["errorLow"] = result.error.low;
    image.metadata["errorHigh"] = result.error.high;
    image.metadata["errorReliable"] = std::int64_t(result.error.reliable);
    image.metadata["device"] = result.device;
    image.metadata["version"] = result.version;
    saveImage(file, image, {display.exposure + result.exposure, display.curve});
}

}  // namespace helio
