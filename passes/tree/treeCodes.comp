// Morton codes of triangles' boxes' middles, ten bits an axis, in cells that are cubes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/tree/tree.glsl"

layout(set = 0, binding = 0, std430) readonly buffer uCorners { float corners[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uCodes { uvec2 codes[]; };  ///< code, triangle

/** Every bit of ten goes to three times its place. */
uint spread(uint x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

vec3 corner(uint i) {
    return vec3(corners[i * 3u], corners[i * 3u + 1u], corners[i * 3u + 2u]);
}

void main() {
    const uint i = invocation();
    if (i >= push.triangles) return;
    const vec3 a = corner(i * 3u), b = corner(i * 3u + 1u), c = corner(i * 3u + 2u);
    const vec3 middle = 0.5 * min(min(a, b), c) + 0.5 * max(max(a, b), c);
    const uvec3 cell = uvec3(clamp((middle - push.lower) * push.scale * 1024.0, 0.0, 1023.0));
    codes[i] = uvec2(spread(cell.x) | (spread(cell.y) << 1) | (spread(cell.z) << 2), i);
}
