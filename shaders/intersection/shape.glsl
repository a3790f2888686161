#ifndef HELIOGRAPH_INTERSECTION_SHAPE
#define HELIOGRAPH_INTERSECTION_SHAPE
/** @file
 * Spheres, planes, discs, quads and tori beside triangles, in kernels compiled with SHAPES; engine/scene/shape.hpp says what
 * their centre and two axes mean. Few are tested one by one after all else, many in the tree.
 */
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/triangles.glsl"
#include "shaders/shared/sphere.glsl"
#include "shaders/shared/torus.glsl"

const int SHAPE_SPHERE = 1, SHAPE_PLANE = 2, SHAPE_DISC = 3, SHAPE_QUAD = 4, SHAPE_TORUS = 5;

bool isFlat(Triangle shape) {
    return shape.shape >= SHAPE_PLANE && shape.shape <= SHAPE_QUAD;
}

layout(constant_id = 140) const int LISTED_SHAPES = 0;          ///< in the last slots, in no tree
layout(constant_id = 141) const bool SHAPES_IN_TREE = false;
layout(constant_id = 142) const bool HAS_SPHERES = true;
layout(constant_id = 144) const bool HAS_TORI = true;
layout(constant_id = 143) const bool HAS_FLAT_SHAPES = true;

/** Where the ray's line meets a flat shape's plane: coordinates along its axes. By the shear that triangles are tested
 * with, so that they are as exact far from the origin. */
vec2 flatCoordinates(RayShear ray, Triangle shape) {
    const vec3 c = sheared(ray, shape.v0);
    const vec2 a = vec2(dot(ray.x, shape.v1), dot(ray.y, shape.v1)), b = vec2(dot(ray.x, shape.v2), dot(ray.y, shape.v2));
    return vec2(c.y * b.x - c.x * b.y, c.x * a.y - c.y * a.x) / (a.x * b.y - a.y * b.x);
}

/** Unit normal of a flat shape's front. */
vec3 flatNormal(Triangle shape) {
    const vec3 sizes = max(abs(shape.v1), abs(shape.v2));
    const float inverse = 1.0 / max(max(sizes.x, sizes.y), sizes.z);  // squares of small axes are no normal floats
    return normalize(cross(shape.v1 * inverse, shape.v2 * inverse));
}

/** A ray that leaves a torus may meet it again, but no nearer than this part of its tube: at most as far as rounding leaves
 * the root that is its start, where it grazes. */
const float TORUS_LEAST = 1e-4;

TorusMeeting meetsTorus(vec3 origin, vec3 direction, Triangle torus, bool leaves) {
    const float tube = length(torus.v2);
    return meetTorus(origin, direction, torus.v0, flatNormal(torus), length(torus.v1), tube, leaves ? TORUS_LEAST * tube : 0.0);
}

/** Whether the ray meets the shape at a distance in (0, nearest); `leaves`: it starts on this very shape. */
bool meetsShape(RayShear ray, vec3 direction, Triangle shape, bool leaves, float nearest, out float t) {
    bool hit = false;
    t = -1.0;
    if (HAS_FLAT_SHAPES && isFlat(shape)) {
        const vec3 n = flatNormal(shape);
        const vec2 at = flatCoordinates(ray, shape);
        t = dot(shape.v0 - ray.origin, n) / dot(direction, n);
        const bool within = shape.shape == SHAPE_DISC ? dot(at, at) <= 1.0 : max(abs(at.x), abs(at.y)) <= 1.0;
        hit = (shape.shape == SHAPE_PLANE || within) && !leaves;
    }
    if (HAS_SPHERES && shape.shape == SHAPE_SPHERE) {
        const SphereMeeting m = meetSphere(ray.origin, direction, shape.v0, length(shape.v1));
        // A ray that leaves a sphere outwards meets it no more, whatever rounding says.
        t = m.inside ? m.high : m.low;
        hit = m.meets && (m.inside || !leaves);
    }
    if (HAS_TORI && shape.shape == SHAPE_TORUS) {
        const TorusMeeting m = meetsTorus(ray.origin, direction, shape, leaves);
        t = m.distance;
        hit = m.meets;
    }
    return hit && isNearer(t, nearest);
}

/** Turns of loops that the listed shapes may take. */
const int LISTED_TURNS = LISTED_SHAPES * (HAS_TORI ? TORUS_TURNS : 1);

/** What two rays of the tree and the list share: tests the shape in `slot`. */
bool meetsShapeIn(int slot, RayShear ray, vec3 direction, int source, float nearest, out float t, out int g) {
    const Triangle shape = fetchTriangle(slot);
    g = shape.g;
    return meetsShape(ray, direction, shape, slot == source, nearest, t);
}

/** The listed shape nearest within `distance`, if any; ties go to what was there before. */
void closestListed(vec3 origin, vec3 direction, int source, inout float distance, inout int slot) {
    const RayShear ray = shearOf(origin, direction);
    for (int i = TRIANGLE_COUNT - LISTED_SHAPES; i < TRIANGLE_COUNT; ++i) {
        float t;
        int g;
        const bool hit = meetsShapeIn(i, ray, direction, source, distance, t, g);
        distance = hit ? t : distance;
        slot = hit ? i : slot;
    }
}

/** Whether a listed shape but those of `target` lies within (0, limit). */
bool listedBlocks(vec3 origin, vec3 direction, int source, ivec2 target, float limit) {
    const RayShear ray = shearOf(origin, direction);
    bool blocked = false;
    for (int i = TRIANGLE_COUNT - LISTED_SHAPES; i < TRIANGLE_COUNT; ++i) {
        float t;
        int g;
        const bool hit = meetsShapeIn(i, ray, direction, source, limit, t, g);
        blocked = blocked || (hit && (g < target.x || g > target.y));
    }
    return blocked;
}
#endif
