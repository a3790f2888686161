#ifndef HELIOGRAPH_INTERSECTION_COMPARATORS
#define HELIOGRAPH_INTERSECTION_COMPARATORS
/** @file
 * Traversal of the accelerators of engine/scene/comparators.hpp; ACCELERATOR is an AcceleratorKind. Same triangle
 * test and same rule for ties as traverse.glsl, so that the hits are the same. Triangles are in scene order:
 * their slot is their g. Clear rather than fast: each turn tests a triangle of the cell at hand, or goes on to
 * the next cell.
 */
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/triangles.glsl"

#define ACCELERATOR_BRUTE_FORCE 2
#define ACCELERATOR_GRID 3
#define ACCELERATOR_OCTREE 4
#define ACCELERATOR_KD_TREE 5
#define ACCELERATOR_BSP 6

/** The words of a Comparator. */
layout(set = 0, binding = 21) uniform usamplerBuffer uNodes;
/** Entries of the stack: levels below the root, and one. */
layout(constant_id = 120) const int STACK_SIZE = 64;

/** See traverse.glsl. */
#if defined(SHAPES) && defined(LIGHTS_ASKED)
const int MAX_TRAVERSAL_STEPS = 4000;
#elif defined(SHAPES) || defined(LIGHTS_ASKED)
const int MAX_TRAVERSAL_STEPS = 8000;
#else
const int MAX_TRAVERSAL_STEPS = 16000;
#endif

uint wordAt(uint index) {
    const uvec4 texel = texelFetch(uNodes, int(index >> 2));
    const uint lane = index & 3u;
    return lane == 0u ? texel.x : (lane == 1u ? texel.y : (lane == 2u ? texel.z : texel.w));
}

float finiteInverse(float x) {
    return 1.0 / (abs(x) < 1e-20 ? (x < 0.0 ? -1e-20 : 1e-20) : x);
}

/** The hit so far. */
struct Nearest {
    float distance;
    int slot;
};

void testTriangle(RayShear ray, int candidate, const bool any, int source, ivec2 target, inout Nearest nearest) {
    const vec3 a = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3).xyz));
    const vec3 b = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 1).xyz));
    const vec3 c = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 2).xyz));
    float distance;
    bool hit = lineMeetsTriangle(ray, a, b, c, distance);
    hit = hit && (isNearer(distance, nearest.distance) ||
                  (!any && distance == nearest.distance && candidate < nearest.slot));
    hit = hit && candidate != source;
#ifdef SHAPES
    const int g = int(texelFetch(uTriangles, candidate * 3).w);  // shapes are in the last slots
#else
    const int g = candidate;
#endif
    if (any) hit = hit && (g < target.x || g > target.y);
    nearest.distance = hit ? distance : nearest.distance;
    nearest.slot = hit ? candidate : nearest.slot;
}

/** Part of the ray in the root's box; empty where x > y. */
vec2 rootInterval(vec3 origin, vec3 inverse, vec3 lower, vec3 upper) {
    const vec3 a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    const vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(min(high.x, high.y), high.z));
}

#if ACCELERATOR == ACCELERATOR_BRUTE_FORCE

int traverse(vec3 origin, vec3 direction, const bool any, int source, ivec2 target, inout float limit, out int slot) {
    const RayShear ray = shearOf(origin, direction);
    const int count = limit > 0.0 ? int(wordAt(0u)) : 0;
    Nearest nearest = Nearest(limit, -1);
    int steps = 0;
    for (; steps < count && !(any && nearest.slot >= 0); ++steps)
        testTriangle(ray, steps, any, source, target, nearest);
    limit = nearest.distance;
    slot = nearest.slot;
    return steps;
}

#elif ACCELERATOR == ACCELERATOR_GRID

int traverse(vec3 origin, vec3 direction, const bool any, int source, ivec2 target, inout float limit, out int slot) {
    const RayShear ray = shearOf(origin, direction);
    const vec3 inverse = vec3(finiteInverse(direction.x), finiteInverse(direction.y), finiteInverse(direction.z));
    const uvec4 first = texelFetch(uNodes, 0), second = texelFetch(uNodes, 1), third = texelFetch(uNodes, 2);
    const vec3 lower = uintBitsToFloat(first.xyz), upper = uintBitsToFloat(second.xyz);
    const vec3 cellSize = uintBitsToFloat(third.xyz);
    const ivec3 cells = ivec3(first.w, second.w, third.w);
    const uint table = texelFetch(uNodes, 3).x;
    const bvec3 backwards = lessThan(inverse, vec3(0.0));
    const ivec3 forward = ivec3(backwards.x ? 0 : 1, backwards.y ? 0 : 1, backwards.z ? 0 : 1);
    const ivec3 step = 2 * forward - 1;
    const vec2 interval = rootInterval(origin, inverse, lower, upper);

    ivec3 cell = clamp(ivec3(floor((origin + interval.x * direction - lower) / cellSize)), ivec3(0), cells - 1);
    Nearest nearest = Nearest(limit, -1);
    bool inside = limit > 0.0 && interval.x <= interval.y && interval.x <= limit;
    uint next = 0u, end = 0u;
    bool entered = false;
    int steps = 0;
    while (inside && steps < MAX_TRAVERSAL_STEPS) {
        ++steps;
        if (!entered) {
            const uint place = table + uint((cell.z * cells.y + cell.y) * cells.x + cell.x);
            next = wordAt(place);
            end = wordAt(place + 1u);
            entered = true;
        }
        if (next < end) {
            testTriangle(ray, int(wordAt(next)), any, source, target, nearest);
            ++next;
        }
        if (any && nearest.slot >= 0) inside = false;
        if (next >= end && inside) {
            // Computed from the cell's place, not summed up: errors do not grow along the way.
            const vec3 leave = (lower + vec3(cell + forward) * cellSize - origin) * inverse;
            const int axis = leave.x <= leave.y ? (leave.x <= leave.z ? 0 : 2) : (leave.y <= leave.z ? 1 : 2);
            inside = min(leave.x, min(leave.y, leave.z)) <= nearest.distance;
            cell += ivec3(axis == 0 ? step.x : 0, axis == 1 ? step.y : 0, axis == 2 ? step.z : 0);
            inside = inside && all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, cells));
            cell = clamp(cell, ivec3(0), cells - 1);
            entered = false;
        }
    }
    limit = nearest.distance;
    slot = nearest.slot;
    return steps;
}

#else

/** The child that the ray is in after `from`, as a number among its siblings, and where it leaves it, if before
 * `to`. What lies at a crossing belongs to the far side. */
uint childAt(vec3 origin, vec3 direction, vec3 inverse, vec4 split, float from, inout float to) {
#if ACCELERATOR == ACCELERATOR_OCTREE
    const vec3 crossing = (split.xyz - origin) * inverse;
    uint child = 0u;
    [[unroll]] for (int axis = 0; axis < 3; ++axis) {
        const bool before = from < crossing[axis];
        child |= before == (inverse[axis] < 0.0) ? 1u << axis : 0u;
        to = before ? min(to, crossing[axis]) : to;
    }
    return child;
#else
    const float towards = finiteInverse(dot(split.xyz, direction));
    const float crossing = (split.w - dot(split.xyz, origin)) * towards;
    const bool before = from < crossing;
    to = before ? min(to, crossing) : to;
    return before == (towards < 0.0) ? 1u : 0u;
#endif
}

int traverse(vec3 origin, vec3 direction, const bool any, int source, ivec2 target, inout float limit, out int slot) {
    const RayShear ray = shearOf(origin, direction);
    const vec3 inverse = vec3(finiteInverse(direction.x), finiteInverse(direction.y), finiteInverse(direction.z));
    const vec2 interval =
        rootInterval(origin, inverse, uintBitsToFloat(texelFetch(uNodes, 0).xyz), uintBitsToFloat(texelFetch(uNodes, 1).xyz));

    // Nodes that the ray comes back to, after a child: the node, and where it is left.
    uint stackNode[STACK_SIZE];
    float stackLeave[STACK_SIZE];
    int top = 0;
    uint node = 0u;
    float from = interval.x, to = interval.y;
    Nearest nearest = Nearest(limit, -1);
    bool descending = limit > 0.0 && from <= to && from <= limit;
    uint next = 0u, end = 0u;
    int steps = 0;
    while ((descending || next < end) && steps < MAX_TRAVERSAL_STEPS) {
        ++steps;
        if (next < end) {
            testTriangle(ray, int(wordAt(next)), any, source, target, nearest);
            ++next;
            if (any && nearest.slot >= 0) {
                next = end;
                descending = false;
            }
        }
        if (descending && next >= end) {
            const vec4 split = uintBitsToFloat(texelFetch(uNodes, int(2u + 2u * node)));
            const uvec4 data = texelFetch(uNodes, int(3u + 2u * node));
            if (data.x != 0u) {
                float leave = to;
                const uint child = data.x + childAt(origin, direction, inverse, split, from, leave);
                if (leave < to) {
                    stackNode[top] = node;
                    stackLeave[top] = to;
                    ++top;
                }
                node = child;
                to = leave;
            } else {
                next = data.y;
                end = data.y + data.z;
                // On with the node that was left for a child, from where that child ends.
                from = to;
                descending = top > 0;
                top = max(top - 1, 0);
                node = stackNode[top];
                to = stackLeave[top];
            }
        }
        // Past the nearest hit; the cell that it was found in is tested to the end.
        if (next >= end && from > nearest.distance) descending = false;
    }
    limit = nearest.distance;
    slot = nearest.slot;
    return steps;
}
#endif
#endif
