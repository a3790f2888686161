#pragma once
/** @file The benchmark's procedural scenes: corners of triangles in threes. */
#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace helio::bench {

using Corners = std::vector<glm::vec3>;

/** A closed tube along a torus knot with a rough skin: compact, evenly sized triangles, exactly 70,000. */
Corners knot();

/** Terrain, rough boulders and long thin stalks in all directions: about `triangles` of very uneven size. */
Corners landscape(std::size_t triangles);

/** `count` triangles of equal expected size spread through a cube, for cost against count. */
Corners cloud(std::size_t count);

}  // namespace helio::bench
