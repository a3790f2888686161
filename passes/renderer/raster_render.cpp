#include "passes/renderer/raster_render.hpp"

#include "passes/renderer/frame.hpp"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>

namespace helio {
namespace {

/** Farthest distance along the viewing axis at which there is something: what an orthographic depth must tell
 * apart. */
double farthestDistance(const glm::dmat4& camera, const Scene::Bounds& bounds) {
    if (bounds.empty()) return 1;
    const glm::dvec3 eye(camera[3]), forward = -glm::normalize(glm::dvec3(camera[2]));
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point((corner & 1) ? bounds.upper.x : bounds.lower.x,
                               (corner & 2) ? bounds.upper.y : bounds.lower.y,
                               (corner & 4) ? bounds.upper.z : bounds.lower.z);
        farthest = std::max(farthest, glm::dot(point - eye, forward));
    }
    return farthest > 0 ? farthest : 1;
}

/** What the options ask for that one sample per pixel has no use for. */
void noteUnused(const RenderOptions& options, RenderResult& result) {
    const auto skip = [&](const char* what, const char* why) { result.skipped.emplace_back(what, why); };
    if (options.samples > 1) skip("samples", "the raster pipeline takes one sample at each pixel's centre");
    if (options.filter != PixelFilter::Box)
        skip("pixel filter", "the raster pipeline takes one sample at each pixel's centre");
    if (options.maxDepth >= 0) skip("depth limit", "the raster pipeline shades direct light only");
}

}  // namespace

PackOptions rasterPackOptions() {
    return {.tree = false, .sampleSurfaces = true};
}

RasterSession::RasterSession(Device& device, PreparedScene& scene, const RasterView& view,
                             const RenderOptions& options)
    : size_(options.size),
      cull_(options.cullBackFaces),
      view_(std::make_shared<RasterView>(view)),
      raster_(device, {.cullBackFaces = options.cullBackFaces}),
      shade_(device, scene.deviceScene) {
    makeMips(device);
    Graph graph(device);
    const RasterOutput visible = raster_.declare(graph, shade_.triangles(graph), view_);
    const ShadeOutput shaded = shade_.declare(graph, visible, view_);
    color_ = graph.readback<float>(shaded.color);
    albedoDepth_ = graph.readback<float>(shaded.albedoDepth);
    normal_ = graph.readback<float>(shaded.normal);
    ids_ = graph.readback<std::int32_t>(shaded.ids);
    plan_ = graph.compile({.executionsInFlight = 1});
    plan_.wait(plan_.execute());  // the driver compiles at the first dispatch
}

void RasterSession::makeMips(Device& device) {
    if (!shade_.mips().needed()) return;
    Graph graph(device);
    shade_.declareMips(graph);
    Plan plan = graph.compile();
    plan.wait(plan.execute());
}

void RasterSession::render(const RasterView& view, RenderJob& job) {
    *view_ = view;
    job.graphviz = plan_.graphviz();
    RenderResult& result = job.result;
    job.beginRendering();
    const Execution execution = plan_.execute();
    const std::vector<float> color = color_.wait(execution);
    const std::vector<float> albedoDepth = albedoDepth_.wait(execution), normal = normal_.wait(execution);
    const std::vector<std::int32_t> ids = ids_.wait(execution);
    job.finish();

    Frame frame(size_[0], size_[1]);
    frame.add({"R", "G", "B"}, color.data(), 4);
    if (job.options.auxiliary) {
        frame.add({"albedo.R", "albedo.G", "albedo.B"}, albedoDepth.data(), 4);
        frame.add({"normal.X", "normal.Y", "normal.Z"}, normal.data(), 4);
        frame.add({"depth.Z"}, albedoDepth.data(), 4, 3);
        const std::vector<float> id(ids.begin(), ids.end());
        frame.add({"id.instance", "id.triangle"}, id.data(), 2);
        const std::vector<float> one(ids.size() / 2, 1.0f), zero(ids.size() / 2, 0.0f);
        frame.add({"variance.R"}, zero.data(), 1);
        frame.add({"variance.G"}, zero.data(), 1);
        frame.add({"variance.B"}, zero.data(), 1);
        frame.add({"samples"}, one.data(), 1);
    }
    result.image = frame.image();
    result.samples = 1;
    result.nanCount = std::uint64_t(std::ranges::count_if(color, [](float x) { return x != x; }));
    if (result.nanCount > 0) {
        result.warnings.push_back(
            fmt::format("{} colour values of the picture are not numbers", result.nanCount));
    }
    for (const auto& skipped : shade_.skipped()) result.skipped.push_back(skipped);
    noteUnused(job.options, result);
    job.addTimings(plan_.timings(execution));
    job.notify({.stage = "render", .fraction = 1, .samples = 1, .seconds = job.seconds(), .secondsLeft = 0});
}

void renderRaster(Device& device, PreparedScene& scene, const View& view, RenderJob& job) {
    const double farthest = farthestDistance(view.transform, scene.bounds);
    // The default near distance comes from the camera's znear, which a tiny scene may lie wholly before.
    const bool isTiny = view.camera.perspective && farthest < double(view.camera.znear);
    const RasterView rasterView =
        makeRasterView(view.transform, view.camera, job.options.size, isTiny ? 1e-6 * farthest : 0, farthest);
    if (!scene.raster || !scene.raster->fits(rasterView, job.options)) {
        scene.raster.reset();
        scene.raster = std::make_unique<RasterSession>(device, scene, rasterView, job.options);
    }
    if (!job.notify({.stage = "compile"})) return;
    scene.raster->render(rasterView, job);
}

}  // namespace helio
