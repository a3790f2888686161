#pragma once
/** @file The film on the device and the passes every film needs: clear and resolve. */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>

namespace helio {

/** Accumulated samples of a picture (shaders/film/film.glsl): 96 bytes per pixel. Move-only; must outlive the
 * plans it is imported into. */
class Film {
public:
    /** Throws InputError for a size of 0 or one beyond the device's images. Contents are undefined until the
     * first clear. */
    Film(Device& device, std::uint32_t width, std::uint32_t height);

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    std::uint64_t bytes() const { return 96ull * width_ * height_; }
    /** For Pass bindings named uFilm. */
    Image import(Graph& graph) { return graph.import(state_); }

private:
    std::uint32_t width_, height_;
    DeviceImage state_;
};

/** Largest width and height of a film, pixels: its image is twice as wide and three times as high. */
inline constexpr std::uint32_t kMaxFilmWidth = 8192, kMaxFilmHeight = 5461;

/** Declares the pass that empties a film. */
void declareFilmClear(Graph& graph, Film& film, Image state);

/** What the resolve pass leaves, RGBA32F of the picture's size. */
struct ResolvedFilm {
    Image mean;        ///< R G B, number of samples
    Image variance;    ///< of the mean if samples were independent; number of rejected samples
    Image difference;  ///< see filmHalfDifference; 1 where both halves have samples
};
/** Declares the pass that reads the film. */
ResolvedFilm declareFilmResolve(Graph& graph, Film& film, Image state);

}  // namespace helio
