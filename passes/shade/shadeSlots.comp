// The place of every triangle by its id, where triangles lie in another order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene/triangles.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer uSlots { uint slots[]; };
layout(push_constant, std430) uniform Push {
    uint first;
    uint count;
} push;

void main() {
    uint slot = push.first + gl_GlobalInvocationID.x;
    if (slot < push.count) slots[texelFetch(uTriangles, int(3u * slot)).w] = slot;
}
