// Sizes the batch's later dispatches from what set-up listed. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/state.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer uState { RasterState state; };
layout(push_constant, std430) uniform Push { uint capacity; } push;  // entries

uint groups(uint invocations) { return (invocations + 63u) / 64u; }

void main() {
    uint records = state.largeCount + CLIP_PARTS * state.clippedCount;
    state.recordCount = records;
    // 64 cells also bounds the loops over cells, in which the longest holds up its neighbours.
    state.maxCells = min(push.capacity / max(records, 1u), 64u);
    state.largeGroups[0] = groups(state.largeCount);
    state.clipGroups[0] = groups(state.clippedCount);
    state.largeGroups[1] = state.largeGroups[2] = 1u;
    state.clipGroups[1] = state.clipGroups[2] = 1u;
}
