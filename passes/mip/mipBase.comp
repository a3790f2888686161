// Level 1 of every texture from the textures themselves, in linear light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/scene/textures.glsl"
#include "passes/mip/mip.glsl"

layout(local_size_x = 64) in;

void main() {
    MipTexel texel = mipTexel();
    uvec4 header = texelFetch(uTextures, texel.source);
    BoxTaps tapsX = boxTaps(texel.at.x, texel.sourceSize.x), tapsY = boxTaps(texel.at.y, texel.sourceSize.y);
    vec4 sum = vec4(0.0);
    [[unroll]] for (int y = 0; y < 3; ++y)
        [[unroll]] for (int x = 0; x < 3; ++x) {
            // A tap beyond the edge has weight 0.
            ivec2 at = min(ivec2(tapsX.first + x, tapsY.first + y), texel.sourceSize - 1);
            float weight = tapsX.weight[x] * tapsY.weight[y];
            vec4 value = fetchTexel(header, at.x, at.y);
            sum += weight == 0.0 ? vec4(0.0) : weight * value;
        }
    if (texel.valid) imageStore(uMips, texel.target, sum);
}
