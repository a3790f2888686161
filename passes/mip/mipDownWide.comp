// A level from 2 of one texture from the level above it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes/mip/mip_means.glsl"

vec4 finerTexel(int index) { return imageLoad(uMips, index); }

void main() { makeLevels(); }
