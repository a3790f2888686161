// Levels 1 and 2 of one texture of 8 bits, in linear light: four texels a read, 4 x 4 texels an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/mip/mip_wide.glsl"
#include "passes/mip/normal_texels.glsl"
#include "passes/mip/srgb_codes.glsl"

layout(set = 0, binding = 28, rgba32ui) uniform readonly uimageBuffer uTexels8;  ///< four texels of a row each
layout(constant_id = 124) const int TEXELS = 0;  ///< 0: sRGB; 1: data
layout(constant_id = 126) const bool NORMALS = false;

/// Colours of four texels, in columns.
mat4 decode(uvec4 bits) {
    const float unit = 1.0 / 255.0;
    uvec4 red = bits & 255u, green = bits >> 8 & 255u, blue = bits >> 16 & 255u;
    vec4 alpha = vec4(bits >> 24) * unit;
    if (TEXELS == 0) return transpose(mat4(linearLight(red), linearLight(green), linearLight(blue), alpha));
    mat4 texels = transpose(mat4(vec4(red) * unit, vec4(green) * unit, vec4(blue) * unit, alpha));
    if (NORMALS)
        texels = mat4(unitNormalTexel(texels[0]), unitNormalTexel(texels[1]), unitNormalTexel(texels[2]),
                      unitNormalTexel(texels[3]));
    return texels;
}

mat4 row(int first) { return decode(imageLoad(uTexels8, first)); }

void main() {
    ivec2 at = ivec2(0);
    if (!wideTexel(at)) return;
    int stride = push.sourceSize.x >> 2, first = (push.source >> 2) + 2 * at.y * stride + (at.x >> 1);
    mat4 above = row(first) + row(first + stride), below = row(first + 2 * stride) + row(first + 3 * stride);
    storeTwoLevels(at, 0.25 * (above[0] + above[1]), 0.25 * (above[2] + above[3]), 0.25 * (below[0] + below[1]),
                   0.25 * (below[2] + below[3]));
}
