// Set-up: every triangle of the batch is transformed and culled; small ones are drawn at once by 64-bit atomics,
// others are listed for the tiles or for clipping.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "passes/raster/setup.glsl"
