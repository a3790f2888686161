// Of the clusters that did not show in the last image, those are listed to be drawn that what has been drawn since does
// not hide.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "passes/raster/cluster_view.glsl"
#include "shaders/raster/state.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2, std430) readonly buffer uClusterState { ClusterState state; };
layout(set = 0, binding = 5, std430) buffer uFound { uint found; };  ///< clusters that are listed
layout(set = 0, binding = 1) uniform usamplerBuffer uPyramid;  ///< least depth codes

/// Whether all that is drawn within the pixels is nearer than any of the cluster: then no key of it can win.
bool isHidden(ClusterView view, ivec2 size) {
    ivec4 cells = view.pixels / DEPTH_CELL;
    int extent = max(cells.z - cells.x, cells.w - cells.y);
    // The finest level on which these are at most two by two cells.
    int level = extent > 1 ? findMSB(extent - 1) + 1 : 0;
    int start = 0;
    for (int k = 0; k < level; ++k) {
        ivec2 all = depthCells(size, k);
        start += all.x * all.y;
    }
    cells >>= level;
    int stride = depthCells(size, level).x;
    uint least = min(min(texelFetch(uPyramid, start + cells.y * stride + cells.x).x,
                        texelFetch(uPyramid, start + cells.y * stride + cells.z).x),
                    min(texelFetch(uPyramid, start + cells.w * stride + cells.x).x,
                        texelFetch(uPyramid, start + cells.w * stride + cells.z).x));
    return view.isWhole && view.nearest < int(least);
}

void main() {
    uint place = push.first + gl_GlobalInvocationID.x;
    bool isThere = place < state.candidates;
    uint cluster = list[state.clusters - 1u - (isThere ? place : 0u)];
    bool hidden = isThere && isHidden(viewOf(cluster), imageSizePixels());
    if (isThere && !hidden) list[state.clusters + atomicAdd(found, 1u)] = cluster;
    uvec2 sums = subgroupAdd(uvec2(hidden ? trianglesOf(cluster) : 0u, uint(hidden)));
    if (subgroupElect()) {
        atomicAdd(counters[COUNT_HIDDEN], uint64_t(sums.x));
        atomicAdd(counters[COUNT_CLUSTERS_HIDDEN], uint64_t(sums.y));
    }
}
