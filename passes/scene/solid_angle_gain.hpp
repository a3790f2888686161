#pragma once
/** @file Whether lights are better sampled by the solid angle they fill than by their area. */
#include <glm/glm.hpp>

#include <cstddef>
#include <functional>
#include <span>

namespace helio::pack {

/** A flat light: a parallelogram, or the triangle that is half of it. */
struct FlatLight {
    glm::dvec3 corner{0.0}, edge1{0.0}, edge2{0.0};
    double radiance = 0;
    bool isTriangle = false, bothFaces = false;
};

/** How much less the variance of one light sample is, in squares of the irradiance that it estimates, where
 * points are taken over a light's solid angle in place of its area: a mean over those of the scene's
 * triangles (three corners each) that receive light. Lights are taken to be chosen by what they bring, and
 * nothing hides them. */
struct SolidAngleGain {
    double rectangles = 0, triangles = 0;
};
SolidAngleGain solidAngleGain(std::span<const FlatLight> lights, std::span<const glm::vec3> positions,
                              const std::function<bool(std::size_t)>& receives);

}  // namespace helio::pack
