// How often each digit occurs in each run of codes: first step of a stable radix sort.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uCodes { uvec2 codes[]; };
layout(set = 0, binding = 1, std430) buffer uTable { uint table[]; };  ///< digit by digit, all runs of each

void main() {
    const uint run = invocation(), runs = (push.triangles + TREE_RUN - 1u) / TREE_RUN;
    if (run >= runs) return;
    for (uint digit = 0u; digit < TREE_DIGITS; ++digit) table[digit * runs + run] = 0u;
    const uint end = min((run + 1u) * TREE_RUN, push.triangles);
    for (uint i = run * TREE_RUN; i < end; ++i) ++table[bitfieldExtract(codes[i].x, int(push.shift), int(TREE_DIGIT_BITS)) * runs + run];
}
