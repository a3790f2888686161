// Writes the entries of cells that have more than slots; their counts go down to 0 again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uRecords;
layout(set = 0, binding = 1, std430) readonly buffer uState { RasterState state; };
layout(set = 0, binding = 2, std430) readonly buffer uStarts { uvec2 starts[]; };  ///< place, length
layout(set = 0, binding = 3, std430) buffer uCounts { uint counts[]; };
layout(set = 0, binding = 4, std430) writeonly buffer uEntries { uint entries[]; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= state.recordCount) return;
    int at = int(index) * RECORD_TEXELS;
    Record record = unpackRecord(texelFetch(uRecords, at), texelFetch(uRecords, at + 1), texelFetch(uRecords, at + 2),
                                 texelFetch(uRecords, at + 3));
    ivec2 size = imageSizePixels();
    CellWalk walk = beginWalk(record, size, state.maxCells);
    uint slots = slotStart(size, LEVELS);
    for (; walk.left > 0; advance(walk)) {
        if (touches(walk)) {
            int cell = cellIndex(walk);
            uint start = starts[cell].x;
            if (start >= slots) entries[start + atomicAdd(counts[cell], 0xffffffffu) - 1u] = index;
        }
    }
}
