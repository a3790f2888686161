#pragma once
/** @file One call of Renderer::render: what both pipelines are given and fill in. */
#include "passes/renderer/process_clock.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <optional>
#include <string>
#include <vector>

namespace helio {

class RenderJob {
public:
    explicit RenderJob(const RenderOptions& renderOptions)
        : options(renderOptions), setup_(Stopwatch::sinceProcessStartOnce()) {}

    const RenderOptions& options;
    RenderResult result;
    std::string graphviz;

    /** Tells the application; false where it cancels, which is also noted in the result. */
    bool notify(const Progress& progress) {
        if (options.progress && !options.progress(progress)) result.cancelled = true;
        return !result.cancelled;
    }
    /** Set-up ends, rendering begins. */
    void beginRendering() {
        result.setupSeconds = setup_.seconds() - charged_;
        result.setupCpuSeconds = setup_.cpuSeconds() - chargedCpu_;
        rendering_.emplace();
    }
    /** Seconds of rendering so far, those before a checkpoint included. */
    double seconds() const { return earlier_ + (rendering_ ? charged_ + rendering_->seconds() : 0); }
    double cpuSeconds() const {
        return earlierCpu_ + (rendering_ ? chargedCpu_ + rendering_->cpuSeconds() : 0);
    }
    /** Work of rendering that was done while setting up. */
    void charge(double seconds, double cpuSeconds) {
        charged_ += seconds;
        chargedCpu_ += cpuSeconds;
    }
    /** The render goes on from where another process left it. */
    void goOnAfter(double seconds, double cpuSeconds) {
        earlier_ = seconds;
        earlierCpu_ = cpuSeconds;
    }
    /** Notes the times; whoever was cancelled before rendering has all of it as set-up. */
    void finish() {
        if (!rendering_) beginRendering();
        result.seconds = seconds();
        result.renderCpuSeconds = cpuSeconds();
    }
    /** Adds device times, summed by name. */
    void addTimings(const std::vector<PassTiming>& timings);

private:
    Stopwatch setup_;
    std::optional<Stopwatch> rendering_;
    double earlier_ = 0, earlierCpu_ = 0, charged_ = 0, chargedCpu_ = 0;
};

}  // namespace helio
