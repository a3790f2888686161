// Boxes: of the sorted triangles; then of two neighbours each, level by level; then of the radix tree's nodes, whose triangles
// are neighbours, from few of those. No invocation waits for another: a barrier of memory inside a loop ends the loop on lavapipe
// of Mesa 22.3.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uCorners { float corners[]; };
layout(set = 0, binding = 1, std430) readonly buffer uSorted { uvec2 codes[]; };
layout(set = 0, binding = 2, std430) readonly buffer uRanges { uvec2 ranges[]; };
/** Of all references, then the levels above the triangles. */
layout(set = 0, binding = 3, std430) buffer uBoxes { float boxes[]; };

layout(constant_id = 0) const int STEP = 0;

struct Box {
    vec3 lower, upper;
};

vec3 corner(uint i) {
    return vec3(corners[i * 3u], corners[i * 3u + 1u], corners[i * 3u + 2u]);
}
void grow(inout Box box, uint place) {
    const uint at = place * 6u;
    box.lower = min(box.lower, vec3(boxes[at], boxes[at + 1u], boxes[at + 2u]));
    box.upper = max(box.upper, vec3(boxes[at + 3u], boxes[at + 4u], boxes[at + 5u]));
}
void store(uint place, Box box) {
    const uint at = place * 6u;
    boxes[at] = box.lower.x;
    boxes[at + 1u] = box.lower.y;
    boxes[at + 2u] = box.lower.z;
    boxes[at + 3u] = box.upper.x;
    boxes[at + 4u] = box.upper.y;
    boxes[at + 5u] = box.upper.z;
}

void main() {
    const uint i = invocation(), n = push.triangles;
    Box box = Box(vec3(3.4e38), vec3(-3.4e38));
    if (STEP == 0 && i < n) {
        const uint t = codes[i].y * 3u;
        const vec3 a = corner(t), b = corner(t + 1u), c = corner(t + 2u);
        store(n - 1u + i, Box(min(min(a, b), c), max(max(a, b), c)));
    }
    if (STEP == 1 && i < (push.count + 1u) / 2u) {  // `begin`, `count`: of the level below
        grow(box, push.begin + 2u * i);
        grow(box, push.begin + min(2u * i + 1u, push.count - 1u));
        store(push.begin + push.count + i, box);
    }
    if (STEP == 2 && i < n - 1u) {
        uint first = ranges[i].x, end = ranges[i].y + 1u, level = n - 1u, size = n;
        while (first < end) {
            // Odd ends are not in the level above.
            if ((first & 1u) != 0u) grow(box, level + first++);
            if ((end & 1u) != 0u) grow(box, level + --end);
            first >>= 1;
            end >>= 1;
            level += size;
            size = (size + 1u) / 2u;
        }
        store(i, box);
    }
}
