// One stage of Stockham's transform of radix 2 along the rows or the columns: it reads pairs half a line apart and writes
// them so that the results come out in order, with no bit reversal.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/trigonometry.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer uFrom { vec2 from[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uTo { vec2 to[]; };
layout(push_constant, std430) uniform Push {
    uint first, pairs;  // of this dispatch, in all
    uint halfBits;      // log2 of half a line
    uint spanBits;      // log2 of the transforms that are done
    uint stride;        // from one value of a line to the next
    uint lineStride;    // from one line to the next
    float sign, scale;
} push;

void main() {
    uint t = push.first + gl_GlobalInvocationID.x;
    if (t >= push.pairs) return;
    uint line = t >> push.halfBits, i = t & ((1u << push.halfBits) - 1u), k = i & ((1u << push.spanBits) - 1u);
    uint base = line * push.lineStride;
    vec2 a = from[base + i * push.stride], b = from[base + (i + (1u << push.halfBits)) * push.stride];
    // exp(sign 2 pi i k / (2 span)): the argument is exact.
    float sine, cosine;
    sinCosTurns(push.sign * float(k) / float(2u << push.spanBits), sine, cosine);
    vec2 turned = vec2(b.x * cosine - b.y * sine, b.x * sine + b.y * cosine);
    uint at = ((i >> push.spanBits) << (push.spanBits + 1u)) + k;
    to[base + at * push.stride] = push.scale * (a + turned);
    to[base + (at + (1u << push.spanBits)) * push.stride] = push.scale * (a - turned);
}
