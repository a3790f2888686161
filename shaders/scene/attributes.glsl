#ifndef HELIOGRAPH_SCENE_ATTRIBUTES
#define HELIOGRAPH_SCENE_ATTRIBUTES
/** @file Vertex attributes, 3 texels a triangle in scene order. `b` are the barycentrics of v0, v1, v2. */
#include "shaders/scene/features.glsl"

layout(set = 0, binding = 22) uniform samplerBuffer uNormals;    ///< unit world-space shading normals
layout(set = 0, binding = 23) uniform samplerBuffer uTexcoords;  ///< u, v of slot 0, u, v of slot 1
layout(set = 0, binding = 24) uniform samplerBuffer uColors;     ///< linear RGBA

#ifdef MOTION_KEYS
#include "shaders/scene/triangles.glsl"

/** uNormals at each key, one time after another. */
layout(set = 0, binding = 40) uniform samplerBuffer uNormalKeys;

vec3 vertexNormal(int g, int corner) {
    const int at = (motionKey * TRIANGLE_COUNT + g) * 3 + corner;
    return texelFetch(uNormalKeys, at).xyz * (1.0 - motionFraction) +
           texelFetch(uNormalKeys, at + TRIANGLE_COUNT * 3).xyz * motionFraction;
}
#else
vec3 vertexNormal(int g, int corner) {
    return texelFetch(uNormals, g * 3 + corner).xyz;
}
#endif

/** Unit; `face` (unit) where the interpolation vanishes. */
vec3 interpolatedNormal(vec3 n0, vec3 n1, vec3 n2, vec3 b, vec3 face) {
    const vec3 n = b.x * n0 + b.y * n1 + b.z * n2;
    const float squared = dot(n, n);
    return squared > 1e-12 ? n * inversesqrt(squared) : face;
}

/** Interpolated shading normal, unit; `face` (unit) where the scene has none or the interpolation vanishes. */
vec3 shadingNormal(int g, vec3 b, vec3 face) {
    if (!HAS_NORMALS) return face;
    return interpolatedNormal(vertexNormal(g, 0), vertexNormal(g, 1), vertexNormal(g, 2), b, face);
}

#ifdef INSTANCES
#include "shaders/scene/triangles.glsl"

/** shadingNormal() of a triangle that may be placed: its corners' normals are the mesh's then. */
vec3 shadingNormal(Triangle t, vec3 b, vec3 face) {
    if (!HAS_NORMALS) return face;
    vec3 n0 = vertexNormal(t.g, 0), n1 = vertexNormal(t.g, 1), n2 = vertexNormal(t.g, 2);
    if (t.placed >= 0) {
        const Placement placement = placementOf(t.placed);
        n0 = placedNormal(placement, n0);
        n1 = placedNormal(placement, n1);
        n2 = placedNormal(placement, n2);
    }
    return interpolatedNormal(n0, n1, n2, b, face);
}
#endif

/** Both slots of texture coordinates: whichever sets the triangle's material names. */
vec4 texcoords(int g, vec3 b) {
    return b.x * texelFetch(uTexcoords, g * 3) + b.y * texelFetch(uTexcoords, g * 3 + 1) +
           b.z * texelFetch(uTexcoords, g * 3 + 2);
}

/** Interpolated vertex colour; white where the scene has none. */
vec4 vertexColor(int g, vec3 b) {
    if (!HAS_COLORS) return vec4(1.0);
    return b.x * texelFetch(uColors, g * 3) + b.y * texelFetch(uColors, g * 3 + 1) +
           b.z * texelFetch(uColors, g * 3 + 2);
}
#endif
