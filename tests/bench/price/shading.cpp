#include "tests/bench/price/shading.hpp"

#include "passes/raster/push.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/raster_render.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/shade/shade.hpp"
#include "tests/bench/price/contender.hpp"
#include "tests/bench/price/ratios.hpp"

#include <heliograph_kernels/price.hpp>

#include <memory>

namespace helio::test {
namespace {

/** A plan that shades the same keys again and again. */
struct Shader {
    Plan plan;
    Readback<std::int32_t> ids;
    Readback<float> color, albedoDepth, normal;

    void finish(Graph& graph, const ShadeOutput& output, bool whole) {
        ids = graph.readback<std::int32_t>(output.ids);
        if (whole) {
            color = graph.readback<float>(output.color);
            albedoDepth = graph.readback<float>(output.albedoDepth);
            normal = graph.readback<float>(output.normal);
        }
        plan = graph.compile({.executionsInFlight = 1});
        plan.wait(plan.execute());  // compiles
    }
    double run(std::uint32_t runs) {
        const double start = bench::cpuSeconds();
        for (std::uint32_t k = 0; k < runs; ++k) plan.wait(plan.execute());
        return bench::cpuSeconds() - start;
    }
    bool showsTheSameAs(Shader& other) {
        const Execution a = plan.execute(), b = other.plan.execute();
        return ids.wait(a) == other.ids.wait(b) && color.wait(a) == other.color.wait(b) &&
               albedoDepth.wait(a) == other.albedoDepth.wait(b) && normal.wait(a) == other.normal.wait(b);
    }
};

}  // namespace

int compareShading(std::uint32_t pairs, std::uint32_t runs, std::uint32_t size) {
    const Scene scene = load("sample:cornell");
    const View chosen = chooseView(scene, "", 1.0);
    const auto view =
        std::make_shared<const RasterView>(makeRasterView(chosen.transform, chosen.camera, {size, size}));
    Device device{DeviceOptions{}};
    DeviceScene packed(device, scene, rasterPackOptions());
    ShadePipeline shade(device, packed);
    DeviceBuffer keys(device, "price.keys", std::uint64_t(size) * size * 8);
    {
        Graph graph(device);
        const Buffer visibility = graph.import(keys),
                     counters = graph.buffer("price.counters", {sizeof(RasterCounters)});
        graph.fill("price.clear", visibility, 0);
        graph.fill("price.clearCounters", counters, 0);
        RasterPipeline(device).declare(graph, shade.triangles(graph), view, {visibility, 0, counters});
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    const auto general = [&](Shader& shader, bool whole) {
        Graph graph(device);
        shader.finish(graph, shade.declare(graph, {graph.import(keys), {}}, view), whole);
    };
    const auto stripped = [&](Shader& shader, bool whole) {
        Graph graph(device);
        const std::uint64_t pixels = std::uint64_t(size) * size;
        const ShadeOutput output{
            graph.buffer("price.color", {pixels * 16}), graph.buffer("price.albedoDepth", {pixels * 16}),
            graph.buffer("price.normal", {pixels * 16}), graph.buffer("price.ids", {pixels * 8})};
        graph.compute("price.stripped", shaders::strippedShade)
            .reads({{"uVisibility", graph.import(keys)}})
            .reads(packed.bindings(graph, {"uTriangles", "uMaterials", "uLights", "uInstanceFirst"}))
            .overwrites({{"uColor", output.color},
                         {"uAlbedoDepth", output.albedoDepth},
                         {"uNormal", output.normal},
                         {"uIds", output.ids}})
            .record([view, size](Commands& c) {
                c.push(makeRasterPush(*view, 0, 0, 1)).dispatchOver(size, size);
            });
        shader.finish(graph, output, whole);
    };
    Shader one, other, oneWhole, otherWhole;
    general(one, false);
    stripped(other, false);
    general(oneWhole, true);
    stripped(otherWhole, true);
    printRatios(
        pairs, runs, "pictures", [&] { return one.run(runs); }, [&] { return other.run(runs); });
    const bool same = oneWhole.showsTheSameAs(otherWhole);
    fmt::print("pictures {}\n", same ? "equal to the bit" : "differ");
    return same ? 0 : 1;
}

}  // namespace helio::test
