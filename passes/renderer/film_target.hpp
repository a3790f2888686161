#pragma once
/** @file A film with its plans, kept from render to render. */
#include "engine/film/error_estimate.hpp"
#include "passes/film/film.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <vector>

namespace helio {

/** A film of one size, its clear and resolve plans. Not movable: plans refer to the film. */
class FilmTarget {
public:
    FilmTarget(Device& device, std::uint32_t width, std::uint32_t height);
    FilmTarget(const FilmTarget&) = delete;
    FilmTarget& operator=(const FilmTarget&) = delete;

    Film& film() { return film_; }
    void clear();
    /** Waits for all work on the film. */
    FilmImages resolve();
    /** Device times of the last clear and resolve. */
    const std::vector<PassTiming>& timings() const { return timings_; }

private:
    Film film_;
    Plan clear_, resolve_;
    Readback<float> mean_, variance_, difference_;
    std::vector<PassTiming> timings_;
};

}  // namespace helio
