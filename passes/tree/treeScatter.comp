// Codes to their places by one digit, runs in order: last step of a stable radix sort.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uCodes { uvec2 codes[]; };
layout(set = 0, binding = 1, std430) buffer uTable { uint table[]; };  ///< next place of each digit and run
layout(set = 0, binding = 2, std430) writeonly buffer uSorted { uvec2 sorted[]; };

void main() {
    const uint run = invocation(), runs = (push.triangles + TREE_RUN - 1u) / TREE_RUN;
    if (run >= runs) return;
    const uint end = min((run + 1u) * TREE_RUN, push.triangles);
    for (uint i = run * TREE_RUN; i < end; ++i) {
        const uvec2 code = codes[i];
        const uint at = bitfieldExtract(code.x, int(push.shift), int(TREE_DIGIT_BITS)) * runs + run;
        sorted[table[at]++] = code;
    }
}
