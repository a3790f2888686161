#ifndef HELIOGRAPH_PATHTRACE_SEE_THROUGH
#define HELIOGRAPH_PATHTRACE_SEE_THROUGH
/** @file
 * What a ray meets where alpha lets some of it pass: a surface stops it with the chance of its alpha (0 or 1 for
 * masks), and rays to lights are weakened by what is left. Scenes without alpha have none of this.
 */
#include "passes/pathtrace/surface.glsl"
#include "shaders/intersection/scene_hit.glsl"

#ifdef SURFACE_MATERIALS
#include "shaders/sampling/hash.glsl"
#include "shaders/scene/surface_material.glsl"

/** Surfaces that a ray passes at most; the next stops it. */
const int MAX_LAYERS = 256;

/** Where the ray goes on behind the triangle, and what the triangle stops of it. */
float passTriangle(vec3 origin, vec3 direction, int source, int slot, out vec3 beyond, out int g) {
    const SurfacePoint s = surfaceAt(origin, direction, source, slot);
    beyond = s.position - s.face * s.offset;
    g = s.triangle.g;
    return opacity(s.triangle.material, g, s.b);
}
#endif

/** closestHit over what stops the ray. `key` decides; where `solid`, all but holes of masks does. */
int closestSurface(vec3 origin, vec3 direction, int source, uint key, const bool solid, out float distance, out int slot) {
    int turns = closestHit(origin, direction, source, distance, slot);
#ifdef SURFACE_MATERIALS
    if (HAS_ALPHA) {
        vec3 start = origin;
        int from = source;
        float passed = 0.0;
        for (int layer = 0; layer < MAX_LAYERS && slot >= 0 && turns < MAX_TRAVERSAL_STEPS; ++layer) {
            vec3 beyond;
            int g;
            const float stopped = passTriangle(start, direction, from, slot, beyond, g);
            if (solid ? stopped > 0.0 : unitFloat(hashCombine(key, uint(g))) < stopped) break;
            passed += distance;
            start = beyond;
            from = slot;
            turns += 1 + closestHit(start, direction, from, distance, slot);
        }
        distance += passed;
    }
#endif
    return turns;
}

/** occluded, with what of the light `passes` where it is not. */
int shadowed(vec3 origin, vec3 direction, int source, ivec2 target, float limit, out bool blocked, out float passes) {
    passes = 1.0;
#ifdef SURFACE_MATERIALS
    if (HAS_ALPHA) {
        vec3 start = origin;
        int from = source, turns = 0;
        float left = limit;
        blocked = false;
        for (int layer = 0; layer < MAX_LAYERS && left > 0.0 && turns < MAX_TRAVERSAL_STEPS; ++layer) {
            float distance;
            int slot;
            turns += 1 + closestHit(start, direction, from, distance, slot);
            if (slot < 0 || distance >= left) break;
            vec3 beyond;
            int g;
            const float stopped = passTriangle(start, direction, from, slot, beyond, g);
            if (g >= target.x && g <= target.y) break;
            passes *= 1.0 - stopped;
            blocked = passes <= 0.0;
            left = blocked ? 0.0 : left - distance;
            start = beyond;
            from = slot;
        }
        return turns;
    }
#endif
    return occluded(origin, direction, source, target, limit, blocked);
}
#endif
