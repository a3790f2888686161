// Levels of one texture, a row of invocations for a row of texels: for levels that are worth a dispatch of their own.
// Where the finer level's sizes are multiples of 4 an invocation makes four texels, and the one of the next level above
// them; else one texel.
#ifndef PASSES_MIP_MIP_WIDE_GLSL
#define PASSES_MIP_MIP_WIDE_GLSL

#include "shaders/texture/box.glsl"

layout(local_size_x = 128, local_size_y = 8) in;
layout(set = 0, binding = 1, rgba32f) uniform imageBuffer uMips;
layout(push_constant, std430) uniform Push {
    ivec2 size;        // of the level
    ivec2 sourceSize;  // of the finer level
    int target;        // first texel in uMips
    int source;        // of the finer level, there or among the texels
    int second;        // of the next level, where two are made
    int firstRow;      // of invocations in this dispatch
} push;

layout(constant_id = 123) const bool TWO_LEVELS = false;
layout(constant_id = 125) const bool WHOLE_GROUPS = false;  ///< no invocation is beyond the level: none needs a mask

vec4 finerTexel(int index);

/// Mean of two by two finer texels from (2x, 2y).
vec4 meanOfFour(ivec2 at) {
    int above = push.source + 2 * (at.y * push.sourceSize.x + at.x), below = above + push.sourceSize.x;
    return 0.25 * (finerTexel(above) + finerTexel(above + 1) + finerTexel(below) + finerTexel(below + 1));
}

/// Of any size (shaders/texture/box.glsl).
vec4 meanOfBox(ivec2 at) {
    BoxTaps tapsX = boxTaps(at.x, push.sourceSize.x), tapsY = boxTaps(at.y, push.sourceSize.y);
    vec4 sum = vec4(0.0);
    [[unroll]] for (int y = 0; y < 3; ++y)
        [[unroll]] for (int x = 0; x < 3; ++x) {
            // A tap beyond the edge has weight 0.
            ivec2 tap = min(ivec2(tapsX.first + x, tapsY.first + y), push.sourceSize - 1);
            float weight = tapsX.weight[x] * tapsY.weight[y];
            vec4 value = finerTexel(push.source + tap.y * push.sourceSize.x + tap.x);
            sum += weight == 0.0 ? vec4(0.0) : weight * value;
        }
    return sum;
}

void makeLevels() {
    ivec2 invocation = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow);
    ivec2 at = TWO_LEVELS ? 2 * invocation : invocation;
    if (!WHOLE_GROUPS && (at.x >= push.size.x || at.y >= push.size.y)) return;
    int target = push.target + at.y * push.size.x + at.x;
    if (TWO_LEVELS) {
        vec4 a = meanOfFour(at), b = meanOfFour(at + ivec2(1, 0)), c = meanOfFour(at + ivec2(0, 1)),
             d = meanOfFour(at + 1);
        imageStore(uMips, target, a);
        imageStore(uMips, target + 1, b);
        imageStore(uMips, target + push.size.x, c);
        imageStore(uMips, target + push.size.x + 1, d);
        imageStore(uMips, push.second + invocation.y * (push.size.x >> 1) + invocation.x, 0.25 * (a + b + c + d));
    } else {
        imageStore(uMips, target, meanOfBox(at));
    }
}

#endif
