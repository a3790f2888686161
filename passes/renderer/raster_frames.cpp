#include "passes/renderer/raster_render.hpp"
#include "passes/renderer/raster_samples.hpp"

namespace helio {

void RasterSession::makeTemporalPlan(Device& device, const TemporalStep& step) {
    sampleViews_.push_back(std::make_shared<RasterView>(history_->frameView(*view_)));
    if (shade_.seesThrough()) {
        layerView_ = std::make_shared<RasterView>(*sampleViews_[0]);
        layers_ = std::make_unique<AlphaLayers>(device, raster_, shade_, layerView_);
        layers_->draw();
        if (auxiliary_) hitLayers_ = std::make_unique<AlphaLayers>(device, raster_, shade_, view_);
    } else if (auxiliary_) {
        makeCentrePlan(device);
    }
    Graph graph(device);
    const RasterTriangles triangles = shade_.triangles(graph);
    // Where surfaces let light through, the nearest one says what moves.
    const RasterOutput visible = raster_.declare(graph, triangles, sampleViews_[0], clusters_.get());
    const Buffer color =
        layers_ ? graph.import(layers_->color()) : shade_.declare(graph, visible, sampleViews_[0]).color;
    const Buffer picture =
        history_->declare(graph, {visible.visibility, color, triangles.buffer}, sampleViews_[0]);
    sampleColor_ = graph.readback<float>(picture);
    counters_ = graph.readback<RasterCounters>(visible.counters);
    samplePlan_ = graph.compile({.executionsInFlight = 1});
    // The driver compiles at the first dispatch; later frames would lose their history to it.
    if (step.frame == 0) samplePlan_.wait(samplePlan_.execute());
}

bool RasterSession::drawFrame(const RasterView& view, RenderJob& job, const TemporalStep& step,
                              std::vector<float>& color) {
    const Antialiasing& how = job.options.antialiasing;
    const std::array<float, 2>& position = how.positions[step.frame % how.positions.size()];
    const RasterView centre = history_->frameView(view);
    *sampleViews_[0] = shiftedView(centre, position);
    if (step.frame == 0) {
        work_ = {};
        shaded_ = corners_ = 0;
        drawn_ = {};
        job.beginRendering();
    }
    history_->beginFrame(centre, position, how.temporal.blend, step.sceneChanged);
    if (layers_) drawLayers(*sampleViews_[0], job);
    const Execution done = samplePlan_.execute();
    samplePlan_.wait(done);
    job.addTimings(samplePlan_.timings(done));
    addWork(counters_.wait(done).at(0));
    if (!layers_) shaded_ += std::uint64_t(centre.width) * centre.height;
    const bool goesOn = notifySample(job, step.frame + 1, step.frames);
    if (goesOn && step.frame + 1 < step.frames) return false;
    color = sampleColor_.wait(done);
    return true;
}

}  // namespace helio
