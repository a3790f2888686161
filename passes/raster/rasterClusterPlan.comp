// Sizes a phase's dispatches from what culling has listed. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/cluster.glsl"

layout(local_size_x = 1) in;
layout(constant_id = 126) const int PHASE = 0;
layout(set = 0, binding = 0, std430) buffer uState {
    ClusterState state;
    uint groups[];
};
layout(set = 0, binding = 1, std430) readonly buffer uFound { uint found; };  ///< rasterCullHidden.comp
layout(push_constant, std430) uniform Push {
    uint clusters;   // all there are
    uint batch;      // clusters set up together
    uint batches;
    uint cells;      // of the pyramid's finest level: x | y << 16
} push;

void main() {
    if (PHASE == 0) {
        state.clusters = push.clusters;
        // Fewer than half that did not show are drawn along: cheaper than a look at every pixel's depth.
        bool test = state.unseen > state.seen;
        state.candidates = test ? state.unseen : 0u;
        state.count[0] = state.seen + (test ? 0u : state.unseen);
        uint x = push.cells & 0xffffu, y = push.cells >> 16;
        state.depthGroups[0] = x;
        state.depthGroups[1] = y;
        state.pyramidGroups[0] = state.pyramidGroups[1] = state.testGroups[1] = 1u;
        state.testGroups[0] = (state.candidates + 63u) / 64u;
        state.depthGroups[2] = state.pyramidGroups[2] = state.testGroups[2] = test ? 1u : 0u;
    }
    if (PHASE == 1) state.count[1] = found;
    uint count = state.count[PHASE];
    for (uint k = 0u; k < push.batches; ++k) {
        uint first = k * push.batch, own = count > first ? min(count - first, push.batch) : 0u;
        uint at = (uint(PHASE) * push.batches + k) * 6u;
        groups[at] = (own + 7u) / 8u;
        groups[at + 3u] = min(own, 1u);
        groups[at + 1u] = groups[at + 2u] = groups[at + 4u] = groups[at + 5u] = 1u;
    }
}
