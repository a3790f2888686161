#ifndef HELIOGRAPH_PATHTRACE_SURFACE
#define HELIOGRAPH_PATHTRACE_SURFACE
/** @file The surface at a hit. */
#include "shaders/intersection/offset.glsl"
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/attributes.glsl"
#include "shaders/scene/materials.glsl"
#include "shaders/scene/triangles.glsl"

/** Where a ray met the scene. */
struct SurfacePoint {
    vec3 position;
    vec3 face;      ///< unit geometric normal on the ray's side
    vec3 shading;   ///< unit shading normal, turned with `face`
    bool front;
    float offset;   ///< along `face`, for rays that leave
    vec3 b;         ///< barycentrics of the corners
    Triangle triangle;
};

/** The point of the triangle in `slot` that a ray meets. */
SurfacePoint surfaceAt(vec3 origin, vec3 direction, int slot) {
    SurfacePoint s;
    s.triangle = fetchTriangle(slot);
    const vec3 v0 = s.triangle.v0, v1 = s.triangle.v1, v2 = s.triangle.v2;
    s.b = barycentrics(shearOf(origin, direction), v0, v1, v2);
    s.position = s.b.x * v0 + s.b.y * v1 + s.b.z * v2;
    const vec3 across = cross(v1 - v0, v2 - v0);
    // Scaled first: the square of a small triangle's normal is no normal float.
    const float largest = max(max(abs(across.x), abs(across.y)), abs(across.z));
    const vec3 scaled = across / (largest > 0.0 ? largest : 1.0);
    const vec3 normal = scaled / max(length(scaled), 0.5);
    s.front = dot(normal, direction) < 0.0;
    s.face = s.front ? normal : -normal;
    const vec3 shading = shadingNormal(s.triangle.g, s.b, normal);
    s.shading = s.front ? shading : -shading;
    s.offset = offsetDistance(v0, v1, v2, normal);
    return s;
}
#endif
