#ifndef HELIOGRAPH_INTERSECTION_TRIANGLE
#define HELIOGRAPH_INTERSECTION_TRIANGLE
/** @file
 * Watertight ray and triangle intersection after Woop, Benthin and Wald, "Watertight ray/triangle
 * intersection", JCGT 2(1), 2013. Corners are moved to the ray's origin and sheared so that the ray runs along
 * one axis; the three 2D edge functions then decide.
 *
 * Why no ray slips between neighbours: a corner is sheared to the same 2D point in every triangle that shares
 * it. An edge function is a difference of two rounded products; rounding is monotonic, so its sign is never
 * wrong for those points, at worst it is 0, and 0 counts as inside on both sides. Edges of neighbours are
 * therefore never both missed. `precise` keeps drivers from contracting the difference to a fused operation,
 * which would break that.
 *
 * No absolute epsilon: everything scales with the coordinates, as long as products of two stay in the range of
 * normal floats. An edge-on triangle (determinant 0) is missed.
 */

#define INFINITE_DISTANCE uintBitsToFloat(0x7f800000u)

/** What all tests of one ray share. */
struct RayShear {
    vec3 origin;   ///< permuted so that the direction's largest component is z
    vec3 shear;    ///< x/z, y/z, 1/z of the permuted direction
    int axis;      ///< which component became z
};

vec3 permuted(vec3 v, int axis) {
    return axis == 2 ? v : (axis == 0 ? v.yzx : v.zxy);
}

RayShear shearOf(vec3 origin, vec3 direction) {
    const vec3 size = abs(direction);
    RayShear ray;
    ray.axis = size.z >= size.x && size.z >= size.y ? 2 : (size.x >= size.y ? 0 : 1);
    ray.origin = permuted(origin, ray.axis);
    const vec3 d = permuted(direction, ray.axis);
    const float inverse = 1.0 / d.z;
    ray.shear = vec3(d.x * inverse, d.y * inverse, inverse);
    return ray;
}

/** A corner in the ray's frame: sheared x and y, and z before scaling. */
vec3 sheared(RayShear ray, vec3 corner) {
    precise vec3 moved = permuted(corner, ray.axis) - ray.origin;
    precise vec3 result = vec3(moved.x - ray.shear.x * moved.z, moved.y - ray.shear.y * moved.z, moved.z);
    return result;
}

/** Edge functions: weights of the three corners, not yet divided by their sum. All of one sign inside. */
vec3 edgeFunctions(vec3 a, vec3 b, vec3 c) {
    precise vec3 edges = vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
    return edges;
}

/** Whether the ray meets the triangle of sheared corners at a distance in (0, nearest); `t` is it, in units of
 * the direction's length. */
bool meetsTriangle(RayShear ray, vec3 a, vec3 b, vec3 c, float nearest, out float t) {
    const vec3 e = edgeFunctions(a, b, c);
    const bool inside = (e.x >= 0.0 && e.y >= 0.0 && e.z >= 0.0) || (e.x <= 0.0 && e.y <= 0.0 && e.z <= 0.0);
    const float determinant = e.x + e.y + e.z;
    t = (e.x * a.z + e.y * b.z + e.z * c.z) * ray.shear.z / determinant;
    return inside && determinant != 0.0 && t > 0.0 && t < nearest;
}

/** One edge function, as in edgeFunctions(). */
float edgeFunction(vec3 a, vec3 b) {
    precise float e = b.x * a.y - b.y * a.x;
    return e;
}

/** As meetsTriangle() for a flat convex quadrilateral of sheared corners in order, split along b and d;
 * `second`: whether the half away from a is met. */
bool meetsQuad(RayShear ray, vec3 a, vec3 b, vec3 c, vec3 d, float nearest, out float t, out bool second) {
    const float ab = edgeFunction(a, b), bc = edgeFunction(b, c), cd = edgeFunction(c, d), da = edgeFunction(d, a);
    const float diagonal = edgeFunction(b, d);
    const bool positive = ab >= 0.0 && bc >= 0.0 && cd >= 0.0 && da >= 0.0;
    const bool negative = ab <= 0.0 && bc <= 0.0 && cd <= 0.0 && da <= 0.0;
    const float determinant = diagonal + da + ab;
    t = (diagonal * a.z + da * b.z + ab * d.z) * ray.shear.z / determinant;
    second = positive ? diagonal < 0.0 : diagonal > 0.0;
    return (positive || negative) && determinant != 0.0 && t > 0.0 && t < nearest;
}

/** Barycentrics of v0, v1, v2 where the ray meets the triangle's plane; they sum to 1. */
vec3 barycentrics(RayShear ray, vec3 v0, vec3 v1, vec3 v2) {
    const vec3 e = edgeFunctions(sheared(ray, v0), sheared(ray, v1), sheared(ray, v2));
    const float sum = e.x + e.y + e.z;
    const vec2 b = sum != 0.0 ? e.yz / sum : vec2(0.0);
    return vec3(1.0 - b.x - b.y, b);
}
#endif
