#include "commands.hpp"
#include "console.hpp"
#include "output_files.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

namespace helio::cli {
namespace {

struct CompareArguments {
    std::string image, reference, output;
    std::vector<std::string> limits;  ///< METRIC=VALUE
    bool json = false;
};

nlohmann::ordered_json toJson(const ImageDifference& difference) {
    return {{"mse", difference.mse},
            {"rmse", difference.rmse},
            {"relmse", difference.relmse},
            {"mean_ratio", difference.meanRatio},
            {"worst", {{"x", difference.worstX}, {"y", difference.worstY}, {"error", difference.worstError}}},
            {"nan", difference.nan},
            {"inf", difference.inf}};
}

/** |image - reference| per channel, brightest channel difference scaled to 1. */
ImageF differenceImage(const ImageF& image, const ImageF& reference, double worst) {
    ImageF result{image.width, image.height, {"R", "G", "B"}, {}, {}};
    result.data.resize(std::size_t(image.width) * image.height * 3);
    const float scale = worst > 0 ? float(1 / worst) : 1.0f;
    const std::array<const char*, 3> names = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto a = std::size_t(image.channel(names[c])), b = std::size_t(reference.channel(names[c]));
        for (std::uint32_t y = 0; y < image.height; ++y) {
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const float error = std::abs(image.at(x, y, a) - reference.at(x, y, b)) * scale;
                result.at(x, y, c) = std::isfinite(error) ? error : 1.0f;
            }
        }
    }
    return result;
}

/** --fail-above METRIC=VALUE */
struct Limit {
    std::string metric;
    double value = 0;
};

Limit parseLimit(const std::string& text) {
    static constexpr std::array kMetrics = {"mse", "rmse", "relmse", "mean_ratio", "worst", "nan", "inf"};
    const std::size_t equals = text.find('=');
    const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
    char* end = nullptr;
    const Limit limit{text.substr(0, equals), std::strtod(number.c_str(), &end)};
    if (number.empty() || *end != '\0' || std::isnan(limit.value)) {
        throw CLI::ValidationError("--fail-above", "'" + text + "' is not METRIC=VALUE");
    }
    if (std::ranges::find(kMetrics, limit.metric) == kMetrics.end()) {
        throw CLI::ValidationError("--fail-above", fmt::format("there is no metric '{}'; there are {}",
                                                               limit.metric, fmt::join(kMetrics, ", ")));
    }
    return limit;
}

/** The limits that a comparison exceeds, a phrase each. NaN exceeds every limit. */
std::vector<std::string> exceeded(const std::vector<Limit>& limits, const nlohmann::ordered_json& metrics) {
    std::vector<std::string> result;
    for (const auto& [metric, value] : limits) {
        const double actual = (metric == "worst" ? metrics["worst"]["error"] : metrics[metric]).get<double>();
        if (!(actual <= value))
            result.push_back(fmt::format("{} is {:g}, above {:g}", metric, actual, value));
    }
    return result;
}

enum class Encoding : std::uint8_t { Unknown, Linear, Srgb };

/** How a file of this type holds its values. */
Encoding encodingOf(const std::filesystem::path& file) {
    const std::string extension = lowerCaseExtension(file);
    if (extension == ".exr" || extension == ".hdr") return Encoding::Linear;
    if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") return Encoding::Srgb;
    return Encoding::Unknown;
}

/** Loads an image to be compared with another: sRGB values that meet linear ones are decoded. */
ImageF loadToCompare(const std::string& file, const std::string& other) {
    ImageF image = loadImage(file);
    if (encodingOf(file) != Encoding::Srgb || encodingOf(other) != Encoding::Linear) return image;
    say("{} is decoded from sRGB to linear, as {} is linear", file, other);
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        if (image.channels[c] != "R" && image.channels[c] != "G" && image.channels[c] != "B") continue;
        for (std::size_t i = c; i < image.data.size(); i += image.channels.size()) {
            image.data[i] = float(srgbDecode(image.data[i]));
        }
    }
    return image;
}

int compare(const CompareArguments& arguments) {
    std::vector<Limit> limits;
    for (const std::string& limit : arguments.limits) limits.push_back(parseLimit(limit));
    if (!arguments.output.empty()) checkImageOutput("--output", arguments.output);
    const ImageF image = loadToCompare(arguments.image, arguments.reference);
    const ImageF reference = loadToCompare(arguments.reference, arguments.image);
    const ImageDifference difference = compareImages(image, reference);
    const nlohmann::ordered_json metrics = toJson(difference);
    const std::vector<std::string> failures = exceeded(limits, metrics);
    if (arguments.json) {
        writeOutput(metrics.dump(2) + "\n");
    } else {
        writeOutput(fmt::format(
            "mse {:.6g}\nrmse {:.6g}\nrelmse {:.6g}\nmean_ratio {:.6g}\nworst {:.6g} at ({}, {})\nnan "
            "{}\ninf {}\n",
            difference.mse, difference.rmse, difference.relmse, difference.meanRatio, difference.worstError,
            difference.worstX, difference.worstY, difference.nan, difference.inf));
    }
    if (!arguments.output.empty()) {
        saveImage(arguments.output, differenceImage(image, reference, difference.worstError));
    }
    if (failures.empty()) return Done;
    throw InputError(arguments.image, "", fmt::format("{}", fmt::join(failures, ", ")), "");
}

}  // namespace

void addCompareCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command = app.add_subcommand(
        "compare",
        "Compare an image with a reference, values as stored; a PNG or JPEG against an EXR or "
        "HDR is decoded from sRGB first");
    command->add_option("IMAGE", arguments->image, "Image to judge")->required();
    command->add_option("REFERENCE", arguments->reference, "What it should be")->required();
    command->add_flag("--json", arguments->json, "Print the figures as JSON");
    command->add_option(
        "--fail-above", arguments->limits,
        "METRIC=VALUE: exit 1 where the metric is above (mse, rmse, relmse, mean_ratio, worst, nan, inf)");
    command->add_option("-o,--output", arguments->output,
                        "Write an image of the difference, scaled to its maximum");
    command->callback([arguments, &run] { run = [arguments] { return compare(*arguments); }; });
}

}  // namespace helio::cli
