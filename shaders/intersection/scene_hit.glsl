#ifndef HELIOGRAPH_INTERSECTION_SCENE_HIT
#define HELIOGRAPH_INTERSECTION_SCENE_HIT
/** @file What a ray meets in the scene, through the tree, by testing each triangle where they are written out, or by
 * both: triangles that most rays come near are tested first, and the tree, where it is entered at all, holds the rest. */
#ifdef ACCELERATOR
#include "shaders/intersection/comparators.glsl"
#else
#include "shaders/intersection/traverse.glsl"
#endif
#include "shaders/scene/features.glsl"
#ifdef SHAPES
#include "shaders/intersection/shape.glsl"
#endif

// Defines testAll() and testAny() where the scene is written out (passes/pathtrace/unrolled_scene.hpp).
#include "generated.glsl"

/** A target that no triangle belongs to. */
const ivec2 NO_TARGET = ivec2(1, 0);

/** Nearest triangle along the ray: its slot, -1 for none, and its distance. Returns turns of loops taken. */
int closestTriangle(vec3 origin, vec3 direction, int source, out float distance, out int slot) {
    distance = INFINITE_DISTANCE;
    slot = -1;
    if (TRIANGLE_COUNT == 0) return 0;
#ifdef UNROLLED_SCENE
    int g;
    testAll(origin, direction, source, distance, slot, g);
    return 0;
#elif defined(UNROLLED_BESIDE_TREE)
    int g;
    testAll(origin, direction, source, distance, slot, g);
    Traversal t = beginTraversal(origin, direction, source, NO_TARGET, distance);
    t.slot = slot;
    t.g = g;
    while (isBusy(t)) takeTurn(t, false);
    distance = t.nearest;
    slot = t.slot;
    return t.steps;
#else
    return traverse(origin, direction, false, source, NO_TARGET, distance, slot);
#endif
}

/** Whether a triangle lies within (0, limit), see occluded(). */
int triangleBlocks(vec3 origin, vec3 direction, int source, ivec2 target, float limit, out bool hit) {
    hit = false;
    if (TRIANGLE_COUNT == 0) return 0;
#ifdef UNROLLED_SCENE
    hit = limit > 0.0 && testAny(origin, direction, source, target.x, limit);
    return 0;
#else
    float nearest = limit;
    int slot;
#ifdef UNROLLED_BESIDE_TREE
    const bool blocked = limit > 0.0 && testAny(origin, direction, source, target.x, limit);
    nearest = blocked ? 0.0 : limit;
#endif
    const int steps = traverse(origin, direction, true, source, target, nearest, slot);
    hit = slot >= 0;
#ifdef UNROLLED_BESIDE_TREE
    hit = hit || blocked;
#endif
    return steps;
#endif
}

/** Nearest surface along the ray: its slot, -1 for none, and its distance. Returns turns of loops taken. */
int closestHit(vec3 origin, vec3 direction, int source, out float distance, out int slot) {
    int turns = closestTriangle(origin, direction, source, distance, slot);
#ifdef SHAPES
    if (LISTED_SHAPES > 0) closestListed(origin, direction, source, distance, slot);
    turns += LISTED_TURNS;
#endif
    return turns;
}

/** Whether anything lies within (0, limit) along the ray; limit <= 0 asks nothing. What the ray leaves (slot)
 * and what it goes to (range of g) do not count: rounding cannot make a light shadow itself. */
int occluded(vec3 origin, vec3 direction, int source, ivec2 target, float limit, out bool hit) {
    int turns = triangleBlocks(origin, direction, source, target, limit, hit);
#ifdef SHAPES
    if (LISTED_SHAPES > 0 && limit > 0.0) hit = hit || listedBlocks(origin, direction, source, target, limit);
    turns += LISTED_TURNS;
#endif
    return turns;
}
#endif
