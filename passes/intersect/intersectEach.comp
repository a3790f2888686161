#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
/** @file Rays from a buffer, hits into a buffer, one ray an invocation: through the accelerators that are there to
 * compare with. Bindings and numbers as in intersect.comp. */
#ifndef ACCELERATOR
#define ACCELERATOR 2
#endif
#include "shaders/intersection/comparators.glsl"
#include "shaders/dispatch.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Parameters {
    uint count;
    uint raysPerGroup;  ///< a workgroup takes them 64 at a time
    uint budget;
    uint begin;
} parameters;

layout(set = 0, binding = 0) uniform usamplerBuffer uRays;
layout(set = 0, binding = 1, std430) writeonly buffer Hits { uvec2 hits[]; } uHits;
layout(set = 0, binding = 2, std430) buffer Cursors { uint taken[]; } uCursors;
layout(set = 0, binding = 3, std430) buffer Counters { uint open; uint abandoned; } uCounters;

layout(constant_id = 0) const bool ANY = false;

void main() {
    const uint place = interleavedGroup() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    const uint first = interleavedGroup() * parameters.raysPerGroup;
    const uint end = min(first + parameters.raysPerGroup, parameters.count);
    uint index = parameters.begin != 0u ? first + gl_LocalInvocationIndex : uCursors.taken[place];
    uint spent = 0u;
    while (index < end && spent < parameters.budget) {
        const uvec4 from = texelFetch(uRays, int(index) * 2), towards = texelFetch(uRays, int(index) * 2 + 1);
        float distance = uintBitsToFloat(from.w);
        int slot;
        const int steps = traverse(uintBitsToFloat(from.xyz), uintBitsToFloat(towards.xyz), ANY, int(towards.w),
                                   ivec2(1, 0), distance, slot);
        uHits.hits[index] = uvec2(floatBitsToUint(distance), uint(slot));
        if (steps >= MAX_TRAVERSAL_STEPS) atomicAdd(uCounters.abandoned, 1u);
        spent += uint(steps) + 1u;
        index += gl_WorkGroupSize.x;
    }
    uCursors.taken[place] = index;
    if (index < end) atomicAdd(uCounters.open, 1u);
}
