// Levels of one texture, a row of invocations for a row of texels: for levels that are worth a dispatch of their own.
// Where the finer level's sizes are multiples of 4 an invocation makes four texels, and the one of the next level above
// them; else one texel.
#ifndef PASSES_MIP_MIP_WIDE_GLSL
#define PASSES_MIP_MIP_WIDE_GLSL

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

/// Whether the invocation has a texel `at` to make (the first of four where two levels are made).
bool wideTexel(out ivec2 at) {
    ivec2 invocation = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow);
    at = TWO_LEVELS ? 2 * invocation : invocation;
    return WHOLE_GROUPS || (at.x < push.size.x && at.y < push.size.y);
}

/// Four texels from `at`, row by row, and their mean on the next level.
void storeTwoLevels(ivec2 at, vec4 a, vec4 b, vec4 c, vec4 d) {
    int target = push.target + at.y * push.size.x + at.x;
    imageStore(uMips, target, a);
    imageStore(uMips, target + 1, b);
    imageStore(uMips, target + push.size.x, c);
    imageStore(uMips, target + push.size.x + 1, d);
    imageStore(uMips, push.second + (at.y >> 1) * (push.size.x >> 1) + (at.x >> 1), 0.25 * (a + b + c + d));
}

#endif
