#ifndef HELIOGRAPH_INTERSECTION_OFFSET
#define HELIOGRAPH_INTERSECTION_OFFSET
/** @file
 * Where a ray that leaves a surface starts. No world epsilon: the offset is a bound of the rounding error.
 *
 * A hit point is the sum of corners weighted by barycentrics, which lies in the triangle's plane but for
 * rounding. Per axis, with u = 2^-24: the weights err by 3u in all, products and sums by 3u, the final sum of
 * point and offset by u, each of at most the largest corner's magnitude m (weights do not exceed 1). The point
 * is moved along the geometric normal by 10u (|n| . m), after Pharr, Jakob and Humphreys, "Physically Based
 * Rendering", 4th ed., 6.8, with m in place of the weighted magnitudes: neighbours in the same plane are
 * tested with the errors of their own corners. The triangle itself is left out of the ray's tests by its slot.
 */
const float OFFSET_ROUNDOFF = 10.0 * 5.9604644775390625e-08;

/** Distance along the unit normal that covers the rounding of a point on the triangle. */
float offsetDistance(vec3 v0, vec3 v1, vec3 v2, vec3 normal) {
    return OFFSET_ROUNDOFF * dot(abs(normal), max(max(abs(v0), abs(v1)), abs(v2)));
}
#endif
