#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
/** @file
 * Rays from a buffer, hits into a buffer. Each subgroup has a run of rays of its own; a lane whose ray is done
 * takes the run's next one, so that lanes stay busy however long single rays take. What a ray meets does not
 * depend on the lane. A subgroup that has spent its budget of loop turns keeps its place in uCursors and goes
 * on in the next dispatch.
 */
#include "shaders/intersection/traverse.glsl"
#include "shaders/dispatch.glsl"

layout(local_size_x = 64) in;

/** See IntersectParameters in passes/intersect/ray_intersector.cpp. */
layout(push_constant) uniform Parameters {
    uint count;         ///< rays
    uint raysPerGroup;  ///< of a workgroup
    uint budget;        ///< loop turns after which no new ray is taken
    uint begin;         ///< 1: the first dispatch, uCursors holds nothing yet
} parameters;

/** 2 texels a ray: origin.xyz, limit; direction.xyz, bits of the slot it leaves (-1: none). */
layout(set = 0, binding = 0) uniform usamplerBuffer uRays;
/** Bits of the distance, slot (-1: none). */
layout(set = 0, binding = 1, std430) writeonly buffer Hits { uvec2 hits[]; } uHits;
/** Rays that a subgroup has taken. */
layout(set = 0, binding = 2, std430) buffer Cursors { uint taken[]; } uCursors;
layout(set = 0, binding = 3, std430) buffer Counters {
    uint open;       ///< subgroups with rays left
    uint abandoned;  ///< rays given up in the tree
} uCounters;

layout(constant_id = 0) const bool ANY = false;    ///< any hit within the limit will do
/** Lanes that wait before they are given rays; 0 takes a quarter of them. */
layout(constant_id = 1) const uint PATIENCE = 0u;
/** The device's, a power of two. lavapipe unrolls loops over constants only, and one left takes a tenth of a turn. */
layout(constant_id = 2) const uint SUBGROUP_SIZE = 8u;

/** Sum over the subgroup. Shuffles, since lavapipe's reductions are loops over lanes. All lanes are active. */
uint sumOfLanes(uint value) {
    [[unroll]] for (int i = 0; i < findMSB(SUBGROUP_SIZE); ++i) value += subgroupShuffleXor(value, 1u << i);
    return value;
}

/** Sum over the lanes before this one. */
uint sumBefore(uint value) {
    uint sum = value;
    [[unroll]] for (int i = 0; i < findMSB(SUBGROUP_SIZE); ++i) {
        const uint d = 1u << i;
        const uint left = subgroupShuffle(sum, gl_SubgroupInvocationID - min(d, gl_SubgroupInvocationID));
        sum += gl_SubgroupInvocationID >= d ? left : 0u;
    }
    return sum - value;
}

void main() {
    const uint group = interleavedGroup();
    const uint share = (parameters.raysPerGroup + gl_NumSubgroups - 1u) / gl_NumSubgroups;
    const uint first = group * parameters.raysPerGroup + gl_SubgroupID * share;
    const uint end = min(min(first + share, (group + 1u) * parameters.raysPerGroup), parameters.count);
    const uint place = group * gl_WorkGroupSize.x + gl_SubgroupID;
    uint next = parameters.begin != 0u ? first : uCursors.taken[place];

    Traversal t = beginTraversal(vec3(0.0), vec3(1.0), -1, ivec2(1, 0), 0.0);
    uint index = ~0u;
    uint spent = 0u, abandoned = 0u;
    // Uniform over the subgroup: all lanes stay active, so that all can be counted.
    uint waiting = SUBGROUP_SIZE;
    bool working = true;
    while (working) {
        const bool idle = !isBusy(t);
        if (idle && index != ~0u) {
            uHits.hits[index] = uvec2(floatBitsToUint(t.nearest), uint(t.slot));
            abandoned += t.steps >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
        }
        const bool open = spent < parameters.budget;
        const uint mine = next + sumBefore(idle ? 1u : 0u);
        const bool takes = idle && open && mine < end;
        next = open ? min(next + waiting, max(end, next)) : next;
        index = takes ? mine : (idle ? ~0u : index);
        if (takes) {
            const uvec4 from = texelFetch(uRays, int(mine) * 2), towards = texelFetch(uRays, int(mine) * 2 + 1);
            t = beginTraversal(uintBitsToFloat(from.xyz), uintBitsToFloat(towards.xyz), int(towards.w), ivec2(1, 0),
                               uintBitsToFloat(from.w));
        }
        const uint patience = open && next < end ? (PATIENCE > 0u ? PATIENCE : SUBGROUP_SIZE / 4u) : SUBGROUP_SIZE;
        do {
            takeTurn(t, ANY);
            ++spent;
            waiting = sumOfLanes(isBusy(t) ? 0u : 1u);
        } while (waiting < patience);
        ++spent;
        working = waiting < SUBGROUP_SIZE || (open && next < end) || sumOfLanes(index != ~0u ? 1u : 0u) > 0u;
    }
    if (subgroupElect()) {
        uCursors.taken[place] = next;
        if (next < end) atomicAdd(uCounters.open, 1u);
    }
    if (abandoned > 0u) atomicAdd(uCounters.abandoned, abandoned);
}
