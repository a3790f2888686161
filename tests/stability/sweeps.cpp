// How far each quantity can go before pictures are wrong: renders scenes with known answers over ranges that
// end beyond what single precision can say, and prints a Markdown table.
//   stability_sweeps [POINTS.json] [TEXT]    every point too, for tests/stability/picture.py; only sweeps
//   with
//                                            TEXT in their name
#include "tests/stability/sweep_list.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

namespace helio::test {
namespace {

Outcome outcomeOf(const Sweep& sweep, double value) {
    try {
        return sweep.run(value);
    } catch (const Error& error) {
        return {.error = NAN, .refusal = error.what()};
    }
}

const char* said(const Outcome& outcome) {
    return !outcome.refusal.empty() ? "refused" : outcome.warned ? "warned" : "nothing";
}

int main(const std::string& pointsFile, const std::string& only) {
    fmt::print(
        "| quantity | values | right within | largest right | first wrong, its error | said |\n"
        "|---|---|---|---|---|---|\n");
    nlohmann::ordered_json record = {{"what", "stability_sweeps"},
                                     {"sweeps", nlohmann::ordered_json::array()}};
    for (const Sweep& sweep : sweeps()) {
        if (sweep.name.find(only) == std::string::npos) continue;
        nlohmann::ordered_json points = nlohmann::ordered_json::array();
        std::string right = "none", wrong = "none", words;
        for (const double value : sweep.values) {
            const Outcome outcome = outcomeOf(sweep, value);
            std::fprintf(stderr, "%s: %g: error %.2e, noise %.1e%s %s\n", sweep.name.c_str(), value,
                         outcome.error, outcome.noise, outcome.warned ? ", warned" : "",
                         outcome.refusal.c_str());
            // JSON has no infinity: a picture that is not finite has no error there.
            points.push_back({{"value", std::isfinite(value) ? value : 1e40},
                              {"error", outcome.error},
                              {"noise", outcome.noise},
                              {"right", sweep.isRight(outcome)},
                              {"said", said(outcome)}});
            if (sweep.isRight(outcome)) right = fmt::format("{:.3g}", value);
            if (!sweep.isRight(outcome) && (wrong == "none" || right == "none")) {
                wrong = fmt::format("{:.3g}, {:.1e}", value, outcome.error);
                words = said(outcome);
            }
        }
        fmt::print("| {} | {:.3g} to {:.3g} | {:g} | {} | {} | {} |\n", sweep.name, sweep.values.front(),
                   sweep.values.back(), sweep.tolerance, right, wrong, words);
        std::fflush(stdout);
        record["sweeps"].push_back(
            {{"name", sweep.name}, {"tolerance", sweep.tolerance}, {"points", points}});
    }
    if (!pointsFile.empty() && !(std::ofstream(pointsFile) << record.dump(1) << "\n")) return 1;
    return 0;
}

}  // namespace
}  // namespace helio::test

int main(int argc, char** argv) {
    return helio::test::main(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "");
}
