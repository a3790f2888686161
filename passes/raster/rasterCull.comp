// Clusters outside the view are left out; those that showed in the last image are listed to be drawn first, and the
// others to be tested against what these hide.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "passes/raster/cluster_view.glsl"
#include "shaders/raster/state.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2, std430) buffer uClusterState { ClusterState state; };
layout(set = 0, binding = 1, std430) buffer uSeen { uint seen[]; };  ///< whether a cluster showed; begun anew

void main() {
    uint all = (push.count + CLUSTER_TRIANGLES - 1u) / CLUSTER_TRIANGLES;
    uint cluster = push.first + gl_GlobalInvocationID.x;
    bool isThere = cluster < all;
    ClusterView view = viewOf(isThere ? cluster : 0u);
    bool inside = isThere && !view.outside, drawn = false;
    if (isThere) {
        drawn = inside && seen[cluster] != 0u;
        seen[cluster] = 0u;
    }
    if (drawn) list[atomicAdd(state.seen, 1u)] = cluster;
    if (inside && !drawn) list[all - 1u - atomicAdd(state.unseen, 1u)] = cluster;
    uint triangles = isThere ? trianglesOf(cluster) : 0u;
    uvec4 sums = subgroupAdd(uvec4(triangles, inside ? 0u : triangles, uint(isThere), uint(isThere && !inside)));
    if (subgroupElect()) {
        atomicAdd(counters[COUNT_TRIANGLES], uint64_t(sums.x));
        atomicAdd(counters[COUNT_OUTSIDE], uint64_t(sums.y));
        atomicAdd(counters[COUNT_CLUSTERS], uint64_t(sums.z));
        atomicAdd(counters[COUNT_CLUSTERS_OUTSIDE], uint64_t(sums.w));
    }
}
