// A level from 2 of every texture from the level above it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes/mip/mip.glsl"

layout(local_size_x = 64) in;

void main() {
    MipTexel texel = mipTexel();
    vec4 sum = vec4(0.0);
    [[unroll]] for (int y = 0; y < 3; ++y)
        [[unroll]] for (int x = 0; x < 3; ++x) {
            ivec2 at = min(ivec2(texel.tapsX.first + x, texel.tapsY.first + y), texel.sourceSize - 1);
            float weight = texel.tapsX.weight[x] * texel.tapsY.weight[y];
            vec4 value = imageLoad(uMips, texel.source + at.y * texel.sourceSize.x + at.x);
            sum += weight == 0.0 ? vec4(0.0) : weight * value;
        }
    if (texel.valid) imageStore(uMips, texel.target, sum);
}
