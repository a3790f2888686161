// Boxes around clusters of triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/cluster.glsl"
#include "shaders/scene/triangles.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer uBounds { vec4 bounds[]; };  ///< lower, upper corner
layout(push_constant, std430) uniform Push { uint firstCluster; uint triangles; } push;

// An invocation has a cluster of its own: this runs once for a scene.
void main() {
    uint cluster = push.firstCluster + gl_GlobalInvocationID.x, first = cluster * CLUSTER_TRIANGLES;
    if (first >= push.triangles) return;
    vec3 lower = vec3(3.4e38), upper = vec3(-3.4e38);
    for (uint k = 0u; k < CLUSTER_TRIANGLES; ++k) {
        Triangle t = fetchTriangle(int(min(first + k, push.triangles - 1u)));
        lower = min(lower, min(t.v0, min(t.v1, t.v2)));
        upper = max(upper, max(t.v0, max(t.v1, t.v2)));
    }
    bounds[2u * cluster] = vec4(lower, 0.0);
    bounds[2u * cluster + 1u] = vec4(upper, 0.0);
}
