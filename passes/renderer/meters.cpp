#include "passes/renderer/meters.hpp"

#include <heliograph/photometry.hpp>

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

constexpr std::uint32_t kStrata = 16;
/** Samples of each stratum between two looks at whether the application cancels. */
constexpr std::uint32_t kBatch = 256;
constexpr double kPi = 3.14159265358979323846;

/** What the mean radiance over a meter's paths is multiplied by. */
double factorOf(const Meter& meter) {
    const double area = double(meter.width) * double(meter.height);
    switch (meter.quantity) {
        case Meter::Quantity::Irradiance:
            return kPi;
        case Meter::Quantity::Flux:
            return kPi * area;
        case Meter::Quantity::Radiance:
            return 1;
        case Meter::Quantity::Intensity:
            return area;
    }
    return 0;
}

MeterReading readingOf(const Meter& meter, const FilmImages& film) {
    MeterReading reading;
    reading.name = meter.name;
    reading.quantity = meter.quantity;
    const double factor = factorOf(meter), strata = double(film.mean.size()) / 4;
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0, squares = 0, variance = 0;
        for (std::size_t i = c; i < film.mean.size(); i += 4) {
            sum += double(film.mean[i]);
            squares += double(film.mean[i]) * double(film.mean[i]);
            // The half difference's square has the variance's expectation under every sampler.
            variance += double(film.difference[i]) * double(film.difference[i]);
        }
        // Without two halves what strata differ by, which is more.
        if (film.difference[3] == 0) variance = std::max(0.0, squares - sum * sum / strata);
        reading.value[c] = factor * sum / strata;
        reading.error[c] = factor * std::sqrt(variance) / strata;
    }
    const auto& [r, g, b] = reading.value;
    reading.photometric =
        kLuminousEfficacy * (0.2126390058715104 * r + 0.7151686787677559 * g + 0.07219231536073371 * b);
    return reading;
}

}  // namespace

MeterReader::MeterReader(Device& device, PreparedScene& scene, const View& view,
                         const PathTraceOptions& render)
    : view_(view) {
    if (view.meters.empty()) return;
    film_.emplace(device, kStrata, kStrata);
    film_->clear();
    // A meter on a surface reads from before it: by the rounding of points in the scene, as rays that leave.
    const glm::dvec3 extent = glm::max(glm::abs(scene.bounds.lower), glm::abs(scene.bounds.upper));
    for (const auto& [meter, transform] : view.meters) {
        PathTraceOptions options = render;
        options.size = {kStrata, kStrata};
        options.adaptive = false;
        options.bounces = -1;
        options.shutter.rolling = 0;
        options.cameraPoses.clear();
        options.meter = meter;
        if (!scene.bounds.empty()) options.meterExtent = extent;
        tracers_.emplace_back(device, scene.deviceScene, Camera{}, transform, options, film_->film());
        tracers_.back().advance(0);
    }
    film_->resolve();
}

bool MeterReader::read(RenderJob& job) {
    for (std::size_t i = 0; i < tracers_.size(); ++i) {
        film_->clear();
        for (std::uint32_t end = 0; end < job.options.samples;) {
            end = std::min(end + kBatch, job.options.samples);
            while (!tracers_[i].advance(end)) {
                if (!job.notify({.stage = "meters", .fraction = double(i) / double(tracers_.size())}))
                    return false;
            }
        }
        job.result.meters.push_back(readingOf(view_.meters[i].first, film_->resolve()));
    }
    return true;
}

}  // namespace helio
