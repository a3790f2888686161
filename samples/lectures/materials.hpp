#pragma once
/** @file The samples of lecture 17 (materials) and of lecture 19's cameras, each by numbers that are known.
 */
#include "samples/lectures/figure.hpp"

namespace helio::lectures {

/** sample:gallery: what single balls send back under a sky of 1. */
std::vector<Figure> measureGallery(Renderer& renderer);
/** sample:caustic: where the ring's nephroid has its cusp, and the light about the ring's centre. */
std::vector<Figure> measureCaustic(Renderer& renderer);
/** sample:brushed: half widths of the highlight along the scratches and across. */
std::vector<Figure> measureBrushed(Renderer& renderer);
/** sample:snell: the cone of the window. */
std::vector<Figure> measureSnell(Renderer& renderer);
/** sample:lenses: second moments of a lamp out of focus. */
std::vector<Figure> measureLenses(Renderer& renderer);

}  // namespace helio::lectures
