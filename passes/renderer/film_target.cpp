#include "passes/renderer/film_target.hpp"

#include <algorithm>

namespace helio {

FilmTarget::FilmTarget(Device& device, std::uint32_t width, std::uint32_t height)
    : film_(device, width, height) {
    Graph clearing(device);
    declareFilmClear(clearing, film_, film_.import(clearing));
    clear_ = clearing.compile();
    Graph resolving(device);
    const ResolvedFilm resolved = declareFilmResolve(resolving, film_, film_.import(resolving));
    mean_ = resolving.readback<float>(resolved.mean);
    variance_ = resolving.readback<float>(resolved.variance);
    difference_ = resolving.readback<float>(resolved.difference);
    resolve_ = resolving.compile({.executionsInFlight = 1});
}

void FilmTarget::clear() {
    timings_ = clear_.timings(clear_.execute());
}

FilmImages FilmTarget::resolve() {
    const Execution execution = resolve_.execute();
    FilmImages images{film_.width(), film_.height(), mean_.wait(execution), variance_.wait(execution),
                      difference_.wait(execution)};
    timings_.resize(std::min<std::size_t>(timings_.size(), 1));
    for (const PassTiming& timing : resolve_.timings(execution)) timings_.push_back(timing);
    return images;
}

}  // namespace helio
