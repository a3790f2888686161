// The tile kernel with 8 invocations a tile, for subgroups of at most so many: set-ups then serve the whole tile, and four
// keys are written at a time, since some CPU drivers write invocation by invocation. Four tiles a workgroup: workgroups
// cost a lock.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_ballot : require
#define ROWS 4
#define COLUMNS 4
#define PARTS 2
#define TILES 4
#include "passes/raster/tile.glsl"
