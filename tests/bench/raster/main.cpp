/** @file
 * The compute rasterizer against Vulkan's graphics pipeline on the same device: same triangles, same
 * visibility output, interleaved runs, medians of the device's own timestamps, clears included.
 * `bench_raster [--rounds N] [--passes] [--only TEXT] [--culling] [FILE...]` prints a Markdown table; files
 * are drawn after the built-in scenes, --passes adds the times of the compute rasterizer's passes, --only
 * leaves out scenes without TEXT in their names; --culling compares the compute rasterizer with itself where
 * hidden clusters of triangles are culled, on what every image but the first takes.
 */
#include "passes/raster/raster_pipeline.hpp"
#include "tests/bench/raster/graphics_rasterizer.hpp"
#include "tests/bench/raster/scenes.hpp"
#include "tests/bench/timing.hpp"

#include <heliograph/device.hpp>
#include <heliograph/error.hpp>
#include <heliograph/graph.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace helio::bench {
namespace {

constexpr std::array<std::uint32_t, 2> kSize = {1280, 720};

/** The compute rasterizer's plan into a buffer that stays on the device. */
struct ComputeRasterizer {
    ComputeRasterizer(Device& device, const BenchScene& scene, bool culling = false)
        : triangles(makeBuffer(device, "bench.triangles", scene.triangles)),
          keys(device, "bench.keys", 8ull * scene.view.width * scene.view.height) {
        const auto view = std::make_shared<const RasterView>(scene.view);
        const auto count = std::uint32_t(scene.triangles.size() / 3);
        const auto all = [&](Graph& into) { return RasterTriangles{into.import(triangles), count}; };
        if (culling) clusters = std::make_unique<RasterClusters>(device, all);
        Graph graph(device);
        const Buffer visibility = graph.import(keys),
                     counters = graph.buffer("bench.counters", {sizeof(RasterCounters)});
        graph.fill("bench.clear", visibility, 0);
        graph.fill("bench.clearCounters", counters, 0);
        RasterPipeline(device).declare(graph, all(graph), view,
                                       {visibility, 0, counters, {}, clusters.get()});
        work = graph.readback<RasterCounters>(counters);
        plan = graph.compile({.executionsInFlight = 1});
    }
    /** Seconds on the device. */
    double draw() {
        last = plan.execute();
        double sum = 0;
        for (const PassTiming& pass : plan.timings(last)) sum += pass.milliseconds;
        return sum * 1e-3;
    }
    DeviceBuffer triangles, keys;
    std::unique_ptr<RasterClusters> clusters;
    Readback<RasterCounters> work;
    Plan plan;
    Execution last;
};

void measure(Device& device, const BenchScene& scene, int rounds, bool details) {
    GraphicsRasterizer graphics(device, scene.view, scene.triangles);
    ComputeRasterizer compute(device, scene);
    graphics.draw();  // the driver compiles at the first draw
    compute.draw();
    std::vector<double> graphicsTimes, computeTimes, graphicsCpu, computeCpu;
    for (int round = 0; round < rounds; ++round) {
        const double start = cpuSeconds();
        graphicsTimes.push_back(graphics.draw());
        const double middle = cpuSeconds();
        computeTimes.push_back(compute.draw());
        graphicsCpu.push_back(middle - start);
        computeCpu.push_back(cpuSeconds() - middle);
    }
    const std::vector<std::uint32_t> ids = graphics.ids();
    std::vector<std::uint64_t> keys(ids.size());
    compute.keys.download(keys.data(), keys.size() * 8);
    std::size_t different = 0;
    for (std::size_t i = 0; i < ids.size(); ++i)
        different += visibleTriangle(keys[i]) != std::int32_t(ids[i]);
    const double g = median(graphicsTimes), c = median(computeTimes);
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.3f} % |\n", scene.name,
               scene.triangles.size() / 3, g * 1e3, c * 1e3, g / c,
               std::ranges::min(graphicsTimes) / std::ranges::min(computeTimes),
               median(graphicsCpu) / median(computeCpu), 100.0 * double(different) / double(ids.size()));
    if (details) {
        for (const PassTiming& pass : compute.plan.timings(compute.last))
            if (pass.milliseconds > 0.02) fmt::print("    {:24} {:8.3f}\n", pass.name, pass.milliseconds);
        const RasterCounters work = compute.work.wait(compute.last).at(0);
        fmt::print(
            "    outside {}, empty {}, drawn directly {} ({} pixels of {} tested), by tiles {} ({} "
            "entries, {} tested), clipped {}\n",
            work.outside, work.empty, work.small, work.smallCovered, work.smallVisited, work.large,
            work.entries, work.tileVisited, work.clipped);
    }
    std::fflush(stdout);
}

void measureCulling(Device& device, const BenchScene& scene, int rounds, bool details) {
    ComputeRasterizer all(device, scene), culled(device, scene, true);
    all.draw();  // the driver compiles at the first draw
    culled.draw();
    std::vector<double> allTimes, culledTimes, allCpu, culledCpu;
    for (int round = 0; round < rounds; ++round) {
        const double start = cpuSeconds();
        allTimes.push_back(all.draw());
        const double middle = cpuSeconds();
        culledTimes.push_back(culled.draw());
        allCpu.push_back(middle - start);
        culledCpu.push_back(cpuSeconds() - middle);
    }
    const std::size_t pixels = std::size_t{kSize[0]} * kSize[1];
    std::vector<std::uint64_t> expected(pixels), keys(pixels);
    all.keys.download(expected.data(), expected.size() * 8);
    culled.keys.download(keys.data(), keys.size() * 8);
    const RasterCounters work = culled.work.wait(culled.last).at(0);
    const double a = median(allTimes), c = median(culledTimes), count = double(work.triangles);
    fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} |\n", scene.name,
               work.triangles, 100 * double(work.outside) / count, 100 * double(work.hidden) / count, a * 1e3,
               c * 1e3, a / c, median(allCpu) / median(culledCpu), keys == expected ? "none" : "SOME");
    if (details)
        for (const PassTiming& pass : culled.plan.timings(culled.last))
            if (pass.milliseconds > 0.02) fmt::print("    {:24} {:8.3f}\n", pass.name, pass.milliseconds);
    std::fflush(stdout);
}

int run(int argc, char** argv) {
    int rounds = 15;
    bool details = false, culling = false;
    std::string only;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--passes") {
            details = true;
        } else if (argument == "--culling") {
            culling = true;
        } else if (argument == "--rounds" && i + 1 < argc) {
            rounds = std::max(1, std::atoi(argv[++i]));
        } else if (argument == "--only" && i + 1 < argc) {
            only = argv[++i];
        } else {
            files.push_back(argument);
        }
    }
    Device device;
    fmt::print("{}, {}x{}, medians of {}\n\n", device.info().name, kSize[0], kSize[1], rounds);
    if (culling)
        fmt::print(
            "| scene | triangles | outside | hidden | all, ms | culled, ms | all / culled | in CPU time | "
            "pixels that differ |\n|---|---|---|---|---|---|---|---|---|\n");
    else
        fmt::print(
            "| scene | triangles | graphics, ms | compute, ms | graphics / compute | of the fastest "
            "runs | in CPU time | ids that differ |\n|---|---|---|---|---|---|---|---|\n");
    const auto draw = [&](const std::string& name, const auto& make) {
        if (name.find(only) == std::string::npos) return;
        (culling ? measureCulling : measure)(device, make(name), rounds, details);
    };
    const auto small = [&](const std::string& name, std::uint32_t count, double side) {
        draw(name, [&](const std::string& n) { return scattered(n, count, side, kSize); });
    };
    small("about 1 pixel", 1000000, 1.6);
    small("4 pixels", 200000, 4);
    small("30x30 pixels", 10000, 30);
    small("150x150 pixels", 2000, 150);
    draw("full screen", [](const std::string& n) { return fullScreen(n, 8, kSize); });
    if (culling) draw("40 walls", [](const std::string& n) { return walls(n, 40, 80, kSize); });
    for (const std::string& file : files) draw(file, [](const std::string& n) { return fromFile(n, kSize); });
    return 0;
}

}  // namespace
}  // namespace helio::bench

int main(int argc, char** argv) {
    try {
        return helio::bench::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_raster: {}\n", error.what());
        return 1;
    }
}
