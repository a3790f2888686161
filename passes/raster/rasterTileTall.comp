// The tile kernel with 16 invocations a tile, of eight rows each, and four tiles a workgroup: workgroups cost a lock on
// some CPU drivers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_ballot : require
#define ROWS 8
#define TILES 4
#include "passes/raster/tile.glsl"
