#include "passes/renderer/sample_schedule.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace helio {
namespace {

constexpr std::uint64_t firstBatchPaths = 1u << 22;    // about a second where tracing is quick
constexpr std::uint32_t longestBatch = 1024;           // samples per pixel; the film takes 4096
constexpr std::uint32_t longestAdaptiveBatch = 256;    // on average, a pixel's is up to 16 times as long
constexpr double fewestTurns = 64, mostTurns = 30000;  // of PathTracer

}  // namespace

SampleSchedule::SampleSchedule(const RenderOptions& options)
    : samples_(options.samples),
      limit_(options.adaptive ? longestAdaptiveBatch : longestBatch),
      growth_(4),
      maxSeconds_(options.maxSeconds),
      maxError_(options.maxError) {
    const std::uint64_t pixels = std::uint64_t(options.size[0]) * options.size[1];
    first_ = std::uint32_t(std::clamp<std::uint64_t>(firstBatchPaths / pixels, 1, 64));
    if (options.maxError > 0) {
        // The error is known only at the ends: 8 samples are the fewest that are judged.
        first_ = std::min(first_, 8u);
        growth_ = 2;
    }
    if (maxSeconds_ > 0) first_ = 1;
}

void SampleSchedule::judged(std::uint32_t reached, const ErrorEstimate& error) {
    judgedAt_ = reached;
    highest_ = error.high;
}

std::uint64_t SampleSchedule::untilErrorLimit(std::uint32_t reached) const {
    // Errors fall as N^-1 (independent samples) to about N^-1.2 (Owen-scrambled Sobol), and the interval
    // narrows as well: by a steeper law the limit is met too early rather than too late, and small steps do
    // the rest.
    constexpr double slope = 1.25, smallestStep = 1.08, largestStep = 2;
    const double step = std::pow(highest_ / maxError_, 1 / slope);
    // Below the limit already, but not believed yet: it may be at any number, and a fifth more is allowed.
    constexpr double disbelievedStep = 1.19;
    const bool isMet = highest_ < maxError_;
    const double wanted = std::isfinite(step) ? std::clamp(step, smallestStep, largestStep) : largestStep;
    const double growth = isMet ? disbelievedStep : wanted;
    const std::uint64_t end = reached + std::max<std::uint64_t>(1, std::uint64_t((growth - 1) * reached));
    // Sobol's errors are least at powers of two: none is passed by.
    return std::min(end, std::bit_ceil(std::uint64_t(reached) + 1));
}

std::uint32_t SampleSchedule::next(std::uint32_t reached, double seconds) const {
    if (reached >= samples_) return reached;
    std::uint64_t end = first_;
    // Follows the sequence of ends from its start, so that it is the same whatever was reached when.
    while (end <= reached) end = std::min(std::uint64_t(double(end) * growth_ + 0.5), end + limit_);
    if (judgedAt_ == reached && reached > 0)
        end = std::min(untilErrorLimit(reached), std::uint64_t(reached) + limit_);
    if (maxSeconds_ > 0 && reached > 0) {
        if (seconds >= maxSeconds_) return reached;
        const double perSample = seconds / reached, left = maxSeconds_ - seconds;
        if (perSample > left) return reached;  // not even one more
        const double affordable = std::max(1.0, 0.5 * left / perSample);
        if (affordable < double(end - reached)) end = reached + std::uint64_t(affordable);
    }
    return std::uint32_t(std::min<std::uint64_t>(end, samples_));
}

TurnBudget::TurnBudget(const RenderOptions& options) {
    const double pixels = double(options.size[0]) * options.size[1];
    // Every dispatch loads and stores a few hundred bytes of state per pixel, up to 0.2 microseconds: a
    // tenth.
    target_ = std::max(0.15, 4e-6 * pixels);
    turns_ = std::clamp(target_ / (pixels * 10e-9), fewestTurns, mostTurns);  // a first guess
}

void TurnBudget::took(double seconds) {
    const double change = std::clamp(target_ / std::max(seconds, 1e-6), 0.25, 4.0);
    turns_ = std::clamp(turns_ * change, fewestTurns, mostTurns);
}

}  // namespace helio
