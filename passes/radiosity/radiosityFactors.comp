#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
/** @file
 * Form factors between patches, one pair an invocation: from three points of the one to the whole other one by Lambert's
 * closed form, times the share of three rays that arrive. Three points integrate what is quadratic over a patch.
 */
#include "shaders/intersection/offset.glsl"
#include "shaders/intersection/scene_hit.glsl"
#include "shaders/raster/polygon_light.glsl"
#include "shaders/scene/triangles.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Parameters {
    uint count;     ///< patches
    uint firstRow;  ///< patch that the first row is of
    uint rows;
} parameters;

layout(set = 0, binding = 0) uniform usamplerBuffer uPatches;  ///< PatchList::places
/** A row's patches: for each point what arrives on the front, on the back; negative where the other patch is seen from
 * behind. */
layout(set = 0, binding = 1, std430) writeonly buffer Factors { float values[]; } uFactors;

struct Part {
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 normal;   ///< unit
    float offset;  ///< for rays that leave or arrive
    int slot;
    int g;
};

Part partAt(uint index) {
    const uvec4 place = texelFetch(uPatches, int(index));
    const Triangle t = fetchTriangle(int(place.x));
    const float size = 1.0 / float(place.y >> 1);
    const bool upper = (place.y & 1u) != 0u;
    const vec2 corner = (vec2(place.zw) + (upper ? 1.0 : 0.0)) * size;
    const float step = upper ? -size : size;
    const vec3 e1 = t.v1 - t.v0, e2 = t.v2 - t.v0;
    const vec3 a = t.v0 + e1 * corner.x + e2 * corner.y;
    const vec3 normal = normalizeSafe(cross(e1, e2), vec3(0.0));
    return Part(a, a + e1 * step, a + e2 * step, normal, offsetDistance(t.v0, t.v1, t.v2, normal), int(place.x), t.g);
}

vec3 pointOf(Part p, int k) {
    const vec3 weights = vec3(k == 0 ? 2.0 / 3.0 : 1.0 / 6.0, k == 1 ? 2.0 / 3.0 : 1.0 / 6.0, k == 2 ? 2.0 / 3.0 : 1.0 / 6.0);
    return weights.x * p.a + weights.y * p.b + weights.z * p.c;
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    const uint row = index / parameters.count, column = index - row * parameters.count;
    if (row >= parameters.rows) return;
    const uint receiver = parameters.firstRow + row;
    const Part to = partAt(receiver), from = partAt(column);
    for (int k = 0; k < 3; ++k) {
        const vec3 p = pointOf(to, k);
        const vec3 corner = from.a - p;
        vec2 arrives = vec2(quadIrradiance(to.normal, corner, from.b - from.a, from.c - from.a, from.c - from.a),
                            quadIrradiance(-to.normal, corner, from.b - from.a, from.c - from.a, from.c - from.a)) * INV_PI;
        const bool asks = receiver != column && max(arrives.x, arrives.y) > 1e-9;
        vec2 rays = vec2(0.0), free = vec2(0.0);
        for (int m = 0; m < 3; ++m) {
            const vec3 q = pointOf(from, m);
            const bool above = dot(to.normal, q - p) > 0.0;
            const vec3 origin = p + to.normal * (above ? to.offset : -to.offset);
            const vec3 target = q + from.normal * (dot(from.normal, p - q) > 0.0 ? from.offset : -from.offset);
            bool blocked;
            occluded(origin, target - origin, to.slot, ivec2(from.g, from.g), asks ? 1.0 : 0.0, blocked);
            const vec2 side = above ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
            rays += side;
            free += blocked ? vec2(0.0) : side;
        }
        // Of a patch that the horizon cuts, a side may have no ray of its own.
        const float all = (free.x + free.y) * (1.0 / 3.0);
        arrives *= vec2(rays.x > 0.0 ? free.x / rays.x : all, rays.y > 0.0 ? free.y / rays.y : all);
        const float side = dot(from.normal, corner) < 0.0 ? 1.0 : -1.0;
        const uint at = (index * 3u + uint(k)) * 2u;
        uFactors.values[at] = asks ? arrives.x * side : 0.0;
        uFactors.values[at + 1u] = asks ? arrives.y * side : 0.0;
    }
}
