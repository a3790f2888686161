#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/real.glsl"
#include "blur/weights.glsl"
#ifndef RADIUS
#define RADIUS 4
#endif
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { float values[]; } uValues;
void main() {
    float sum = 0.0;
    for (int i = -RADIUS; i <= RADIUS; ++i) sum += weight(i) * uValues.values[int(gl_GlobalInvocationID.x) + i];
    uValues.values[gl_GlobalInvocationID.x] = square(sum);
}
