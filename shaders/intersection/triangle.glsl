#ifndef HELIOGRAPH_INTERSECTION_TRIANGLE
#define HELIOGRAPH_INTERSECTION_TRIANGLE
/** @file
 * Watertight ray and triangle intersection after Woop, Benthin and Wald, "Watertight ray/triangle
 * intersection", JCGT 2(1), 2013. Corners are moved to the ray's origin and sheared so that the ray runs along
 * one axis; the three 2D edge functions then decide.
 *
 * Why no ray slips between neighbours: a corner is sheared to the same 2D point in every triangle that shares
 * it. An edge function is a difference of two rounded products; rounding is monotonic, so its sign is never
 * wrong for those points, at worst it is 0, and 0 counts as inside. Edges of neighbours are therefore never
 * both missed. `precise` keeps drivers from contracting the difference to a fused operation,
 * which would break that.
 *
 * No absolute epsilon: everything scales with the coordinates, as long as products of two stay in the range of
 * normal floats. An edge-on triangle (determinant 0) is missed.
 */

#define INFINITE_DISTANCE uintBitsToFloat(0x7f800000u)

/** What all tests of one ray share: rows of the shear. Two entries of each row are 0, 1 or make the products
 * with them exact, so that a row costs rounding like x - shear * z does; multiplying by 0 and 1 is cheaper on
 * lavapipe than selecting components. */
struct RayShear {
    vec3 origin;
    vec3 x;         ///< e_i - (d_i / d_k) e_k, k the axis of the direction's largest component
    vec3 y;         ///< e_j - (d_j / d_k) e_k
    vec3 z;         ///< e_k
    float inverse;  ///< 1 / d_k
};

RayShear shearOf(vec3 origin, vec3 direction) {
    const vec3 size = abs(direction);
    RayShear ray;
    ray.origin = origin;
    const bool alongZ = size.z >= size.x && size.z >= size.y, alongX = !alongZ && size.x >= size.y;
    ray.inverse = 1.0 / (alongZ ? direction.z : (alongX ? direction.x : direction.y));
    const vec3 s = direction * -ray.inverse;
    ray.x = alongZ ? vec3(1.0, 0.0, s.x) : (alongX ? vec3(s.y, 1.0, 0.0) : vec3(0.0, s.z, 1.0));
    ray.y = alongZ ? vec3(0.0, 1.0, s.y) : (alongX ? vec3(s.z, 0.0, 1.0) : vec3(1.0, s.x, 0.0));
    ray.z = alongZ ? vec3(0.0, 0.0, 1.0) : (alongX ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0));
    return ray;
}

/** A corner in the ray's frame: sheared x and y, and z before scaling. */
vec3 sheared(RayShear ray, vec3 corner) {
    precise vec3 moved = corner - ray.origin;
    precise vec3 result = vec3(ray.x.x * moved.x + ray.x.y * moved.y + ray.x.z * moved.z,
                               ray.y.x * moved.x + ray.y.y * moved.y + ray.y.z * moved.z,
                               ray.z.x * moved.x + ray.z.y * moved.y + ray.z.z * moved.z);
    return result;
}

/** Edge functions: weights of the three corners, not yet divided by their sum. All of one sign inside. */
vec3 edgeFunctions(vec3 a, vec3 b, vec3 c) {
    precise vec3 edges = vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
    return edges;
}

/** Whether 0 < t < nearest, by the bits: as unsigned integers positive floats are in order, and negative ones,
 * 0, infinities and NaN (minus 1, wrapping around) lie above all of them. One comparison where the driver's
 * float comparisons take several. */
bool isNearer(float t, float nearest) {
    return floatBitsToUint(t) - 1u < floatBitsToUint(nearest) - 1u;
}

/** Whether the ray's line meets the triangle of sheared corners; `t` is the distance, in units of the
 * direction's length, and means something where isNearer() than some other.
 *
 * Signs of the edge functions are compared as integers. All at most 0 holds for 0 of either sign. All at least
 * 0 fails for -0; it comes about only where an edge ends in the ray, (+0, +0), and starts where x > 0 > y (or
 * the reverse), and its other triangle then has +0. Around a corner the triangle before the first such edge
 * has +0 on both sides, so that a closed fan is still never missed. A determinant of 0 makes t no number or
 * infinite, which is not nearer. */
bool lineMeetsTriangle(RayShear ray, vec3 a, vec3 b, vec3 c, out float t) {
    const vec3 e = edgeFunctions(a, b, c);
    const ivec3 bits = floatBitsToInt(e);
    const bool inside = min(min(bits.x, bits.y), bits.z) >= 0 || max(max(bits.x, bits.y), bits.z) <= 0;
    t = (e.x * a.z + e.y * b.z + e.z * c.z) * ray.inverse / (e.x + e.y + e.z);
    return inside;
}

/** Whether the ray meets the triangle at a distance t in (0, nearest). */
bool meetsTriangle(RayShear ray, vec3 a, vec3 b, vec3 c, float nearest, out float t) {
    const bool inside = lineMeetsTriangle(ray, a, b, c, t);
    return inside && isNearer(t, nearest);
}

/** One edge function, as in edgeFunctions(). */
float edgeFunction(vec3 a, vec3 b) {
    precise float e = b.x * a.y - b.y * a.x;
    return e;
}

/** As meetsTriangle() for a flat convex quadrilateral of sheared corners in order, split along b and d;
 * `half_`: 1 where the half away from a is met, else 0. */
bool meetsQuad(RayShear ray, vec3 a, vec3 b, vec3 c, vec3 d, float nearest, out float t, out int half_) {
    const float ab = edgeFunction(a, b), da = edgeFunction(d, a), diagonal = edgeFunction(b, d);
    const ivec4 bits =
        floatBitsToInt(vec4(ab, edgeFunction(b, c), edgeFunction(c, d), da));
    const bool inside = min(min(bits.x, bits.y), min(bits.z, bits.w)) >= 0 ||
                        max(max(bits.x, bits.y), max(bits.z, bits.w)) <= 0;
    const float determinant = diagonal + da + ab;
    t = (diagonal * a.z + da * b.z + ab * d.z) * ray.inverse / determinant;
    // Beyond the diagonal its weight has the other sign than the first half's area.
    half_ = int((floatBitsToUint(diagonal) ^ floatBitsToUint(determinant)) >> 31);
    return inside && isNearer(t, nearest);
}

/** Barycentrics of v0, v1, v2 where the ray meets the triangle's plane; they sum to 1. */
vec3 barycentrics(RayShear ray, vec3 v0, vec3 v1, vec3 v2) {
    const vec3 e = edgeFunctions(sheared(ray, v0), sheared(ray, v1), sheared(ray, v2));
    const float sum = e.x + e.y + e.z;
    const vec2 b = sum != 0.0 ? e.yz / sum : vec2(0.0);
    return vec3(1.0 - b.x - b.y, b);
}
#endif
