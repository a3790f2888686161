// Common part of the mip kernels: which texel of which texture an invocation makes.
#ifndef PASSES_MIP_MIP_GLSL
#define PASSES_MIP_MIP_GLSL

#include "shaders/texture/box.glsl"

/**
 * Work of one level over all textures, 2 texels an item:
 * 0: first invocation, offset of the level in uMips, width, height
 * 1: offset of the finer level (in uMips; of level 1: texture's index), its width, its height, WHOLE_X | WHOLE_Y where
 * a ripmap's level is halved along the other axis alone
 */
layout(set = 0, binding = 0) uniform usamplerBuffer uMipWork;
layout(set = 0, binding = 1, rgba32f) uniform imageBuffer uMips;
layout(push_constant, std430) uniform Push {
    uint firstItem;
    uint items;
    uint invocations;
    uint firstInvocation;  // of this dispatch
} push;

struct MipTexel {
    bool valid;
    int target;  // in uMips
    ivec2 at;
    int source;  // offset or texture
    ivec2 sourceSize;
    BoxTaps tapsX, tapsY;
};
const uint WHOLE_X = 1u, WHOLE_Y = 2u;

MipTexel mipTexel() {
    uint global = push.firstInvocation + gl_GlobalInvocationID.x;
    uint invocation = min(global, push.invocations - 1u);
    // The last item that begins at or before the invocation.
    uint low = 0u, high = push.items;
    while (high - low > 1u) {
        uint middle = (low + high) >> 1;
        bool before = texelFetch(uMipWork, int(2u * (push.firstItem + middle))).x <= invocation;
        low = before ? middle : low;
        high = before ? high : middle;
    }
    uvec4 target = texelFetch(uMipWork, int(2u * (push.firstItem + low)));
    uvec4 source = texelFetch(uMipWork, int(2u * (push.firstItem + low) + 1u));
    uint index = invocation - target.x;
    MipTexel texel;
    texel.valid = global < push.invocations;
    texel.at.y = int(index / target.z);
    texel.at.x = int(index - uint(texel.at.y) * target.z);
    texel.target = int(target.y + index);
    texel.source = int(source.x);
    texel.sourceSize = ivec2(source.yz);
    texel.tapsX = boxTaps(texel.at.x, texel.sourceSize.x);
    texel.tapsY = boxTaps(texel.at.y, texel.sourceSize.y);
    if ((source.w & WHOLE_X) != 0u) texel.tapsX = BoxTaps(texel.at.x, vec3(1.0, 0.0, 0.0));
    if ((source.w & WHOLE_Y) != 0u) texel.tapsY = BoxTaps(texel.at.y, vec3(1.0, 0.0, 0.0));
    return texel;
}

#endif
