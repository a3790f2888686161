#pragma once
/** @file What a film's samples cannot say of themselves. */
#include "engine/film/error_estimate.hpp"

namespace helio {

/** How much the film's relMSE would change by bright samples that no pixel has met yet but its neighbours
 * have: the root of the sum over pixels of the squares of what one such sample would do to the pixel's term.
 *
 * A lamp smaller than a pixel often lies across its edges, and the pixel beside may hold less of it than a
 * sample's share. Its halves then agree, on a value that is wrong by up to a sample of the lamp. What a
 * neighbour's samples are worth, each weighted with its own brightness, is E[X^2] / E[X] = s^2 / mean + mean;
 * a pixel counts where this is twice its own or more. */
double strayError(const FilmImages& images);

}  // namespace helio
