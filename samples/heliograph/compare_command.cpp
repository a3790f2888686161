#include "commands.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

/** METRIC=VALUE pairs that a comparison exceeds. NaN exceeds every limit. */
std::vector<std::string> exceeded(const std::vector<std::string>& limits,
                                  const nlohmann::ordered_json& metrics) {
    std::vector<std::string> result;
    for (const std::string& limit : limits) {
        const std::size_t equals = limit.find('=');
        const std::string metric = limit.substr(0, equals);
        char* end = nullptr;
        const std::string text = equals == std::string::npos ? "" : limit.substr(equals + 1);
        const double value = std::strtod(text.c_str(), &end);
        if (text.empty() || *end != '\0' || std::isnan(value)) {
            throw CLI::ValidationError("--fail-above", "'" + limit + "' is not METRIC=VALUE");
        }
        const bool known = metric == "worst" || (metrics.contains(metric) && metrics[metric].is_number());
        if (!known) {
            throw CLI::ValidationError("--fail-above",
                                       "there is no metric '" + metric +
                                           "'; there are mse, rmse, relmse, mean_ratio, worst, nan, inf");
        }
        const double actual = (metric == "worst" ? metrics["worst"]["error"] : metrics[metric]).get<double>();
        if (!(actual <= value))
            result.push_back(fmt::format("{} is {:g}, above {:g}", metric, actual, value));
    }
    return result;
}

int compare(const CompareArguments& arguments) {
    const ImageF image = loadImage(arguments.image);
    const ImageF reference = loadImage(arguments.reference);
    const ImageDifference difference = compareImages(image, reference);
    const nlohmann::ordered_json metrics = toJson(difference);
    const std::vector<std::string> failures = exceeded(arguments.limits, metrics);
    if (arguments.json) {
        fmt::print("{}\n", metrics.dump(2));
    } else {
        fmt::print(
            "mse {:.6g}\nrmse {:.6g}\nrelmse {:.6g}\nmean_ratio {:.6g}\nworst {:.6g} at ({}, {})\nnan "
            "{}\ninf {}\n",
            difference.mse, difference.rmse, difference.relmse, difference.meanRatio, difference.worstError,
            difference.worstX, difference.worstY, difference.nan, difference.inf);
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
    CLI::App* command = app.add_subcommand("compare", "Compare an image with a reference");
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
