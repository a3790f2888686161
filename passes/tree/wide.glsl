#ifndef HELIOGRAPH_TREE_WIDE
#define HELIOGRAPH_TREE_WIDE
/** @file What the two kernels share that make a level of eight-wide nodes. A place's item is the reference whose children
 * it gets and the place in the order of its first triangle; TREE_NONE for a hole. */
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uBoxes { float boxes[]; };
layout(set = 0, binding = 2, std430) readonly buffer uRanges { uvec2 ranges[]; };

uint countOf(uint reference, uint triangles) {
    return reference >= triangles - 1u ? 1u : ranges[reference].y - ranges[reference].x + 1u;
}
vec3 lowerOf(uint reference) {
    return vec3(boxes[reference * 6u], boxes[reference * 6u + 1u], boxes[reference * 6u + 2u]);
}
vec3 upperOf(uint reference) {
    return vec3(boxes[reference * 6u + 3u], boxes[reference * 6u + 4u], boxes[reference * 6u + 5u]);
}
#endif
