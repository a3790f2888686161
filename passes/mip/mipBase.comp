// Level 1 of every texture from the textures themselves, in linear light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/scene/textures.glsl"
#include "passes/mip/mip.glsl"
#include "passes/mip/normal_texels.glsl"
#include "passes/mip/srgb_codes.glsl"

layout(local_size_x = 64) in;

vec4 baseTexel(uvec4 header, ivec2 at) {
    int index = int(header.x) + at.y * int(header.y) + at.x;
    vec4 value = vec4(0.0);
    if (!HAS_FLOAT_TEXTURES || (header.w & TEXTURE_FLOAT) == 0u) {
        uint bits = texelFetch(uTexels8, index).x;
        value = unpackUnorm4x8(bits);
        if (!HAS_LINEAR_TEXTURES || (header.w & TEXTURE_LINEAR) == 0u)
            value.rgb = linearLight(uvec4(bits & 255u, bits >> 8 & 255u, bits >> 16 & 255u, 0u)).rgb;
    }
    if (HAS_FLOAT_TEXTURES && (header.w & TEXTURE_FLOAT) != 0u) value = texelFetch(uTexelsFloat, index);
    return (header.w & TEXTURE_NORMALS) != 0u ? unitNormalTexel(value) : value;
}

void main() {
    MipTexel texel = mipTexel();
    uvec4 header = texelFetch(uTextures, texel.source);
    vec4 sum = vec4(0.0);
    [[unroll]] for (int y = 0; y < 3; ++y)
        [[unroll]] for (int x = 0; x < 3; ++x) {
            // A tap beyond the edge has weight 0.
            ivec2 at = min(ivec2(texel.tapsX.first + x, texel.tapsY.first + y), texel.sourceSize - 1);
            float weight = texel.tapsX.weight[x] * texel.tapsY.weight[y];
            vec4 value = baseTexel(header, at);
            sum += weight == 0.0 ? vec4(0.0) : weight * value;
        }
    if (texel.valid) imageStore(uMips, texel.target, sum);
}
