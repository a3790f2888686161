#include "../commands.hpp"
#include "../console.hpp"
#include "../interrupts.hpp"
#include "../output_files.hpp"
#include "bench_cases.hpp"
#include "bench_page.hpp"
#include "bench_record.hpp"
#include "bench_runner.hpp"
#include "bench_verdict.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>

namespace helio::cli {
namespace {

struct BenchArguments {
    std::vector<std::string> names;
    std::string json = "heliograph-bench.json";
    std::string html;
    std::string device = "auto";
    bool quick = false, quiet = false;
};

void printTable(const BenchRecord& record, const std::vector<BenchCase>& cases) {
    printLine("{:<12} {:<13} {:<12} {:>7} {:>10} {:>9} {:>16} {:>11} {:>9}", "scene", "group", "method",
              "last", "relMSE", "CPU s", "order", "1/(e CPUs)", "unsteady");
    for (const BenchCase& each : cases) {
        const std::vector<SeriesPoint> series = record.series(each);
        if (series.empty()) continue;
        const SeriesPoint& last = series.back();
        if (!each.unit.empty()) {
            printLine("{:<12} {:<13} {:<12} {:>7} {:>10.3g} {:>9.4f}   ({})", each.scene, each.group,
                      each.method, last.samples, last.relmse, last.cpuSeconds, each.unit);
            continue;
        }
        const SeriesFit fit = fitSeries(series);
        printLine("{:<12} {:<13} {:<12} {:>7} {:>10.3g} {:>9.4f} {:>8.3f} +- {:.3f} {:>11.4g} {:>7.1f} %",
                  each.scene, each.group, each.method, last.samples, last.relmse, last.cpuSeconds, fit.order,
                  fit.orderError, fit.efficiency, 100 * fit.unsteadiness);
    }
}

int bench(const BenchArguments& arguments) {
    const BenchSettings settings = benchSettings(arguments.quick);
    const std::vector<BenchCase> cases = chosenCases(benchCases(arguments.quick), arguments.names);
    checkTextOutput(arguments.json);
    if (!arguments.html.empty()) checkPage(arguments.html);
    handleInterrupts();
    Renderer renderer({.device = arguments.device});
    BenchRecord record(arguments.json, settings, renderer.device().info().name);
    const auto start = std::chrono::steady_clock::now();
    BenchRunner runner(renderer, record, settings, {interrupted, [&](const std::string& line) {
                                                        if (arguments.quiet) return;
                                                        const std::chrono::duration<double> elapsed =
                                                            std::chrono::steady_clock::now() - start;
                                                        say("{:5.0f} s  {}", elapsed.count(), line);
                                                    }});
    if (!runner.run(cases)) {
        say("interrupted; the same command goes on from {}", arguments.json);
        return Interrupted;
    }
    if (!arguments.html.empty()) writePage(arguments.json, arguments.html);
    if (!arguments.quiet) {
        printTable(record, cases);
        printLine("wrote {}", record.file().string());
        printLine("wrote {}", record.csvFile().string());
        if (!arguments.html.empty()) printLine("wrote {}", arguments.html);
    }
    std::vector<std::string> failures;
    for (const Verdict& verdict : verdicts(record, cases)) {
        if (!arguments.quiet) printLine("{}", verdict.text);
        if (verdict.isFailure) failures.push_back(verdict.text);
    }
    if (failures.empty()) return Done;
    throw InputError(arguments.json, "", fmt::format("{}", fmt::join(failures, ", ")), "");
}

}  // namespace

void addBenchCommand(CLI::App& app, Command& run) {
    auto arguments = std::make_shared<BenchArguments>();
    CLI::App* command = app.add_subcommand(
        "bench", "Measure error against time: scenes by methods, over doubling numbers of samples");
    command->add_option("NAME", arguments->names, "Groups, scenes, methods or SCENE/METHOD; default all");
    command->add_flag("--quick", arguments->quick,
                      "Small pictures and short series: two minutes in place of half an hour");
    command
        ->add_option(
            "--json", arguments->json,
            "File of the results, written after every render; what it holds already is not measured again. "
            "A .csv and a folder .pictures come beside it")
        ->capture_default_str();
    command->add_option("--html", arguments->html,
                        "One page of it with plots and pictures; needs python3 with matplotlib");
    command
        ->add_option("--device", arguments->device, "auto, an index or part of a name from heliograph info")
        ->capture_default_str();
    command->add_flag("--quiet", arguments->quiet, "Print only warnings and errors");
    command->callback([arguments, &run] { run = [arguments] { return bench(*arguments); }; });
}

}  // namespace helio::cli
