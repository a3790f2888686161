#pragma once
/** @file What a picture may show otherwise than its scene's author meant. */
#include <heliograph/scene.hpp>

#include <string>
#include <vector>

namespace helio {

/** Textures in use that name a set of texture coordinates which their primitive does not have. */
void warnOfTexcoords(const Scene& scene, std::vector<std::string>& warnings);

/** A scene, or an eye, beyond the range in which every product of coordinates that the pipelines form stays
 * in that of normal floats. The largest are of three lengths (the distance along a ray,
 * shaders/intersection/triangle.glsl): with coordinates to x a sheared corner is at most 4 x from the ray, so
 * that the sum stays below 3 * 2 (4 x)^2 * 2 x, finite to x = 1.2e12. The smallest are of two edges of a
 * triangle and one distance, normal down to edges of 3e-15 in a scene of 1e-9. The limits stay inside. */
inline constexpr double kLargestCoordinate = 1e11, kSmallestExtent = 1e-9;
void warnOfExtent(const Scene::Bounds& bounds, const glm::dvec3& eye, std::vector<std::string>& warnings);

/** An eye so near to a triangle, in parts of the largest coordinate of both, that single precision may take
 * it to stand behind. Bounds and eye about the origin of what is on the device (PreparedScene). */
inline constexpr double kNearestEye = 2e-7;
void warnOfEye(const Scene& scene, const Scene::Bounds& bounds, const glm::dvec3& origin,
               const glm::dvec3& eye, std::vector<std::string>& warnings);

/** Meshes whose vertices lie so many of their own sizes from their origin that single precision no longer
 * holds their shape: at 1e5 sizes its steps are 1/80 of the size, and pictures of the box sample are off by
 * half a percent (tests/stability/sweeps.cpp). */
inline constexpr double kFarthestVertices = 1e5;
void warnOfPrecision(const Scene& scene, std::vector<std::string>& warnings);

/** Triangles so many times as long as wide that a ray which leaves one may start in its neighbour: right to
 * 1e-3 at 1e6, off by a percent at 1e7. */
inline constexpr double kLargestAspect = 2e6;
/** Meshes so many times as large as the smallest of the scene: the float steps of distances to them are then
 * a hundred times the small one. A square lamp is right at 3e7 times its distance, of half the light at 1e9.
 */
inline constexpr double kLargestContrast = 1e9;
void warnOfProportions(const Scene& scene, std::vector<std::string>& warnings);

}  // namespace helio
