#pragma once
/** @file The benchmark's record: a JSON file that holds every point measured so far, a CSV of the same beside
 * it, and a folder of pictures. A run that ended early goes on from it. */
#include "bench_cases.hpp"
#include "bench_judge.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace helio::cli {

class BenchRecord {
public:
    using Json = nlohmann::ordered_json;

    /** Opens the file's record or begins one. Throws InputError where the file is no record, or one of
     * another device, version or settings, or bears the name of what comes beside it. */
    BenchRecord(std::filesystem::path file, const BenchSettings& settings, const std::string& device);

    /** Whether a point is there: one render. */
    bool has(const BenchCase& measured, std::uint32_t samples, std::uint32_t seed) const;
    /** Adds a point and writes the files. `point` holds `samples` and `seed`. */
    void add(const BenchCase& measured, const Json& point);
    /** Means over the renders of each number of samples, ascending; NaN where a picture was not finite. */
    std::vector<SeriesPoint> series(const BenchCase& measured) const;

    /** What is known of a truth; null where nothing is. */
    Json truth(const std::string& key) const;
    void setTruth(const std::string& key, const Json& description);

    /** A file of the folder of pictures; the folder is made. */
    std::filesystem::path picture(const std::string& name) const;
    /** Adds the fits of the cases' series to the JSON, and writes the files. */
    void finish(const std::vector<BenchCase>& cases);

    const std::filesystem::path& file() const { return file_; }
    std::filesystem::path csvFile() const;

private:
    Json* find(const BenchCase& measured);
    const Json* find(const BenchCase& measured) const;
    void write() const;
    std::string csv() const;
    std::filesystem::path pictureFolder() const;

    std::filesystem::path file_;
    Json json_;
};

}  // namespace helio::cli
