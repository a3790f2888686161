#version 460
#extension GL_GOOGLE_include_directive : require
#include "generated.glsl"
#include "tests/unit/shader/scale_values.glsl"
#ifndef FACTOR
#define FACTOR 2.0
#endif
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input { float values[]; } uInput;
layout(set = 0, binding = 1) writeonly buffer Output { float values[]; } uOutput;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < uInput.values.length()) uOutput.values[i] = scaled(uInput.values[i], FACTOR);
}
