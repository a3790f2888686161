#ifndef HELIOGRAPH_SCENE_TRIANGLES
#define HELIOGRAPH_SCENE_TRIANGLES
/** @file
 * World-space triangles. "Slot" is the place in the buffer (the tree's order), g the index in scene order.
 * Read as unsigned words, so that the integers among them can never be flushed as denormal floats. A scene that moves
 * is compiled with MOTION_KEYS, one with shapes beside its triangles with SHAPES (shaders/intersection/shape.glsl).
 */
#include "shaders/scene/features.glsl"
#ifdef INSTANCES
#include "shaders/scene/placed.glsl"

layout(constant_id = 160) const int PLACED_BITS = 0;  ///< of a triangle in its mesh, see placed.glsl
#endif

/** 3 texels a slot: v0.xyz | g, v1.xyz | instance, v2.xyz | material. */
layout(set = 0, binding = 20) uniform usamplerBuffer uTriangles;

struct Triangle {
    vec3 v0;
    vec3 v1;
    vec3 v2;
    int g;         ///< index in scene order: of normals, texcoords, colours
    int instance;
    int material;
#ifdef INSTANCES
    int placed;    ///< its placement in uPlaced, -1 for none: then corners and attributes are the world's
#endif
#ifdef SHAPES
    int shape;  ///< SHAPE_..., whose centre is v0, and v1 and v2 its axes; 0 for a triangle
#endif
};

#ifdef MOTION_KEYS
/** Corners at MOTION_KEYS times, evenly over the time that is rendered: 3 texels a slot, one time after another. */
layout(set = 0, binding = 39) uniform samplerBuffer uTriangleKeys;

/** The time of what is traced: between which keys, and how far. A kernel sets it before it traces. */
int motionKey = 0;
float motionFraction = 0.0;

/** `time`: 0 to 1. */
void setMotionTime(float time) {
    const float place = clamp(time, 0.0, 1.0) * float(MOTION_KEYS - 1);
    motionKey = min(int(place), MOTION_KEYS - 2);
    motionFraction = place - float(motionKey);
}

/** A corner at that time: in a straight line between keys, and within their box whatever the rounding. */
vec3 movingCorner(int slot, int corner) {
    const int at = (motionKey * TRIANGLE_COUNT + slot) * 3 + corner;
    const vec3 from = texelFetch(uTriangleKeys, at).xyz, to = texelFetch(uTriangleKeys, at + TRIANGLE_COUNT * 3).xyz;
    return clamp(from * (1.0 - motionFraction) + to * motionFraction, min(from, to), max(from, to));
}
#endif

#if defined(MOTION_KEYS) && defined(SHAPES)
/** Length at that time of what stands in place of a corner. */
float movingLength(int slot, int corner) {
    const int at = (motionKey * TRIANGLE_COUNT + slot) * 3 + corner;
    return mix(length(texelFetch(uTriangleKeys, at).xyz), length(texelFetch(uTriangleKeys, at + TRIANGLE_COUNT * 3).xyz),
               motionFraction);
}
#endif

Triangle fetchTriangle(int slot) {
#ifdef INSTANCES
    const int placed = slot < TRIANGLE_COUNT ? -1 : (slot - TRIANGLE_COUNT) >> PLACED_BITS;
    const int before = placed < 0 ? 0 : int(texelFetch(uPlaced, placed * 9 + 7).w);
    const int texel = (slot - before) * 3;
#else
    const int texel = slot * 3;
#endif
    const uvec4 a = texelFetch(uTriangles, texel);
    const uvec4 b = texelFetch(uTriangles, texel + 1);
    const uvec4 c = texelFetch(uTriangles, texel + 2);
    Triangle t;
    t.v0 = uintBitsToFloat(a.xyz);
    t.v1 = uintBitsToFloat(b.xyz);
    t.v2 = uintBitsToFloat(c.xyz);
    t.g = int(a.w);
    t.instance = int(b.w);
    t.material = int(c.w);
#ifdef INSTANCES
    t.placed = placed;
    if (placed >= 0) {
        const Placement placement = placementOf(placed);
        t.v0 = placedCorner(placement, t.v0);
        t.v1 = placedCorner(placement, t.v1);
        t.v2 = placedCorner(placement, t.v2);
        t.instance = int(texelFetch(uPlaced, placed * 9 + 8).w);
    }
#endif
#ifdef MOTION_KEYS
    t.v0 = movingCorner(slot, 0);
    t.v1 = movingCorner(slot, 1);
    t.v2 = movingCorner(slot, 2);
#endif
#ifdef SHAPES
    t.shape = t.material >> 28;
    t.material &= 0x0fffffff;
#ifdef MOTION_KEYS
    // Axes that turn are shorter between keys: what is round keeps its size.
    if (t.shape == 1 || t.shape == 5) t.v1 *= movingLength(slot, 1) / length(t.v1);
    if (t.shape == 5) t.v2 *= movingLength(slot, 2) / length(t.v2);
#endif
#endif
    return t;
}
#endif
