#pragma once
/** @file Polygons with more than three corners. */
#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace helio::mesh {

/** Above this many corners a polygon that is not convex is cut into a fan, as a convex one. */
constexpr std::size_t maximumEarClipping = 512;

/**
 * Cuts a polygon of n > 3 corners into n - 2 triangles by ear clipping (Meisters 1975), in the plane across
 * its vector area. False where the fan (0, k, k + 1) will do, for a convex polygon or one of no area;
 * `triangles` is left as it was then, else it has three corners for each triangle.
 */
bool triangulate(std::span<const glm::vec3> polygon, std::vector<std::uint32_t>& triangles);

}  // namespace helio::mesh
