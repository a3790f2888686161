#include "tests/bench/error/table.hpp"

#include "tests/support/scene_films.hpp"

namespace helio::test {

TableRow measureRow(Device& device, const Scene& scene, std::uint32_t samples, const TableOptions& options) {
    const std::array size = {options.size, options.size};
    SceneFilms plain(device, scene, size), adaptive(device, scene, size, true);
    std::vector<FilmImages> plainFilms, adaptiveFilms;
    MeanImage mean;
    for (std::uint32_t seed = 1; seed <= options.seeds; ++seed) {
        plainFilms.push_back(plain.render(samples, seed));
        mean.add(plainFilms.back());
        // Other numbers: the truth must not hold this picture's errors.
        adaptiveFilms.push_back(adaptive.render(samples, seed + 100000));
    }
    const std::vector<double> truth = mean.mean();
    const double n = options.seeds;
    TableRow row;
    for (const FilmImages& film : plainFilms) row.plain += relativeError(film, truth) / n;
    for (const FilmImages& film : adaptiveFilms) row.adaptive += relativeError(film, truth) / n;
    row.plain /= 1 - 1 / n;
    row.adaptive -= row.plain / n;
    return row;
}

}  // namespace helio::test
