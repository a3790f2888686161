#include "passes/renderer/raster_render.hpp"
#include "passes/renderer/raster_samples.hpp"

#include <algorithm>

namespace helio {

void RasterSession::makeLayers(Device& device) {
    layerView_ = std::make_shared<RasterView>(*view_);
    layers_ = std::make_unique<AlphaLayers>(device, raster_, shade_, layerView_);
    layers_->draw();  // the driver compiles at the first dispatch
    const std::uint32_t pixels = size_[0] * size_[1];
    Graph graph(device);
    const Buffer color = graph.import(layers_->color());
    if (kind_ == Kind::Supersampling) {
        sum_.emplace(device, "raster.sum", std::uint64_t(pixels) * 16);
        declareAdd(graph, color, graph.import(*sum_), pixels, weight_);
        samplePlan_ = graph.compile({.executionsInFlight = 1});
        samplePlan_.wait(samplePlan_.execute());
    } else {
        color_ = graph.readback<float>(kind_ == Kind::Fxaa ? declareFxaa(graph, color, size_) : color);
        plan_ = graph.compile({.executionsInFlight = 1});
        plan_.wait(plan_.execute());
    }
}

void RasterSession::drawLayers(const RasterView& view, RenderJob& job) {
    *layerView_ = view;
    const AlphaLayers::Drawing drawing =
        layers_->draw([&](const std::vector<PassTiming>& times) { job.addTimings(times); });
    drawn_.layers = std::max(drawn_.layers, drawing.layers);
    drawn_.open = std::max(drawn_.open, drawing.open);
    drawn_.pictures = std::max(drawn_.pictures, drawing.pictures);
    for (const RasterCounters& counters : drawing.counters) addWork(counters);
    shaded_ += std::uint64_t(size_[0]) * size_[1] * drawing.layers;
}

void RasterSession::drawMaskedSamples(RenderJob& job) {
    const std::uint64_t keys = rasterStride(size_[0], size_[1]) / 8;
    drawn_ = {};
    for (std::size_t k = 0; k < sampleCount_; ++k) {
        *maskView_ = *sampleViews_[k];
        const AlphaLayers::Drawing drawing =
            masks_->draw(k * keys, [&](const std::vector<PassTiming>& times) { job.addTimings(times); });
        drawn_.layers = std::max(drawn_.layers, drawing.layers);
        drawn_.open = std::max(drawn_.open, drawing.open);
        for (const RasterCounters& counters : drawing.counters) addWork(counters);
    }
}

bool RasterSession::layeredPicture(const RasterView& view, const std::optional<ThinLens>& lens,
                                   RenderJob& job, std::vector<float>& color) {
    drawn_ = {};
    if (kind_ != Kind::Supersampling) {
        drawLayers(view, job);
        const Execution done = plan_.execute();
        color = color_.wait(done);
        job.addTimings(plan_.timings(done));
        return true;
    }
    const std::vector<std::array<float, 2>>& positions = job.options.antialiasing.positions;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        drawLayers(shiftedView(sampleView(view, lens, k), positions[k]), job);
        *weight_ = {1.0f / float(positions.size()), k == 0};
        const Execution done = samplePlan_.execute();
        samplePlan_.wait(done);
        job.addTimings(samplePlan_.timings(done));
        if (!notifySample(job, k + 1, positions.size())) return false;
    }
    color.resize(std::size_t(size_[0]) * size_[1] * 4);
    sum_->download(color.data(), color.size() * 4);
    return true;
}

}  // namespace helio
