#pragma once
/** @file Points of a lens, on the host. */
#include <heliograph/camera.hpp>

#include <glm/glm.hpp>

namespace helio {

/** Where the lens is passed for a uniform pair, in units of its radius. */
glm::dvec2 lensPoint(const ThinLens& lens, const glm::dvec2& u);

}  // namespace helio
