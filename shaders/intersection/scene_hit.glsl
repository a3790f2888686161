#ifndef HELIOGRAPH_INTERSECTION_SCENE_HIT
#define HELIOGRAPH_INTERSECTION_SCENE_HIT
/** @file What a ray meets in the scene, through the tree or, for a few triangles, by testing each. */
#include "shaders/intersection/traverse.glsl"
#include "shaders/scene/features.glsl"

layout(constant_id = 121) const bool USE_TREE = true;



// Defines testAll() where the scene is written out (passes/pathtrace/unrolled_scene.hpp).
#include "generated.glsl"

#ifndef UNROLLED_SCENE
/** Tests every triangle; as traverse(). */
void testAll(vec3 origin, vec3 direction, int source, inout float nearest, out int slot) {
    const RayShear ray = shearOf(origin, direction);
    slot = -1;
    [[unroll]] for (int i = 0; i < TRIANGLE_COUNT; ++i) {
        const vec3 a = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, i * 3).xyz));
        const vec3 b = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, i * 3 + 1).xyz));
        const vec3 c = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, i * 3 + 2).xyz));
        float t;
        const bool hit = meetsTriangle(ray, a, b, c, nearest, t) && i != source;
        nearest = hit ? t : nearest;
        slot = hit ? i : slot;
    }
}
#endif

/** Nearest triangle along the ray: its slot, -1 for none, and its distance. Returns turns of loops taken. */
int closestHit(vec3 origin, vec3 direction, int source, out float distance, out int slot) {
    distance = INFINITE_DISTANCE;
    slot = -1;
    if (TRIANGLE_COUNT == 0) return 0;
    if (USE_TREE) return traverse(origin, direction, false, source, distance, slot);
    testAll(origin, direction, source, distance, slot);
    return 0;
}

/** Whether anything lies within (0, limit) along the ray; limit <= 0 asks nothing. */
int occluded(vec3 origin, vec3 direction, int source, float limit, out bool hit) {
    hit = false;
    if (TRIANGLE_COUNT == 0) return 0;
    float nearest = limit;
    int slot, steps = 0;
    if (USE_TREE)
        steps = traverse(origin, direction, true, source, nearest, slot);
    else
        testAll(origin, direction, source, nearest, slot);
    hit = slot >= 0;
    return steps;
}
#endif
