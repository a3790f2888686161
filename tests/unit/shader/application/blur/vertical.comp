#version 460
#extension GL_GOOGLE_include_directive : require
#include "tent.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { float values[]; } uValues;
void main() { uValues.values[gl_GlobalInvocationID.x] *= tent(int(gl_GlobalInvocationID.y)); }
