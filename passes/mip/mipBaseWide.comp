// Level 1 of one texture from its texels, in linear light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes/mip/mip_means.glsl"
#include "passes/mip/normal_texels.glsl"
#include "passes/mip/srgb_codes.glsl"

// As in shaders/scene/textures.glsl, but as images: lavapipe reads neighbours faster so.
layout(set = 0, binding = 28, r32ui) uniform readonly uimageBuffer uTexels8;
layout(set = 0, binding = 29, rgba32f) uniform readonly imageBuffer uTexelsFloat;
layout(constant_id = 124) const int TEXELS = 0;  ///< 0: 8 bits, sRGB; 1: 8 bits, data; 2: floats
layout(constant_id = 126) const bool NORMALS = false;

vec4 finerTexel(int index) {
    if (TEXELS == 2) return NORMALS ? unitNormalTexel(imageLoad(uTexelsFloat, index)) : imageLoad(uTexelsFloat, index);
    uint bits = imageLoad(uTexels8, index).x;
    vec4 value = unpackUnorm4x8(bits);
    if (TEXELS == 0) value.rgb = linearLight(uvec4(bits & 255u, bits >> 8 & 255u, bits >> 16 & 255u, 0u)).rgb;
    return NORMALS ? unitNormalTexel(value) : value;
}

void main() { makeLevels(); }
