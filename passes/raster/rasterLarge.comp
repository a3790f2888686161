// Records of the listed triangles that need no clipping, with their entries counted and put in slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/view.glsl"
#include "shaders/scene/triangles.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer uState { RasterState state; };
layout(set = 0, binding = 2, std430) readonly buffer uLarge { uint large[]; };
layout(set = 0, binding = 3, std430) writeonly buffer uRecords { uvec4 records[]; };
layout(set = 0, binding = 4, std430) buffer uCounts { uint counts[]; };
layout(set = 0, binding = 5, std430) writeonly buffer uEntries { uint entries[]; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= state.largeCount) return;
    ivec2 size = imageSizePixels();
    uint t = large[index];
    Triangle source = fetchTriangle(int(t));
    HomogeneousVertex a = projectVertex(source.v0), b = projectVertex(source.v1), c = projectVertex(source.v2);
    Record record = makeRecord(snap(a.x, a.y, a.w), snap(b.x, b.y, b.w), snap(c.x, c.y, c.w), depthPlane(a, b, c),
                               uint(source.g), size);
    uint at = index * uint(RECORD_TEXELS);
    packRecord(record, records[at], records[at + 1u], records[at + 2u], records[at + 3u]);
    CellWalk walk = beginWalk(record, size, state.maxCells);
    for (; walk.left > 0; advance(walk))
        if (touches(walk)) {
            uint slot = atomicAdd(counts[cellIndex(walk)], 1u);
            if (slot < walk.slots) entries[slotPlace(walk) + slot] = index;
        }
}
