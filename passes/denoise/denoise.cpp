#include "passes/denoise/denoise.hpp"

#include "engine/film/variance.hpp"

#include <heliograph_kernels/denoise.hpp>
#include <heliograph_kernels/film.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

namespace helio {
namespace {

constexpr std::int32_t levels = 5;  // the last reaches 32 pixels far

struct FilterPush {
    std::array<std::int32_t, 2> size;
    std::int32_t step;
};

/** The halves' means, and the variance of each as a mean of the channels. */
std::array<std::vector<glm::vec4>, 2> halves(const FilmImages& film) {
    const std::vector<float> variance = varianceOfMean(film);
    std::array<std::vector<glm::vec4>, 2> result;
    for (std::size_t i = 0; i < film.mean.size(); i += 4) {
        const glm::vec3 mean(film.mean[i], film.mean[i + 1], film.mean[i + 2]);
        const glm::vec3 d(film.difference[i], film.difference[i + 1], film.difference[i + 2]);
        const float sum = 2 * (variance[i] + variance[i + 1] + variance[i + 2]) / 3;
        const float v = std::isfinite(sum) ? sum : 1e30f;
        result[0].emplace_back(mean + d, v);
        result[1].emplace_back(mean - d, v);
    }
    return result;
}

std::vector<glm::vec4> texels(const std::vector<float>& values) {
    std::vector<glm::vec4> result;
    for (std::size_t i = 0; i < values.size(); i += 4)
        result.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    return result;
}

}  // namespace

Denoised denoise(Device& device, const FilmImages& film, const DenoiseGuides& guides) {
    const std::array<std::uint32_t, 2> size = {film.width, film.height};
    const std::size_t pixels = std::size_t(film.width) * film.height;
    assert(guides.geometry.size() == pixels && guides.albedo.size() == pixels);
    const ImageDescription description{size, Format::RGBA32F};
    const std::array<std::int32_t, 2> extent = {std::int32_t(size[0]), std::int32_t(size[1])};

    const std::array<std::vector<glm::vec4>, 2> both = halves(film);
    DeviceBuffer a = makeBuffer(device, "denoise.a", both[0]), b = makeBuffer(device, "denoise.b", both[1]);
    DeviceBuffer geometry = makeBuffer(device, "denoise.geometry", guides.geometry);
    DeviceBuffer albedo = makeBuffer(device, "denoise.albedo", guides.albedo);
    DeviceBuffer mean = makeBuffer(device, "denoise.mean", texels(film.mean));
    DeviceBuffer difference = makeBuffer(device, "denoise.difference", texels(film.difference));

    DeviceBuffer weights = makeBuffer(device, "denoise.weights", texels(relativeWeights(film)));

    Graph graph(device);
    const Buffer geometryRead = graph.import(geometry), albedoRead = graph.import(albedo);
    const Buffer meanRead = graph.import(mean), differenceRead = graph.import(difference);
    const auto filtered = [&](const std::string& name, DeviceBuffer& half) {
        Image from = graph.image(name, description);
        graph.compute(name + ".load", shaders::imageRestore)
            .reads({{"uSaved", graph.import(half), Format::RGBA32F}})
            .overwrites({{"uImage", from}})
            .record([from](Commands& c) { c.dispatchOver(from); });
        for (std::int32_t level = 0; level < levels; ++level) {
            const Image to = graph.image(name + std::to_string(level), description);
            const FilterPush push{extent, 1 << level};
            graph.compute("denoise.filter", shaders::denoiseFilter)
                .reads({{"uIn", from},
                        {"uGeometry", geometryRead, Format::RGBA32F},
                        {"uAlbedo", albedoRead, Format::RGBA32F}})
                .overwrites({{"uOut", to}})
                .record([push, to](Commands& c) { c.push(push).dispatchOver(to); });
            from = to;
        }
        return from;
    };
    const Image filteredA = filtered("denoise.a", a), filteredB = filtered("denoise.b", b);
    const Image merged = graph.image("denoise.merged", description);
    const Image scores = graph.image("denoise.scores", description);
    const Image terms = graph.image("denoise.terms", description);
    graph.compute("denoise.merge", shaders::denoiseMerge)
        .reads({{"uA", filteredA},
                {"uB", filteredB},
                {"uMean", meanRead, Format::RGBA32F},
                {"uDifference", differenceRead, Format::RGBA32F},
                {"uWeights", graph.import(weights), Format::RGBA32F}})
        .overwrites({{"uMerged", merged}, {"uScores", scores}, {"uTerms", terms}})
        .record([extent, merged](Commands& c) { c.push(extent).dispatchOver(merged); });
    const Image picture = graph.image("denoise.picture", description);
    graph.compute("denoise.choose", shaders::denoiseChoose)
        .reads({{"uMerged", merged}, {"uScores", scores}, {"uMean", meanRead, Format::RGBA32F}})
        .overwrites({{"uPicture", picture}})
        .record([extent, picture](Commands& c) { c.push(extent).dispatchOver(picture); });
    const auto readPicture = graph.readback<glm::vec4>(picture);
    const auto readTerms = graph.readback<glm::vec4>(terms);
    Plan plan = graph.compile();
    const Execution execution = plan.execute();

    Denoised result;
    result.picture = readPicture.wait(execution);
    const std::vector<glm::vec4> term = readTerms.wait(execution);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double s = result.picture[i].w;
        result.undenoised += double(term[i].z) / double(pixels);
        result.relmse += (term[i].z - 2 * s * term[i].x + s * s * term[i].y) / double(pixels);
        result.strength += s / double(pixels);
    }
    result.relmse = std::max(result.relmse, 0.0);
    result.timings = plan.timings(execution);
    return result;
}

}  // namespace helio
