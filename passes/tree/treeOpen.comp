// Up to eight children of each node of a level: the largest that is no leaf gives way to its own two until there are eight;
// then each takes the free octant that it lies towards most.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/wide.glsl"

layout(set = 0, binding = 1, std430) readonly buffer uChildren { uvec2 children[]; };
layout(set = 0, binding = 3, std430) readonly buffer uItems { uvec2 items[]; };
layout(set = 0, binding = 4, std430) writeonly buffer uOpened { uint opened[]; };  ///< references by slots, 8 a place of the level
layout(set = 0, binding = 5, std430) writeonly buffer uValues { uint values[]; };  ///< 1 where a child is a node

/** Half the surface, of a box scaled to at most 1: large coordinates have no squares. */
float surface(uint reference) {
    const vec3 e = (upperOf(reference) - lowerOf(reference)) * push.scale;
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

void main() {
    const uint place = push.begin + invocation();
    if (place >= push.count) return;
    const uint n = push.triangles;
    const uint parent = items[place].x;
    const uint at = (place - push.begin) * 8u;
    uint child[8];
    float size[8];  // -1: cannot be opened; small ones, which may be leaves, come after all others
    for (int k = 0; k < 8; ++k) {
        child[k] = TREE_NONE;
        size[k] = -1.0;
    }
    bool anyNode = false;
    if (parent != TREE_NONE) {
        int filled = 2;
        child[0] = children[parent].x;
        child[1] = children[parent].y;
        bool opening = true;
        for (int k = 0; k < 2; ++k) {
            const uint many = countOf(child[k], n);
            size[k] = many > TREE_LEAF ? 1.0 + surface(child[k]) : (many > 1u ? 1e-3 * surface(child[k]) : -1.0);
        }
        while (opening) {
            int best = -1;
            float most = -0.5;
            for (int k = 0; k < filled; ++k) {
                best = size[k] > most ? k : best;
                most = max(most, size[k]);
            }
            opening = best >= 0 && filled < 8;
            if (opening) {
                const uvec2 pair = children[child[best]];
                child[best] = pair.x;
                child[filled] = pair.y;
                for (int k = 0; k < 2; ++k) {
                    const int to = k == 0 ? best : filled;
                    const uint many = countOf(child[to], n);
                    size[to] = many > TREE_LEAF ? 1.0 + surface(child[to]) : (many > 1u ? 1e-3 * surface(child[to]) : -1.0);
                }
                ++filled;
            }
        }
        const vec3 middle = 0.5 * lowerOf(parent) + 0.5 * upperOf(parent);
        uint free = 0xffu;
        uint inSlot[8];
        for (int s = 0; s < 8; ++s) inSlot[s] = TREE_NONE;
        for (int k = 0; k < filled; ++k) {
            const vec3 d = (0.5 * lowerOf(child[k]) + 0.5 * upperOf(child[k]) - middle) * push.scale;
            int slot = 0;
            float most = -1e30;
            for (int s = 0; s < 8; ++s) {
                const float towards = ((s & 1) != 0 ? d.x : -d.x) + ((s & 2) != 0 ? d.y : -d.y) + ((s & 4) != 0 ? d.z : -d.z);
                const bool better = (free >> s & 1u) != 0u && towards > most;
                slot = better ? s : slot;
                most = better ? towards : most;
            }
            free &= ~(1u << slot);
            inSlot[slot] = child[k];
            anyNode = anyNode || countOf(child[k], n) > TREE_LEAF;
        }
        for (int s = 0; s < 8; ++s) child[s] = inSlot[s];
    }
    for (int s = 0; s < 8; ++s) opened[at + uint(s)] = child[s];
    values[place - push.begin] = anyNode ? 1u : 0u;
}
