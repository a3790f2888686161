// Level 1 of one texture from its texels, in linear light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes/mip/mip_wide.glsl"

// As in shaders/scene/textures.glsl, but as images: lavapipe reads neighbours faster so.
layout(set = 0, binding = 28, r32ui) uniform readonly uimageBuffer uTexels8;
layout(set = 0, binding = 29, rgba32f) uniform readonly imageBuffer uTexelsFloat;
layout(set = 0, binding = 2, r32f) uniform readonly imageBuffer uDecoded;  ///< linear light of each of 256 sRGB codes
layout(constant_id = 124) const int TEXELS = 0;  ///< 0: 8 bits, sRGB; 1: 8 bits, data; 2: floats

vec4 finerTexel(int index) {
    if (TEXELS == 2) return imageLoad(uTexelsFloat, index);
    uint bits = imageLoad(uTexels8, index).x;
    vec4 value = unpackUnorm4x8(bits);
    if (TEXELS == 0)
        value.rgb = vec3(imageLoad(uDecoded, int(bits & 255u)).x, imageLoad(uDecoded, int(bits >> 8 & 255u)).x,
                         imageLoad(uDecoded, int(bits >> 16 & 255u)).x);
    return value;
}

void main() { makeLevels(); }
