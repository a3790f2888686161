#pragma once
/** @file Procedural meshes for tests and benchmarks: corners of triangles in threes. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace helio::test {

using Corners = std::vector<glm::vec3>;

/** A closed tube along a torus knot with a rough skin: compact, evenly sized triangles, exactly 70,000. */
Corners knot();

/** The sphere of radius 1 around the origin as an octahedron whose faces are cut into 4^level: closed,
 * neighbours share corners bit by bit. */
Corners octasphere(int level);

/** Terrain, rough boulders and long thin stalks in all directions: about `triangles` of very uneven size. */
Corners landscape(std::size_t triangles);

/** `count` triangles of equal expected size spread through a cube, for cost against count. */
Corners cloud(std::size_t count);

/** The mesh as a scene of one node. */
Scene sceneOf(const Corners& corners);

}  // namespace helio::test
