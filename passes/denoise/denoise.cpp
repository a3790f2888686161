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
/** Of the measured error: what the measure may be off beyond its spread (bench_error table). */
constexpr double modelDoubt = 0.05;
/** Of the measured error: how far its interval may reach and be reliable. */
constexpr double farthestBound = 0.4;

struct FilterPush {
    std::array<std::int32_t, 2> size;
    std::int32_t step;
};

/** The variance of the mean of `count` independent samples, from what each half of them says within itself.
 * It is taken from that of all samples by what the halves' difference d holds of it. The filter's width must
 * not go by d: where d happens to be large, a wider filter would bring the halves together, and their
 * difference would call it better than it is. */
float varianceWithinHalves(float variance, float d, float count) {
    return count > 2 ? std::max(0.0f, (variance * (count - 1) - d * d) / (count - 2)) : variance;
}

/** The halves' means, and the variance of each as a mean of the channels. */
std::array<std::vector<glm::vec4>, 2> halves(const FilmImages& film) {
    const std::vector<float> variance = varianceOfMean(film);
    std::array<std::vector<glm::vec4>, 2> result;
    for (std::size_t i = 0; i < film.mean.size(); i += 4) {
        const glm::vec3 mean(film.mean[i], film.mean[i + 1], film.mean[i + 2]);
        const glm::vec3 d(film.difference[i], film.difference[i + 1], film.difference[i + 2]);
        float sum = 0;
        for (std::size_t c = i; c < i + 3; ++c) {
            const float all = film.variance[c];
            const float within = varianceWithinHalves(all, film.difference[c], film.mean[i + 3]);
            if (all > 0) sum += 2 * variance[c] / all * within / 3;
        }
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

/** The filtered picture's error, see denoise.hpp. With e the mean's error, f the filtered one's and s the
 * strength, a pixel's term is off by
 *
 *     (1 - 2 s) (d^2 - e^2) + 2 s (D d - e f),
 *
 * whose variance is 4 sigma^4 (1 - 2 s)^2, of which 4/3 d^4 is an estimate, and about 4 s^2 sigma^2 (D^2 +
 * f^2). Channels count as if they erred alike. Terms hold gain, change^2, d^2 and D^2. */
ErrorEstimate measuredError(const std::vector<glm::vec4>& picture, const std::vector<glm::vec4>& terms,
                            bool reliable) {
    ErrorEstimate result;
    const double pixels = double(terms.size());
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const double s = picture[i].w;
        result.relmse += (terms[i].z - 2 * s * terms[i].x + s * s * terms[i].y) / pixels;
    }
    result.relmse = std::max(result.relmse, 0.0);
    double variance = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const double s = picture[i].w, d2 = terms[i].z, rest = 1 - 2 * s;
        variance += 4.0 / 3 * rest * rest * d2 * d2 + 4 * s * s * d2 * (terms[i].w + result.relmse);
    }
    const double doubt = 1.96 * std::sqrt(variance) / pixels + modelDoubt * result.relmse;
    result.low = std::max(0.0, result.relmse - doubt);
    result.high = result.relmse + doubt;
    result.reliable = reliable && result.relmse > 0 && doubt <= farthestBound * result.relmse;
    return result;
}

}  // namespace

Denoised denoise(Device& device, const FilmImages& film, const DenoiseGuides& guides,
                 const ErrorEstimate& before) {
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
        result.undenoised += double(term[i].z) / double(pixels);
        result.strength += double(result.picture[i].w) / double(pixels);
    }
    result.error = measuredError(result.picture, term, before.reliable);
    result.timings = plan.timings(execution);
    return result;
}

}  // namespace helio
