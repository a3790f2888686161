// The tile kernel with 16 invocations a tile: reading a triangle is shared by more pixels, which pays where subgroups
// are narrow (15 % on lavapipe).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define ROWS 8
#include "passes/raster/tile.glsl"
