// Sums before each value in three steps: of runs, over runs, within runs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) buffer uValues { uint values[]; };
layout(set = 0, binding = 1, std430) buffer uRuns { uint total; uint runs[]; };

layout(constant_id = 0) const int STEP = 0;

void main() {
    const uint run = invocation(), count = (push.count + TREE_RUN - 1u) / TREE_RUN;
    if (run >= (STEP == 1 ? 1u : count)) return;
    const uint begin = STEP == 1 ? 0u : run * TREE_RUN, end = STEP == 1 ? count : min(begin + TREE_RUN, push.count);
    uint sum = STEP == 2 ? runs[run] : 0u;
    for (uint i = begin; i < end; ++i) {
        const uint value = STEP == 1 ? runs[i] : values[i];
        if (STEP == 1) runs[i] = sum;
        if (STEP == 2) values[i] = sum;
        sum += value;
    }
    if (STEP == 0) runs[run] = sum;
    if (STEP == 1) total = sum;
}
