#pragma once
/** @file First-order optics of lens tables, and the parts of their pupils that light comes through. */
#include <heliograph/camera.hpp>

#include <glm/glm.hpp>

#include <vector>

namespace helio {

/** A lens near its axis, by ray-transfer matrices; lengths in units of the table. */
struct ParaxialLens {
    /** From (height, angle) of a ray before the front surface to those behind the last: rows. */
    glm::dmat2 matrix{1.0};  ///< column-major: matrix[column][row]
    double focalLength = 0;
    double fNumber = 0;       ///< focal length over the diameter of the entrance pupil
    double filmDistance = 0;  ///< from the last surface to where the focus distance is sharp
};
ParaxialLens paraxial(const LensTable& lens);

/** Surfaces as crossLensSurface() takes them, from the film to the front, in units of the table; the front
 * vertex is at z = 0. The stop is open as far as the table says. */
std::vector<glm::dvec4> tracedSurfaces(const LensTable& lens);

/** Where rays from a point (r, 0) of the film pass the plane of the last surface's vertex and reach the
 * scene: x from `low` to `high`, y up to `side` either way. Empty: high < low. */
struct ExitPupil {
    double low = 0, high = -1, side = 0;
};
/** For film points in each of `count` rings of equal width from the centre to `reach`. */
std::vector<ExitPupil> exitPupils(const LensTable& lens, double reach, int count);

}  // namespace helio
