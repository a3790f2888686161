/** @file
 * Traversal against Embree's, in one interleaved run: same triangles, same rays, same threads.
 *
 *     bench_traversal [--runs 9] [--size 1280x704] [--tree bvh|sbvh|lbvh] [--json FILE] [--counts MAX]
 * [ASSET...]
 *
 * Prints, per mesh and kind of ray, the median speeds and the median of the pairs' ratios (1: as fast as
 * rtcIntersect1 or rtcOccluded1), then build times and bytes per triangle. --counts adds cost against the
 * number of triangles, from 10^2 to MAX.
 */
#include "passes/intersect/ray_intersector.hpp"
#include "passes/tree/tree_builder.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/traversal/rays.hpp"
#include "tests/support/embree_scene.hpp"
#include "tests/support/meshes.hpp"

#include <heliograph/device.hpp>
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

namespace helio::bench {
namespace {

using test::Corners;
using test::EmbreeScene;

/** Time on the wall, and of all the process's threads: what is left to compare by where others use the cores.
 */
struct Cost {
    double wall, cpu;
};

Cost costOf(const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            double(std::clock() - cpu) / CLOCKS_PER_SEC};
}

struct Options {
    int runs = 9;
    std::uint32_t width = 1280, height = 704;
    std::string tree = "bvh";
};

/** World-space corners in scene order. */
Corners cornersOf(const PackedScene& packed) {
    Corners corners;
    for (std::size_t slot = 0; slot < packed.triangles.size(); slot += 3) {
        const std::size_t g = glm::floatBitsToUint(packed.triangles[slot].w);
        corners.resize(std::max(corners.size(), (g + 1) * 3));
        for (std::size_t k = 0; k < 3; ++k) corners[g * 3 + k] = glm::vec3(packed.triangles[slot + k]);
    }
    return corners;
}

/** Hits that differ from Embree's: hit against miss, or another distance of the closest. */
std::size_t differing(RayQuestion question, const std::vector<RayHit>& ours,
                      const std::vector<RayHit>& theirs) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const bool bothHit = ours[i].slot >= 0 && theirs[i].slot >= 0;
        const double tolerance = 1e-4 * std::abs(double(theirs[i].distance));
        if (bothHit ? question == RayQuestion::Closest &&
                          std::abs(double(ours[i].distance) - double(theirs[i].distance)) > tolerance
                    : ours[i].slot >= 0 || theirs[i].slot >= 0)
            ++count;
    }
    return count;
}

nlohmann::json measure(Device& device, const std::string& name, const Scene& scene, const Options& options) {
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    PackOptions packing;
    packing.spatialSplits = options.tree == "sbvh";
    std::optional<TreeBuilder> builder;
    BuildTree build;
    if (options.tree == "lbvh")
        build = [&](std::span<const glm::vec3> positions) {
            if (!builder) builder.emplace(device, positions.size() / 3);
            return builder->build(positions);
        };
    PackedScene packed = packScene(scene, {}, packing, build);
    const Corners corners = cornersOf(packed);
    const double triangles = double(corners.size() / 3);
    std::vector<double> ours = {packed.treeSeconds}, theirs;
    for (int run = 0; run < 3; ++run) {
        theirs.push_back(EmbreeScene(corners, threads).buildSeconds());
        if (run > 0) ours.push_back(packScene(scene, {}, packing, build).treeSeconds);
    }
    const EmbreeScene embree(corners, threads);
    nlohmann::json result = {
        {"mesh", name},
        {"triangles", corners.size() / 3},
        {"slots", packed.triangleCount},
        {"build_seconds", median(ours)},
        {"embree_build_seconds", median(theirs)},
        {"build_ratio", median(ours) / median(theirs)},
        {"tree_depth", packed.treeDepth},
        {"node_bytes_per_triangle", double(packed.nodes.size() * 16) / triangles},
        {"bytes_per_triangle", double(packed.nodes.size() * 16 + packed.triangles.size() * 16) / triangles},
        {"embree_bytes_per_triangle", double(embree.bytes()) / triangles}};
    fmt::print(
        "{}: {} triangles; build {:.3f} s, {:.2f} of Embree's; {:.0f} bytes a triangle ({:.0f} in nodes), "
        "Embree {:.0f}; {} levels\n",
        name, corners.size() / 3, median(ours), median(ours) / median(theirs),
        result["bytes_per_triangle"].get<double>(), result["node_bytes_per_triangle"].get<double>(),
        result["embree_bytes_per_triangle"].get<double>(), packed.treeDepth);
    for (const RaySet& set : raySets(embree, corners, options.width, options.height)) {
        RayIntersector intersector(device, packed, set.question, set.rays.size());
        intersector.upload(set.rays);
        std::vector<RayHit> hits(set.rays.size());
        embree.run(set.rays, set.question, hits);
        intersector.run();  // compiles
        const std::size_t wrong = differing(set.question, intersector.hits(), hits);
        std::vector<double> mine, other, ratios, cpuRatios;
        for (int run = 0; run < options.runs; ++run) {
            const Cost theirCost = costOf([&] { embree.run(set.rays, set.question, hits); });
            const Cost ourCost = costOf([&] { intersector.run(); });
            other.push_back(theirCost.wall);
            mine.push_back(ourCost.wall);
            ratios.push_back(theirCost.wall / ourCost.wall);
            cpuRatios.push_back(theirCost.cpu / ourCost.cpu);
        }
        const double rays = double(set.rays.size()) * 1e-6;
        fmt::print(
            "  {:<9} {:>8} rays  {:7.2f} Mray/s  Embree {:7.2f}  ratio {:.3f} (CPU time {:.3f})  differ {}\n",
            set.name, set.rays.size(), rays / median(mine), rays / median(other), median(ratios),
            median(cpuRatios), wrong);
        if (intersector.abandoned() > 0) fmt::print("  {} rays given up\n", intersector.abandoned());
        std::fflush(stdout);
        result["rows"].push_back({{"rays", set.name},
                                  {"count", set.rays.size()},
                                  {"mrays", rays / median(mine)},
                                  {"embree_mrays", rays / median(other)},
                                  {"ratio", median(ratios)},
                                  {"cpu_ratio", median(cpuRatios)},
                                  {"differ", wrong}});
    }
    return result;
}

int run(int argc, char** argv) {
    CLI::App app("Traversal against Embree's");
    Options options;
    std::string size = "1280x704", json;
    double counts = 0;
    std::vector<std::string> assets, only;
    app.add_option("--runs", options.runs, "interleaved pairs")->check(CLI::PositiveNumber);
    app.add_option("--tree", options.tree, "bvh; sbvh: with spatial splits; lbvh: built on the device")
        ->check(CLI::IsMember({"bvh", "sbvh", "lbvh"}));
    app.add_option("--size", size, "pixels of the camera, multiples of 8");
    app.add_option("--json", json, "file for the results");
    app.add_option("--counts", counts, "also cost against the number of triangles, 10^2 to this");
    app.add_option("--only", only, "knot, landscape or assets")->delimiter(',');
    app.add_option("assets", assets, "scenes to load");
    CLI11_PARSE(app, argc, argv);
    if (std::sscanf(size.c_str(), "%ux%u", &options.width, &options.height) != 2) return 1;
    if (assets.empty())
        for (const char* path : {"assets/gltf/FlightHelmet/FlightHelmet.gltf", "assets/meshes/spot/spot.obj"})
            assets.push_back((std::filesystem::path(HELIOGRAPH_SHARED_DIR) / path).string());
    const auto wanted = [&](const char* name) { return only.empty() || std::ranges::count(only, name) > 0; };

    Device device;
    fmt::print("{}, {} threads, {} pairs\n", device.info().name, std::thread::hardware_concurrency(),
               options.runs);
    nlohmann::json results = nlohmann::json::array();
    if (wanted("knot")) results.push_back(measure(device, "knot", test::sceneOf(test::knot()), options));
    if (wanted("landscape"))
        results.push_back(measure(device, "landscape", test::sceneOf(test::landscape(1000000)), options));
    if (wanted("assets"))
        for (const std::string& asset : assets) {
            try {
                results.push_back(
                    measure(device, std::filesystem::path(asset).filename().string(), load(asset), options));
            } catch (const InputError& error) {
                fmt::print("left out: {}\n", error.what());
            }
        }
    for (double count = 100; count <= counts; count *= 10)
        results.push_back(measure(device, fmt::format("cloud {:.0e}", count),
                                  test::sceneOf(test::cloud(std::size_t(count))), options));
    if (!json.empty()) std::ofstream(json) << results.dump(2) << "\n";
    return 0;
}

}  // namespace
}  // namespace helio::bench

int main(int argc, char** argv) {
    try {
        return helio::bench::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
