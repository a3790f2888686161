// The binary radix tree over sorted codes, each node by itself (Karras, "Maximizing parallelism in the construction of BVHs,
// octrees, and k-d trees", 2012). Triangles of the same code are told apart by their places. Node 0 is the root.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uSorted { uvec2 codes[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uChildren { uvec2 children[]; };  ///< references
layout(set = 0, binding = 2, std430) writeonly buffer uRanges { uvec2 ranges[]; };      ///< first and last sorted triangle

/** Leading bits that the keys of two sorted triangles share; -1 beyond the ends. */
int alike(int i, int j) {
    if (j < 0 || j >= int(push.triangles)) return -1;
    const uint unlike = codes[i].x ^ codes[j].x;
    return unlike != 0u ? 31 - findMSB(unlike) : 63 - findMSB(uint(i) ^ uint(j));
}

void main() {
    const int i = int(invocation()), n = int(push.triangles);
    if (i >= n - 1) return;
    // The range goes from i to where more is shared.
    const int d = alike(i, i + 1) > alike(i, i - 1) ? 1 : -1;
    const int least = alike(i, i - d);
    int most = 2;
    while (alike(i, i + most * d) > least) most *= 2;
    int span = 0;
    for (int t = most / 2; t >= 1; t /= 2) span += alike(i, i + (span + t) * d) > least ? t : 0;
    const int j = i + span * d, prefix = alike(i, j);
    int split = 0;
    for (int t = span; t > 1;) {
        t = (t + 1) / 2;
        split += alike(i, i + (split + t) * d) > prefix ? t : 0;
    }
    const int gap = i + split * d + min(d, 0), first = min(i, j), last = max(i, j);
    children[i] = uvec2(first == gap ? n - 1 + gap : gap, last == gap + 1 ? n + gap : gap + 1);
    ranges[i] = uvec2(first, last);
}
