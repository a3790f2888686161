#include "bench_record.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>

namespace helio::cli {
namespace {

using Json = BenchRecord::Json;

Json begin(const BenchSettings& settings, const std::string& device) {
    return {{"what", "heliograph bench"},
            {"version", std::string(version())},
            {"device", device},
            {"settings",
             {{"quick", settings.quick},
              {"size", settings.size},
              {"repeats", settings.repeats},
              {"reference_samples", 2 * settings.reference},
              {"raster_reference_samples", 2 * settings.referenceSide * settings.referenceSide}}},
            {"truths", Json::object()},
            {"series", Json::array()}};
}

/** Whether `json` is an object with a member of each name, all of them of a kind. */
bool has(const Json& json, bool (Json::*kind)() const noexcept, std::initializer_list<const char*> names) {
    return json.is_object() && std::ranges::all_of(names, [&](const char* name) {
               const auto found = json.find(name);
               return found != json.end() && ((*found).*kind)();
           });
}

bool isPoint(const Json& json) {
    return has(json, &Json::is_number_unsigned, {"samples", "seed"}) &&
           has(json, &Json::is_number, {"cpu_seconds"}) && json.contains("relmse");
}

bool isSeries(const Json& json) {
    return has(json, &Json::is_string, {"group", "scene", "method"}) &&
           has(json, &Json::is_array, {"points"}) && std::ranges::all_of(json["points"], isPoint);
}

Json read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    Json json = Json::parse(stream, nullptr, false);
    const bool isRecord =
        has(json, &Json::is_object, {"truths", "settings"}) && has(json, &Json::is_array, {"series"}) &&
        json.value("what", Json()) == "heliograph bench" && std::ranges::all_of(json["series"], isSeries);
    if (!isRecord)
        throw InputError(file.string(), "", "is there and is no record of a benchmark",
                         "name another file with --json");
    return json;
}

constexpr const char* kColumns[] = {"samples", "seed",     "seconds", "cpu_seconds", "setup_seconds",
                                    "rays",    "mse",      "relmse",  "estimate",    "low",
                                    "high",    "reliable", "items"};

}  // namespace

BenchRecord::BenchRecord(std::filesystem::path file, const BenchSettings& settings, const std::string& device)
    : file_(std::move(file)), json_(begin(settings, device)) {
    if (file_ == csvFile() || file_ == pictureFolder())
        throw InputError(file_.string(), "", "is the name of what comes beside the record",
                         "name a file that ends in .json with --json");
    if (!std::filesystem::exists(file_)) return;
    Json found = read(file_);
    for (const char* key : {"version", "device", "settings"}) {
        if (found.value(key, Json()) == json_[key]) continue;
        throw InputError(file_.string(), key,
                         fmt::format("the record is of {}, this run of {}", found.value(key, Json()).dump(),
                                     json_[key].dump()),
                         "name another file with --json, or remove this one");
    }
    json_ = std::move(found);
}

Json* BenchRecord::find(const BenchCase& measured) {
    for (Json& each : json_["series"]) {
        if (each["group"] == measured.group && each["scene"] == measured.scene &&
            each["method"] == measured.method)
            return &each;
    }
    return nullptr;
}

const Json* BenchRecord::find(const BenchCase& measured) const {
    return const_cast<BenchRecord*>(this)->find(measured);
}

bool BenchRecord::has(const BenchCase& measured, std::uint32_t samples, std::uint32_t seed) const {
    const Json* found = find(measured);
    return found != nullptr && std::ranges::any_of((*found)["points"], [&](const Json& point) {
               return point["samples"] == samples && point["seed"] == seed;
           });
}

void BenchRecord::add(const BenchCase& measured, const Json& point) {
    Json* found = find(measured);
    if (found == nullptr) {
        json_["series"].push_back({{"group", measured.group},
                                   {"scene", measured.scene},
                                   {"method", measured.method},
                                   {"truth", measured.truth()},
                                   {"biased", measured.biased},
                                   {"points", Json::array()}});
        found = &json_["series"].back();
        if (!measured.unit.empty()) (*found)["unit"] = measured.unit;
    }
    (*found)["points"].push_back(point);
    write();
}

std::vector<SeriesPoint> BenchRecord::series(const BenchCase& measured) const {
    const Json* found = find(measured);
    if (found == nullptr) return {};
    std::map<std::uint32_t, std::vector<SeriesPoint>> bySamples;
    for (const Json& point : (*found)["points"]) {
        const auto samples = point["samples"].get<std::uint32_t>();
        // JSON has no NaN: what is not a number was not one.
        const double relmse = point["relmse"].is_number() ? point["relmse"].get<double>()
                                                          : std::numeric_limits<double>::quiet_NaN();
        bySamples[samples].push_back({samples, relmse, point["cpu_seconds"].get<double>()});
    }
    std::vector<SeriesPoint> series;
    for (const auto& [samples, renders] : bySamples) {
        SeriesPoint mean{samples, 0, renders.front().cpuSeconds};
        for (const SeriesPoint& render : renders) {
            mean.relmse += render.relmse / double(renders.size());
            mean.cpuSeconds = std::min(mean.cpuSeconds, render.cpuSeconds);
        }
        series.push_back(mean);
    }
    return series;
}

Json BenchRecord::truth(const std::string& key) const {
    return json_["truths"].value(key, Json());
}

void BenchRecord::setTruth(const std::string& key, const Json& description) {
    json_["truths"][key] = description;
    write();
}

std::filesystem::path BenchRecord::picture(const std::string& name) const {
    const std::filesystem::path folder = pictureFolder();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(folder.string(), "", "the folder cannot be made: " + error.message(),
                         "name another file with --json");
    return folder / name;
}

std::filesystem::path BenchRecord::pictureFolder() const {
    std::filesystem::path folder = file_;
    folder.replace_extension(".pictures");
    return folder;
}

std::filesystem::path BenchRecord::csvFile() const {
    std::filesystem::path csv = file_;
    csv.replace_extension(".csv");
    return csv;
}

std::string BenchRecord::csv() const {
    std::string text = "group,scene,method";
    for (const char* column : kColumns) text += fmt::format(",{}", column);
    for (const Json& each : json_["series"]) {
        for (const Json& point : each["points"]) {
            text += fmt::format("\n{},{},{}", each["group"].get<std::string>(),
                                each["scene"].get<std::string>(), each["method"].get<std::string>());
            for (const char* column : kColumns) text += "," + point.value(column, Json()).dump();
        }
    }
    return text + "\n";
}

void BenchRecord::write() const {
    writeTextFile(file_, json_.dump(1) + "\n");
    writeTextFile(csvFile(), csv());
}

void BenchRecord::finish(const std::vector<BenchCase>& cases) {
    for (const BenchCase& each : cases) {
        Json* found = find(each);
        if (found == nullptr || !each.unit.empty()) continue;
        const SeriesFit fit = fitSeries(series(each));
        (*found)["fit"] = {{"order", fit.order},
                           {"order_error", fit.orderError},
                           {"unsteadiness", fit.unsteadiness},
                           {"efficiency", fit.efficiency}};
        if (each.order) (*found)["fit"]["expected_order"] = {each.order->low, each.order->high};
    }
    write();
}

}  // namespace helio::cli
