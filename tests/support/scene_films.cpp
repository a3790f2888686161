#include "tests/support/scene_films.hpp"

#include "passes/renderer/path_render.hpp"

#include <algorithm>

namespace helio::test {

SceneFilms::SceneFilms(Device& device, Scene scene, std::array<std::uint32_t, 2> size, bool adaptive)
    : scene_(std::move(scene)), adaptive_(adaptive), device_(device), target_(device, size[0], size[1]) {
    PathTraceOptions options;
    options.size = size;
    options.adaptive = adaptive;
    const PlacedCamera placed = chooseCamera(scene_, {}, double(size[0]) / size[1]);
    uploaded_ = std::make_unique<DeviceScene>(device, scene_, PathTracer::packOptions(scene_, options));
    options.lightSamples = lightSamples(*uploaded_, scene_.bounds(), glm::dvec3(placed.transform[3]));
    tracer_ = std::make_unique<PathTracer>(device, *uploaded_, scene_.cameras[std::size_t(placed.camera)],
                                           placed.transform, options, target_.film());
}

Denoised SceneFilms::denoised(const FilmImages& film) {
    if (guides_.geometry.empty()) {
        const FirstHits hits = tracer_->firstHits();
        for (std::size_t i = 0; i < hits.depth.size(); ++i) {
            guides_.geometry.emplace_back(hits.normal[i], hits.depth[i]);
            guides_.albedo.emplace_back(hits.albedo[i], hits.instance[i] >= 0 ? 1.0f : 0.0f);
        }
    }
    return denoise(device_, film, guides_, estimateError(film));
}

void SceneFilms::trace(std::uint32_t begin, std::uint32_t end, const SampleAllocation* allocation) {
    while (begin < end) {
        begin = std::min(begin + 256, end);
        if (adaptive_) {
            const std::size_t pixels = std::size_t(target_.film().width()) * target_.film().height();
            tracer_->setSampleEnds(allocation != nullptr ? allocation->samples(begin)
                                                         : std::vector<std::uint32_t>(pixels, begin));
        }
        while (!tracer_->advance(begin)) {
        }
    }
}

FilmImages SceneFilms::render(std::uint32_t samples, std::uint32_t seed) {
    target_.clear();
    tracer_->restart(seed);
    if (!adaptive_) {
        trace(0, samples);
        return target_.resolve();
    }
    const std::uint32_t pilot = pilotSamples(samples);
    trace(0, pilot);
    const SampleAllocation allocation(target_.resolve(), pilot);
    trace(pilot, samples, &allocation);
    return target_.resolve();
}

void MeanImage::add(const FilmImages& film) {
    sum_.resize(film.mean.size() / 4 * 3);
    for (std::size_t pixel = 0; pixel < film.mean.size() / 4; ++pixel)
        for (std::size_t c = 0; c < 3; ++c) sum_[3 * pixel + c] += film.mean[4 * pixel + c];
    ++count_;
}

std::vector<double> MeanImage::mean() const {
    std::vector<double> result(sum_);
    for (double& value : result) value /= count_;
    return result;
}

double relativeError(const FilmImages& film, const std::vector<double>& reference) {
    return relativeError(film.mean.data(), reference);
}

double relativeError(const float* texels, const std::vector<double>& reference) {
    double sum = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const double r = reference[i], x = texels[i / 3 * 4 + i % 3];
        sum += (x - r) * (x - r) / (r * r + 0.01);
    }
    return sum / double(reference.size());
}

}  // namespace helio::test
