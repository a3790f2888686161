#pragma once
/** @file Films of one scene under many seeds, made with one set of pipelines. */
#include "engine/film/sample_allocation.hpp"
#include "passes/denoise/denoise.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/renderer/film_target.hpp"

#include <heliograph/scene.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace helio::test {

/** Traces a scene again and again, as the renderer would with no limit but the number of samples. */
class SceneFilms {
public:
    SceneFilms(Device& device, Scene scene, std::array<std::uint32_t, 2> size, bool adaptive = false);
    Denoised denoised(const FilmImages& film);
    /** A film of `samples` per pixel; on average where adaptive. */
    FilmImages render(std::uint32_t samples, std::uint32_t seed);

private:
    void trace(std::uint32_t begin, std::uint32_t end, const SampleAllocation* allocation = nullptr);

    Scene scene_;
    bool adaptive_;
    Device& device_;
    DenoiseGuides guides_;
    FilmTarget target_;
    std::unique_ptr<DeviceScene> uploaded_;
    std::unique_ptr<PathTracer> tracer_;
};

/** Mean of pictures, R G B per pixel. */
class MeanImage {
public:
    void add(const FilmImages& film);
    std::vector<double> mean() const;

private:
    std::vector<double> sum_;
    double count_ = 0;
};

/** relMSE of a film's picture against a reference. */
double relativeError(const FilmImages& film, const std::vector<double>& reference);
/** The same of texels of four floats. */
double relativeError(const float* texels, const std::vector<double>& reference);

}  // namespace helio::test
