// Clips the triangles that cross the near plane or the guard band, in homogeneous pixels and in double, and makes
// records of the parts, with their entries counted and put in slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/view.glsl"
#include "shaders/scene/triangles.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer uState { RasterState state; };
layout(set = 0, binding = 2, std430) readonly buffer uClipped { uint clipped[]; };
layout(set = 0, binding = 3, std430) writeonly buffer uRecords { uvec4 records[]; };
layout(set = 0, binding = 4, std430) buffer uCounts { uint counts[]; };
layout(set = 0, binding = 5, std430) buffer uCounters { uint64_t counters[]; };
layout(set = 0, binding = 6, std430) writeonly buffer uEntries { uint entries[]; };

// Sutherland and Hodgman's algorithm on corners (X, Y, w, distance to the near plane).
const int CORNERS = 8;

double planeDistance(dvec4 v, int plane) {
    precise double reach = GUARD_BAND * v.z;
    precise double d = plane == 0 ? v.w : plane == 1 ? v.x + reach : plane == 2 ? reach - v.x
                                      : plane == 3 ? v.y + reach : reach - v.y;
    return d;
}

/// Where an edge meets a plane, always taken from the inside to the outside corner, so that both triangles of a
/// shared edge find the same point.
dvec4 crossing(dvec4 inside, dvec4 outside, double dInside, double dOutside) {
    precise double t = dInside / (dInside - dOutside);
    precise dvec4 v = inside + t * (outside - inside);
    return v;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= state.clippedCount) return;
    ivec2 size = imageSizePixels();
    uint t = clipped[index];
    Triangle source = fetchTriangle(int(t));
    HomogeneousVertex a = projectVertex(source.v0), b = projectVertex(source.v1), c = projectVertex(source.v2);

    dvec4 polygon[CORNERS];
    polygon[0] = dvec4(a.x, a.y, a.w, a.near);
    polygon[1] = dvec4(b.x, b.y, b.w, b.near);
    polygon[2] = dvec4(c.x, c.y, c.w, c.near);
    int corners = 3;
    for (int plane = 0; plane < 5; ++plane) {
        dvec4 kept[CORNERS];
        int keptCount = 0;
        for (int k = 0; k < corners; ++k) {
            dvec4 current = polygon[k], next = polygon[k + 1 < corners ? k + 1 : 0];
            double dCurrent = planeDistance(current, plane), dNext = planeDistance(next, plane);
            bool currentInside = dCurrent >= 0.0LF, nextInside = dNext >= 0.0LF;
            if (currentInside && keptCount < CORNERS) kept[keptCount++] = current;
            if (currentInside != nextInside && keptCount < CORNERS)
                kept[keptCount++] = currentInside ? crossing(current, next, dCurrent, dNext)
                                                  : crossing(next, current, dNext, dCurrent);
        }
        corners = keptCount;
        for (int k = 0; k < CORNERS; ++k) polygon[k] = kept[k];
    }

    DepthPlane plane = depthPlane(a, b, c);
    ivec2 first = snap(polygon[0].x, polygon[0].y, polygon[0].z);
    ivec2 previous = snap(polygon[1].x, polygon[1].y, polygon[1].z);
    uint parts = 0u;
    for (int k = 0; k < int(CLIP_PARTS); ++k) {
        dvec4 corner = polygon[min(k + 2, CORNERS - 1)];
        ivec2 next = snap(corner.x, corner.y, corner.z);
        Record record = makeRecord(first, previous, next, plane, uint(source.g), size);
        record.used = record.used && k + 2 < corners;
        uint place = state.largeCount + index * CLIP_PARTS + uint(k), at = place * uint(RECORD_TEXELS);
        packRecord(record, records[at], records[at + 1u], records[at + 2u], records[at + 3u]);
        CellWalk walk = beginWalk(record, size, state.maxCells);
        for (; walk.left > 0; advance(walk))
            if (touches(walk)) {
                uint slot = atomicAdd(counts[cellIndex(walk)], 1u);
                if (slot < walk.slots) entries[slotPlace(walk) + slot] = place;
            }
        parts += uint(record.used);
        previous = next;
    }
    atomicAdd(counters[COUNT_PARTS], uint64_t(parts));
}
