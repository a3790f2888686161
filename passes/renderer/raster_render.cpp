#include "passes/renderer/raster_render.hpp"

#include "passes/pathtrace/camera_frame.hpp"
#include "passes/renderer/raster_samples.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

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

/** What the options ask for that rasterization has no use for. */
void noteUnused(const RenderOptions& options, RenderResult& result) {
    const auto skip = [&](const char* what, const char* why) { result.skipped.emplace_back(what, why); };
    const bool sampled = !options.antialiasing.positions.empty();
    const char* why = sampled ? "the raster pipeline's samples are those of its antialiasing"
                              : "the raster pipeline takes one sample at each pixel's centre";
    if (options.samples > 1) skip("samples", why);
    if (options.filter != PixelFilter::Box) skip("pixel filter", why);
    if (options.maxDepth >= 0) skip("depth limit", "the raster pipeline shades direct light only");
}

}  // namespace

PackOptions rasterPackOptions() {
    return {.tree = false,
            .sampleSurfaces = true,
            .shapesAsTriangles = true,
            .occlusion = true,
            .diffuseEnvironment = true};
}

RasterSession::RasterSession(Device& device, PreparedScene& scene, const RasterView& view,
                             const RenderOptions& options, const TemporalStep& step)
    : size_(options.size),
      cull_(options.cullBackFaces),
      auxiliary_(options.auxiliary),
      asked_(options.antialiasing.kind),
      kind_(asked_),
      sampleCount_(options.antialiasing.positions.size()),
      view_(std::make_shared<RasterView>(view)),
      depth_(options.depthFormat),
      raster_(device, {.cullBackFaces = options.cullBackFaces, .depth = options.depthFormat}),
      shadows_(options.shadows),
      filter_(options.textureFilter),
      lightSamples_(options.lightSamples),
      shading_(options.shading),
      shade_(device, scene.deviceScene, scene.bounds, options.shadows, options.textureFilter,
             options.lightSamples, options.shading) {
    if (kind_ == Kind::Multisampling && (shade_.blends() || shade_.transmits())) kind_ = Kind::Supersampling;
    makeMips(device);
    makeShadows(device);
    if (step.frame == 0) makeClusters(device, scene.deviceScene);
    if (kind_ == Kind::Temporal) {
        history_ = step.history;
        makeTemporalPlan(device, step);
        return;
    }
    const bool sampled = kind_ == Kind::Supersampling || kind_ == Kind::Multisampling;
    if (shade_.seesThrough() && kind_ != Kind::Multisampling) {
        makeLayers(device);
        return;
    }
    if (!sampled || auxiliary_) {
        if (shade_.seesThrough())
            hitLayers_ = std::make_unique<AlphaLayers>(device, raster_, shade_, view_);
        else
            makeCentrePlan(device);
    }
    if (kind_ == Kind::Supersampling) makeSupersamplePlan(device);
    if (kind_ == Kind::Multisampling) makeMultisamplePlan(device);
}

bool RasterSession::fits(const RasterView& view, const RenderOptions& options,
                         const TemporalStep& step) const {
    return options.size == size_ && step.history == history_ && options.cullBackFaces == cull_ &&
           options.auxiliary == auxiliary_ && options.antialiasing.kind == asked_ &&
           options.antialiasing.positions.size() == sampleCount_ && options.textureFilter == filter_ &&
           options.lightSamples == lightSamples_ && options.depthFormat == depth_ &&
           options.shading == shading_ && options.shadows.kind == shadows_.kind &&
           options.shadows.resolution == shadows_.resolution &&
           options.shadows.filterRadius == shadows_.filterRadius &&
           options.shadows.lightSize == shadows_.lightSize && view.orthographic == view_->orthographic;
}

void RasterSession::makeShadows(Device& device) {
    openTexels_ = drawShadowMaps(device, shade_);
}

/** Culling what is hidden, where several images are drawn of a large scene most of which is. */
void RasterSession::makeClusters(Device& device, DeviceScene& scene) {
    constexpr std::uint32_t least = 1u << 16;
    const bool several = kind_ == Kind::Temporal || (kind_ == Kind::Supersampling && !shade_.seesThrough());
    if (!several || scene.info().triangleCount < least) return;
    const auto triangles = [&](Graph& graph) { return shade_.triangles(graph); };
    clusters_ = std::make_unique<RasterClusters>(device, triangles);
    Graph graph(device);
    const RasterOutput output = raster_.declare(graph, triangles(graph), view_, clusters_.get());
    const Readback<RasterCounters> counters = graph.readback<RasterCounters>(output.counters);
    Plan plan = graph.compile({.executionsInFlight = 1});
    plan.wait(plan.execute());  // says what shows
    const RasterCounters work = counters.wait(plan.execute()).at(0);
    if (2 * work.hidden < work.triangles) clusters_.reset();
}

void RasterSession::makeCentrePlan(Device& device) {
    Graph graph(device);
    const RasterOutput visible = raster_.declare(graph, shade_.triangles(graph), view_, clusters_.get());
    const ShadeOutput shaded = shade_.declare(graph, visible, view_);
    color_ =
        graph.readback<float>(kind_ == Kind::Fxaa ? declareFxaa(graph, shaded.color, size_) : shaded.color);
    if (auxiliary_) {
        albedoDepth_ = graph.readback<float>(shaded.albedoDepth);
        normal_ = graph.readback<float>(shaded.normal);
        ids_ = graph.readback<std::int32_t>(shaded.ids);
    }
    counters_ = graph.readback<RasterCounters>(visible.counters);
    plan_ = graph.compile({.executionsInFlight = 1});
    plan_.wait(plan_.execute());  // the driver compiles at the first dispatch
}

void RasterSession::makeSupersamplePlan(Device& device) {
    const std::uint32_t pixels = size_[0] * size_[1];
    sampleViews_.push_back(std::make_shared<RasterView>(*view_));
    sum_.emplace(device, "raster.sum", std::uint64_t(pixels) * 16);
    Graph graph(device);
    const RasterOutput visible =
        raster_.declare(graph, shade_.triangles(graph), sampleViews_[0], clusters_.get());
    const ShadeOutput shaded = shade_.declare(graph, visible, sampleViews_[0]);
    declareAdd(graph, shaded.color, graph.import(*sum_), pixels, weight_);
    counters_ = graph.readback<RasterCounters>(visible.counters);
    samplePlan_ = graph.compile({.executionsInFlight = 1});
    samplePlan_.wait(samplePlan_.execute());
}

/** The keys of all samples, as declareMultisample takes them. */
void RasterSession::declareSamples(Graph& graph, Buffer visibility, std::uint64_t stride) {
    const Buffer counters = graph.buffer("raster.counters", {sizeof(RasterCounters)});
    graph.fill("raster.clear", visibility, 0);
    graph.fill("raster.clearCounters", counters, 0);
    for (std::size_t k = 0; k < sampleCount_; ++k)
        raster_.declare(graph, shade_.triangles(graph), sampleViews_[k], {visibility, k * stride, counters});
    counters_ = graph.readback<RasterCounters>(counters);
}

void RasterSession::makeMultisamplePlan(Device& device) {
    const std::uint64_t stride = rasterStride(size_[0], size_[1]), bytes = stride * sampleCount_;
    if (bytes > device.info().maxStorageBufferRange)
        throw InputError("", "antialiasing",
                         fmt::format("{} samples of {}x{} pixels are more than the device binds at once",
                                     sampleCount_, size_[0], size_[1]),
                         fmt::format("choose fewer samples or at most {} pixels",
                                     device.info().maxStorageBufferRange / (8 * sampleCount_)));
    if (shade_.masks()) {
        sampleKeys_.emplace(device, "raster.sampleKeys", bytes);
        maskView_ = std::make_shared<RasterView>(*view_);
        masks_ = std::make_unique<AlphaMasks>(device, raster_, shade_, *sampleKeys_, maskView_, filter_);
    }
    Graph graph(device);
    const Buffer visibility =
        masks_ ? graph.import(*sampleKeys_) : graph.buffer("raster.visibility", {bytes});
    for (std::size_t k = 0; k < sampleCount_; ++k)
        sampleViews_.push_back(std::make_shared<RasterView>(*view_));
    if (!masks_) declareSamples(graph, visibility, stride);
    const MultisampleOutput shaded =
        shade_.declareMultisample(graph, visibility, std::uint32_t(sampleCount_), view_);
    sampleColor_ = graph.readback<float>(shaded.color);
    shadings_ = graph.readback<std::uint32_t>(shaded.shadings);
    samplePlan_ = graph.compile({.executionsInFlight = 1});
    if (masks_) masks_->draw(0);
    samplePlan_.wait(samplePlan_.execute());
}

void RasterSession::makeMips(Device& device) {
    if (!shade_.mips().needed()) return;
    Graph graph(device);
    shade_.declareMips(graph);
    Plan plan = graph.compile();
    plan.wait(plan.execute());
}

bool RasterSession::picture(const RasterView& view, const std::optional<ThinLens>& lens, RenderJob& job,
                            std::vector<float>& color) {
    const std::vector<std::array<float, 2>>& positions = job.options.antialiasing.positions;
    work_ = {};
    corners_ = 0;
    shaded_ = 0;
    if (layers_) return layeredPicture(view, lens, job, color);
    if (kind_ == Kind::Supersampling) {
        for (std::size_t k = 0; k < positions.size(); ++k) {
            *sampleViews_[0] = shiftedView(sampleView(view, lens, k), positions[k]);
            *weight_ = {1.0f / float(positions.size()), k == 0};
            const Execution done = samplePlan_.execute();
            addWork(counters_.wait(done).at(0));
            job.addTimings(samplePlan_.timings(done));
            if (!notifySample(job, k + 1, positions.size())) return false;
        }
        color.resize(std::size_t(size_[0]) * size_[1] * 4);
        sum_->download(color.data(), color.size() * 4);
        shaded_ = std::uint64_t(size_[0]) * size_[1] * positions.size();
        return true;
    }
    for (std::size_t k = 0; k < sampleViews_.size(); ++k) *sampleViews_[k] = shiftedView(view, positions[k]);
    if (masks_) drawMaskedSamples(job);
    Plan& plan = kind_ == Kind::Multisampling ? samplePlan_ : plan_;
    const Execution done = plan.execute();
    color = (kind_ == Kind::Multisampling ? sampleColor_ : color_).wait(done);
    if (!masks_) addWork(counters_.wait(done).at(0));
    shaded_ = std::uint64_t(size_[0]) * size_[1];
    if (kind_ == Kind::Multisampling) {
        const std::vector<std::uint32_t> shadings = shadings_.wait(done);
        shaded_ = std::accumulate(shadings.begin(), shadings.end(), std::uint64_t(0));
    }
    job.addTimings(plan.timings(done));
    return true;
}

void RasterSession::addWork(const RasterCounters& counters) {
    const auto* from = reinterpret_cast<const std::uint64_t*>(&counters);
    auto* to = reinterpret_cast<std::uint64_t*>(&work_);
    for (std::size_t i = 0; i < sizeof counters / 8; ++i) to[i] += from[i];
    corners_ += shade_.cornersShaded();
}

RasterSession::Auxiliary RasterSession::auxiliary(const RasterView& view, RenderJob& job) {
    const bool sampled = kind_ != Kind::None && kind_ != Kind::Fxaa;
    Auxiliary hits;
    if (layers_ || hitLayers_) {
        if (hitLayers_)
            hitLayers_->draw();
        else if (sampled)
            drawLayers(view, job);
        AlphaLayers& layers = hitLayers_ ? *hitLayers_ : *layers_;
        const std::size_t pixels = std::size_t(size_[0]) * size_[1];
        hits.albedoDepth.resize(pixels * 4);
        hits.normal.resize(pixels * 4);
        hits.ids.resize(pixels * 2);
        layers.albedoDepth().download(hits.albedoDepth.data(), pixels * 16);
        layers.normal().download(hits.normal.data(), pixels * 16);
        layers.ids().download(hits.ids.data(), pixels * 8);
        return hits;
    }
    const Execution centre = plan_.execute();
    hits = {albedoDepth_.wait(centre), normal_.wait(centre), ids_.wait(centre)};
    if (sampled) job.addTimings(plan_.timings(centre));
    return hits;
}

void RasterSession::addAuxiliary(Frame& frame, const Auxiliary& hits, std::uint32_t sampleCount) const {
    const auto& [albedoDepth, normal, ids] = hits;
    frame.add({"albedo.R", "albedo.G", "albedo.B"}, albedoDepth.data(), 4);
    frame.add({"normal.X", "normal.Y", "normal.Z"}, normal.data(), 4);
    frame.add({"depth.Z"}, albedoDepth.data(), 4, 3);
    const std::vector<float> id(ids.begin(), ids.end());
    frame.add({"id.instance", "id.triangle"}, id.data(), 2);
    const std::vector<float> zero(ids.size() / 2, 0.0f), samples(ids.size() / 2, float(sampleCount));
    for (const char* name : {"variance.R", "variance.G", "variance.B"}) frame.add({name}, zero.data(), 1);
    frame.add({"samples"}, samples.data(), 1);
}

void RasterSession::noteCounters(RenderResult& result) const {
    result.counters = {{"triangles", work_.triangles},
                       {"triangles_outside", work_.outside},
                       {"triangles_back_facing", work_.backFacing},
                       {"triangles_empty", work_.empty},
                       {"triangles_small", work_.small},
                       {"triangles_large", work_.large},
                       {"triangles_clipped", work_.clipped},
                       {"clipped_parts", work_.parts},
                       {"small_pixels_visited", work_.smallVisited},
                       {"small_pixels_covered", work_.smallCovered},
                       {"tile_entries", work_.entries},
                       {"tile_triangles_visited", work_.tileVisited},
                       {"pixels_shaded", shaded_}};
    if (clusters_) {
        result.counters.emplace_back("triangles_hidden", work_.hidden);
        result.counters.emplace_back("clusters", work_.clusters);
        result.counters.emplace_back("clusters_outside", work_.clustersOutside);
        result.counters.emplace_back("clusters_hidden", work_.clustersHidden);
    }
    if (layers_ || masks_) result.counters.emplace_back("alpha_layers", drawn_.layers);
    if (layers_ && shade_.transmits()) result.counters.emplace_back("refraction_pictures", drawn_.pictures);
    if (corners_ > 0) result.counters.emplace_back("corners_shaded", corners_);
}

void RasterSession::render(const RasterView& view, const std::optional<ThinLens>& lens, RenderJob& job,
                           const TemporalStep& step) {
    *view_ = view;
    const bool sampled = kind_ != Kind::None && kind_ != Kind::Fxaa;
    job.graphviz =
        layers_ && kind_ != Kind::Temporal ? layers_->graphviz() : (sampled ? samplePlan_ : plan_).graphviz();
    RenderResult& result = job.result;
    std::vector<float> color;
    if (kind_ == Kind::Temporal) {
        if (!drawFrame(view, job, step, color)) return;
    } else {
        job.beginRendering();
        if (!picture(view, lens, job, color)) return job.finish();
    }
    Auxiliary hits;
    if (auxiliary_) hits = auxiliary(view, job);
    job.finish();

    Frame frame(size_[0], size_[1]);
    frame.add({"R", "G", "B"}, color.data(), 4);
    result.samples =
        kind_ == Kind::Temporal ? step.frame + 1 : std::uint32_t(std::max<std::size_t>(sampleCount_, 1));
    if (auxiliary_) addAuxiliary(frame, hits, result.samples);
    result.image = frame.image();
    result.nanCount = std::uint64_t(std::ranges::count_if(color, [](float x) { return x != x; }));
    if (result.nanCount > 0) {
        result.warnings.push_back(
            fmt::format("{} colour values of the picture are not numbers", result.nanCount));
    }
    if (drawn_.open > 0) {
        result.warnings.push_back(fmt::format("{} pixels have more than {} layers that let light through",
                                              drawn_.open, AlphaLayers::kMaxLayers));
    }
    if (openTexels_ > 0)
        result.warnings.push_back(
            fmt::format("{} texels of shadow maps have more than {} masked surfaces one behind another",
                        openTexels_, AlphaLayers::kMaxLayers));
    if (asked_ == Kind::Multisampling && kind_ == Kind::Supersampling)
        result.skipped.emplace_back("multisampling",
                                    "where surfaces let light through every sample is shaded by itself");
    for (const auto& skipped : shade_.skipped()) result.skipped.push_back(skipped);
    noteUnused(job.options, result);
    if (lens && kind_ != Kind::Supersampling) {
        result.skipped.emplace_back("thin lens",
                                    "the raster pipeline takes a point of the lens for each sample of ssaaN, "
                                    "gridN, jitterN and randomN antialiasing; shown from its middle");
    }
    noteCounters(result);
    if (kind_ == Kind::Temporal) return;  // the application has been told of every frame
    job.notify({.stage = "render",
                .fraction = 1,
                .samples = result.samples,
                .seconds = job.seconds(),
                .secondsLeft = 0});
}

void renderRaster(Device& device, PreparedScene& scene, const View& view, RenderJob& job,
                  const TemporalStep& step) {
    if (view.camera.projection != Projection::Plane)
        throw InputError("", view.camera.name.empty() ? "camera" : fmt::format("camera {}", view.camera.name),
                         "is a panorama or a fisheye, which the raster pipeline cannot draw",
                         "use the path pipeline");
    const double farthest = farthestDistance(view.transform, scene.bounds);
    // The default near distance comes from the camera's znear, which a tiny scene may lie wholly before.
    const bool isTiny = view.camera.perspective && farthest < double(view.camera.znear);
    double nearest = isTiny ? 1e-6 * farthest : 0;
    // The conventional formats are those of the camera's own range, for better or worse.
    const bool conventional = job.options.depthFormat != DepthFormat::Reversed;
    const double znear = double(view.camera.znear), zfar = double(view.camera.zfar);
    if (conventional && view.camera.perspective && !isTiny && znear > 0) nearest = znear;
    RasterView rasterView = makeRasterView(view.transform, view.camera, job.options.size, nearest, farthest);
    if (conventional && view.camera.perspective)
        conventionalDepth(rasterView, std::isfinite(zfar) && zfar > 0 ? zfar : farthest);
    if (!scene.raster || !scene.raster->fits(rasterView, job.options, step)) {
        scene.raster.reset();
        scene.raster = std::make_unique<RasterSession>(device, scene, rasterView, job.options, step);
    }
    if (step.frame == 0 && !job.notify({.stage = "compile"})) return;
    if (view.camera.lensTable)
        job.result.skipped.emplace_back("lens table",
                                        "the raster pipeline shows a pinhole of the camera's field of view");
    scene.raster->render(rasterView, hasLens(view.camera) ? view.camera.lens : std::nullopt, job, step);
}

}  // namespace helio
