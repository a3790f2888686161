#include "tests/bench/error/coverage.hpp"

#include "tests/support/scene_films.hpp"

#include <heliograph/verify.hpp>

#include <cmath>
#include <fstream>
#include <optional>

namespace helio::test {
namespace {

void keepFilm(std::ofstream& file, const FilmImages& film) {
    for (const std::vector<float>* texels : {&film.mean, &film.variance, &film.difference}) {
        file.write(reinterpret_cast<const char*>(texels->data()),
                   std::streamsize(texels->size() * sizeof(float)));
    }
}

/** The next film that keepFilm() wrote; an empty one at the end. */
FilmImages readFilm(std::ifstream& file, std::uint32_t size) {
    const std::size_t floats = std::size_t(size) * size * 4;
    FilmImages film{size, size, std::vector<float>(floats), std::vector<float>(floats),
                    std::vector<float>(floats)};
    for (std::vector<float>* texels : {&film.mean, &film.variance, &film.difference}) {
        file.read(reinterpret_cast<char*>(texels->data()), std::streamsize(floats * sizeof(float)));
    }
    return file ? film : FilmImages{};
}

struct Judged {
    std::vector<float> picture;
    ErrorEstimate error;
};

Coverage count(std::vector<Judged>& all, const std::vector<double>& reference) {
    Coverage result;
    result.seeds = std::uint32_t(all.size());
    const double seeds = double(all.size());
    verify::RunningStatistics off;
    for (Judged& judged : all) {
        FilmImages film;
        film.mean = std::move(judged.picture);
        // E |x - mean|^2 = (1 - 1 / n) E |x - truth|^2.
        const double truth = relativeError(film, reference) / (1 - 1 / seeds);
        const ErrorEstimate& e = judged.error;
        const bool in = e.low <= truth && truth <= e.high;
        result.covered += in;
        result.above += truth > e.high;
        result.below += truth < e.low;
        result.reliable += e.reliable;
        result.coveredReliable += in && e.reliable;
        result.truth += truth / seeds;
        result.estimate += e.relmse / seeds;
        const double width = std::log(e.high / e.low);
        result.width += width / seeds;
        // Of a normal variable, 95 % lie within 3.92 standard deviations.
        off.add((e.relmse - truth) / e.relmse / (width / 3.92));
    }
    result.offset = off.mean();
    result.spread = std::sqrt(off.variance());
    return result;
}

}  // namespace

Coverage measureCoverage(Device& device, const Scene& scene, const std::string& name,
                         const CoverageOptions& options) {
    std::optional<SceneFilms> films;
    std::ofstream kept;
    std::ifstream source;
    if (options.judge.empty()) {
        films.emplace(device, scene, std::array{options.size, options.size});
    } else {
        source.open(options.judge / (name + ".films"), std::ios::binary);
    }
    if (!options.keep.empty()) kept.open(options.keep / (name + ".films"), std::ios::binary);
    MeanImage mean;
    std::vector<Judged> all;
    for (std::uint32_t seed = 0; seed < options.seeds; ++seed) {
        FilmImages film = films ? films->render(options.samples, seed + 1) : readFilm(source, options.size);
        if (film.mean.empty()) break;
        mean.add(film);
        if (kept.is_open()) keepFilm(kept, film);
        const ErrorEstimate error = estimateError(film);
        all.push_back({std::move(film.mean), error});
    }
    return count(all, mean.mean());
}

}  // namespace helio::test
