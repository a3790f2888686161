#pragma once
/** @file
 * A scene of a few triangles written out as GLSL: every corner is a literal, corners that triangles share are
 * moved and sheared once, and pairs that make a flat convex quadrilateral are tested as one. On lavapipe this
 * takes a fraction of the time of any loop over a buffer, where each load costs as much as the test.
 */
#include <glm/glm.hpp>

#include <span>
#include <string>

namespace helio {

/** Triangles up to which a scene is written out. */
inline constexpr std::uint32_t kUnrolledTriangles = 64;

/** "generated.glsl" for shaders/intersection/scene_hit.glsl: defines UNROLLED_SCENE, testAll() and testAny().
 * @param triangles packed triangles in order of slot, 3 texels each (PackedScene::triangles)
 * @param lights packed lights; where there is just one, it is written out too (UNROLLED_LIGHT) */
std::string unrolledScene(std::span<const glm::vec4> triangles, std::span<const glm::vec4> lights);

}  // namespace helio
