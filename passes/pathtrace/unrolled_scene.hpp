#pragma once
/** @file
 * A scene of a few triangles written out as GLSL: every corner is a literal, corners that triangles share are
 * moved and sheared once, and pairs that make a flat convex quadrilateral are tested as one. On lavapipe this
 * takes a fraction of the time of any loop over a buffer, where each load costs as much as the test.
 */
#include "passes/scene/packed_scene.hpp"

#include <string>

namespace helio {

/** "generated.glsl" for shaders/intersection/scene_hit.glsl: defines UNROLLED_SCENE, or UNROLLED_BESIDE_TREE
 * where the written-out triangles are not all, testAll() and testAny(). Where there is just one light, it is
 * written out too (UNROLLED_LIGHT). */
std::string unrolledScene(const PackedScene& packed);

}  // namespace helio
