#include "passes/film/film.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/film.hpp>

namespace helio {
namespace {

std::uint32_t checked(std::uint32_t extent, std::uint32_t limit, const char* axis) {
    if (extent >= 1 && extent <= limit) return extent;
    throw InputError("", "size", fmt::format("a {} of {} pixels", axis, extent),
                     fmt::format("give 1 to {} pixels", limit));
}

}  // namespace

Film::Film(Device& device, std::uint32_t width, std::uint32_t height)
    : width_(checked(width, kMaxFilmWidth, "width")),
      height_(checked(height, kMaxFilmHeight, "height")),
      state_(device, "film", 2 * width, 3 * height, Format::RGBA32F) {}

void declareFilmClear(Graph& graph, Film& film, Image state) {
    graph.compute("film.clear", shaders::filmClear)
        .overwrites({{"uFilm", state}})
        .record([w = film.width(), h = film.height()](Commands& c) { c.dispatchOver(w, h); });
}

ResolvedFilm declareFilmResolve(Graph& graph, Film& film, Image state) {
    const ImageDescription description{{film.width(), film.height()}, Format::RGBA32F};
    const ResolvedFilm resolved = {graph.image("film.mean", description),
                                   graph.image("film.variance", description),
                                   graph.image("film.difference", description)};
    graph.compute("film.resolve", shaders::filmResolve)
        .reads({{"uFilm", state}})
        .overwrites({{"uMean", resolved.mean},
                     {"uVariance", resolved.variance},
                     {"uDifference", resolved.difference}})
        .record([mean = resolved.mean](Commands& c) { c.dispatchOver(mean); });
    return resolved;
}

}  // namespace helio
