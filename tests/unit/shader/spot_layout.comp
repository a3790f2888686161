#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/real.glsl"
#include "tests/unit/shader/spot.glsl"
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Spots { Spot spots[]; } uSpots;
layout(push_constant, std430) uniform Push { Vec3 position; Real power; Vec3 direction; uint id; } uPush;
void main() {
    uSpots.spots[uPush.id].position += uPush.position + uPush.power * uPush.direction;
}
