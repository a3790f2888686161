#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
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
layout(constant_id = 1) const uint TURNS = 8u;     ///< between two looks for lanes that are done

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
    bool working = true;
    while (working) {
        const bool idle = !isBusy(t);
        if (idle && index != ~0u) {
            uHits.hits[index] = uvec2(floatBitsToUint(t.nearest), uint(t.slot));
            abandoned += t.steps >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
        }
        const uvec4 waiting = subgroupBallot(idle);
        const uint mine = next + subgroupBallotExclusiveBitCount(waiting);
        const bool takes = idle && spent < parameters.budget && mine < end;
        next = spent < parameters.budget ? min(next + subgroupBallotBitCount(waiting), max(end, next)) : next;
        index = takes ? mine : (idle ? ~0u : index);
        if (takes) {
            const uvec4 from = texelFetch(uRays, int(mine) * 2), towards = texelFetch(uRays, int(mine) * 2 + 1);
            t = beginTraversal(uintBitsToFloat(from.xyz), uintBitsToFloat(towards.xyz), int(towards.w), ivec2(1, 0),
                               uintBitsToFloat(from.w));
        }
        for (uint turn = 0u; turn < TURNS && isBusy(t); ++turn) takeTurn(t, ANY);
        spent += TURNS + 1u;
        working = subgroupAny(index != ~0u);
    }
    if (subgroupElect()) {
        uCursors.taken[place] = next;
        if (next < end) atomicAdd(uCounters.open, 1u);
    }
    if (abandoned > 0u) atomicAdd(uCounters.abandoned, abandoned);
}
