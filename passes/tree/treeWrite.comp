// The nodes of a level (engine/scene/bvh.hpp), the order of their leaves' triangles, and the items of the next level.
// Without doubles: quotients are moved outwards by more than their rounding.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/wide.glsl"

layout(set = 0, binding = 1, std430) readonly buffer uSorted { uvec2 codes[]; };
layout(set = 0, binding = 3, std430) buffer uItems { uvec2 items[]; };
layout(set = 0, binding = 4, std430) readonly buffer uOpened { uint opened[]; };
layout(set = 0, binding = 5, std430) readonly buffer uValues { uint values[]; };  ///< nodes of the level before that have nodes
layout(set = 0, binding = 6, std430) writeonly buffer uNodesOut { uint nodes[]; };
layout(set = 0, binding = 7, std430) writeonly buffer uOrder { uint order[]; };

/** A quotient of differences of floats errs by less than this part of it. */
const float ROUNDING = 5e-7;

/** Least biased exponent with which 255 steps span an extent, and its roundings. */
uint exponentFor(float extent) {
    const uint bits = floatBitsToUint(extent * (1.0 + 4.0 * ROUNDING) * (1.0 / 255.0));
    return clamp((bits >> 23) + 1u, 1u, 250u);
}

void main() {
    const uint place = push.begin + invocation();
    if (place >= push.count) return;
    const uint n = push.triangles, at = (place - push.begin) * 8u;
    const uvec2 item = items[place];
    uint words[20];
    for (int w = 0; w < 20; ++w) words[w] = 0u;
    if (item.x != TREE_NONE) {
        const vec3 lower = lowerOf(item.x), extent = upperOf(item.x) - lower;
        const uvec3 exponent = uvec3(exponentFor(extent.x), exponentFor(extent.y), exponentFor(extent.z));
        const vec3 perUnit = uintBitsToFloat((254u - exponent) << 23);
        for (int k = 0; k < 3; ++k) words[k] = floatBitsToUint(lower[k]);
        words[3] = exponent.x | (exponent.y << 8) | (exponent.z << 16);
        const uint firstChild = push.count + 8u * values[place - push.begin];
        words[4] = firstChild;
        words[5] = item.y;
        uint slots = 0u, leaves = 0u;
        bool anyNode = false;
        for (uint s = 0u; s < 8u; ++s) {
            const uint child = opened[at + s];
            const bool there = child != TREE_NONE;
            const uint many = there ? countOf(child, n) : 0u;
            const bool isNode = many > TREE_LEAF;
            anyNode = anyNode || isNode;
            slots |= isNode ? 1u << s : ((1u << many) - 1u) << (8u + 3u * s);
            if (there && !isNode) {
                const uint first = child >= n - 1u ? child - (n - 1u) : ranges[child].x;
                for (uint k = 0u; k < many; ++k) order[item.y + leaves + k] = codes[first + k].y;
                leaves += many;
            }
            uvec3 low = uvec3(255u), high = uvec3(0u);
            if (there) {
                const vec3 from = (lowerOf(child) - lower) * perUnit, to = (upperOf(child) - lower) * perUnit;
                low = uvec3(clamp(floor(from * (1.0 - ROUNDING)), 0.0, 255.0));
                high = uvec3(clamp(ceil(to * (1.0 + ROUNDING)), 0.0, 255.0));
            }
            for (uint axis = 0u; axis < 3u; ++axis) {
                const uint word = 8u + 4u * axis + (s >> 2), shift = 8u * (s & 3u);
                words[word] |= low[axis] << shift;
                words[word + 2u] |= high[axis] << shift;
            }
        }
        words[6] = slots;
        // Triangles of this node's leaves come first, then those below each child.
        uint next = item.y + leaves;
        if (anyNode)
            for (uint s = 0u; s < 8u; ++s) {
                const uint child = opened[at + s];
                const bool isNode = (slots >> s & 1u) != 0u;
                items[firstChild + s] = uvec2(isNode ? child : TREE_NONE, next);
                next += isNode ? countOf(child, n) : 0u;
            }
    }
    for (int w = 0; w < 20; ++w) nodes[place * 20u + uint(w)] = words[w];
}
