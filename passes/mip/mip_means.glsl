// Levels of one texture from the finer texels one by one.
#ifndef PASSES_MIP_MIP_MEANS_GLSL
#define PASSES_MIP_MIP_MEANS_GLSL

#include "passes/mip/mip_wide.glsl"
#include "shaders/texture/box.glsl"

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
    ivec2 at = ivec2(0);
    if (!wideTexel(at)) return;
    if (TWO_LEVELS)
        storeTwoLevels(at, meanOfFour(at), meanOfFour(at + ivec2(1, 0)), meanOfFour(at + ivec2(0, 1)), meanOfFour(at + 1));
    else imageStore(uMips, push.target + at.y * push.size.x + at.x, meanOfBox(at));
}

#endif
