#include "tests/bench/error/table.hpp"

#include "tests/support/scene_films.hpp"

#include <algorithm>

namespace helio::test {

std::vector<TableRow> measureRows(Device& device, const Scene& scene,
                                  const std::vector<std::uint32_t>& samples, const TableOptions& options) {
    const std::array size = {options.size, options.size};
    SceneFilms plain(device, scene, size), adaptive(device, scene, size, true);
    MeanImage mean;
    const FilmImages reference = plain.render(options.reference, 1000000);
    mean.add(reference);
    const std::vector<double> truth = mean.mean();
    const double residual = estimateError(reference).relmse;
    std::vector<TableRow> rows;
    for (const std::uint32_t count : samples) {
        TableRow row;
        for (std::uint32_t seed = 1; seed <= options.seeds; ++seed) {
            const FilmImages film = plain.render(count, seed);
            const Denoised denoised = plain.denoised(film);
            const double before = relativeError(film, truth),
                         after = relativeError(&denoised.picture.data()->x, truth);
            row.plain += before / options.seeds;
            row.denoised += after / options.seeds;
            row.worst = std::max(row.worst, (after - residual) / (before - residual));
            row.plainMeasured += denoised.undenoised / options.seeds;
            row.denoisedMeasured += denoised.error.relmse / options.seeds;
            if (denoised.error.reliable) {
                const double left = after - residual;
                ++row.reliable;
                row.held += denoised.error.low <= left && left <= denoised.error.high;
                row.farthest =
                    std::max({row.farthest, denoised.error.relmse / left, left / denoised.error.relmse});
            }
            row.adaptive += relativeError(adaptive.render(count, seed), truth) / options.seeds;
        }
        row.plain -= residual;
        row.denoised -= residual;
        row.adaptive -= residual;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace helio::test
