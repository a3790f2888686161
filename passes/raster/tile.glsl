// The tile kernel: a workgroup owns 16x16 pixels and one segment of the tile's lists; an invocation owns a strip of
// ROWS pixels of a column, in registers. No barriers, and no atomics but where a tile has several segments.
#ifndef PASSES_RASTER_TILE_GLSL
#define PASSES_RASTER_TILE_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 256 / ROWS) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uRecords;
layout(set = 0, binding = 1) uniform usamplerBuffer uEntries;
layout(set = 0, binding = 2, std430) readonly buffer uStarts { uint starts[]; };
layout(set = 0, binding = 3, std430) buffer uVisibility { uint64_t visibility[]; };
layout(set = 0, binding = 4, std430) buffer uCounters { uint64_t counters[]; };

// Edge values are cut here: over a tile they change by less than 2^29, so what is cut keeps its sign.
const int64_t EDGE_LIMIT = 1l << 30;

int cutEdge(ivec2 p, ivec2 q, ivec2 pixel) { return int(clamp(edgeAt(p, q, pixel), -EDGE_LIMIT, EDGE_LIMIT)); }

void main() {
    ivec2 size = imageSizePixels();
    ivec2 tiles = ivec2(gl_NumWorkGroups.xy);
    // Workgroups from both halves of the image alternate: drivers that cut the grid in contiguous parts, one for a
    // thread, then share the work evenly.
    int half_ = (tiles.y + 1) / 2, row = int(gl_WorkGroupID.y);
    ivec2 tile = ivec2(int(gl_WorkGroupID.x), row < half_ ? 2 * row : 2 * (row - half_) + 1);

    // The lists of the tile's cells, end to end: entry i of all lies at i + shift[level].
    uint ends[LEVELS];
    uint shift[LEVELS];
    uint total = 0u;
    [[unroll]] for (int level = 0; level < LEVELS; ++level) {
        int cell = levelStart(size, level) + (tile.y >> (2 * level)) * levelCells(size, level).x + (tile.x >> (2 * level));
        uint first = starts[cell];
        shift[level] = first - total;
        total += starts[cell + 1] - first;
        ends[level] = total;
    }
    uint begin = min(gl_WorkGroupID.z * SEGMENT, total), end = min(begin + SEGMENT, total);

    int lane = int(gl_LocalInvocationIndex);
    ivec2 pixel = tile * TILE_SIZE + ivec2(lane & 15, (lane >> 4) * ROWS);
    double x = double(pixel.x) + 0.5LF, y = double(pixel.y) + 0.5LF;
    int depth[ROWS];
    uint id[ROWS];
    [[unroll]] for (int k = 0; k < ROWS; ++k) {
        depth[k] = 0;
        id[k] = 0xffffffffu;
    }
    for (uint i = begin; i < end; ++i) {
        uint place = i + shift[0];
        [[unroll]] for (int level = 1; level < LEVELS; ++level) place = i >= ends[level - 1] ? i + shift[level] : place;
        int at = int(texelFetch(uEntries, int(place)).x) * RECORD_TEXELS;
        Record record = unpackRecord(texelFetch(uRecords, at), texelFetch(uRecords, at + 1), texelFetch(uRecords, at + 2),
                                     texelFetch(uRecords, at + 3));
        ivec3 e = ivec3(cutEdge(record.p, record.q, pixel), cutEdge(record.q, record.r, pixel),
                        cutEdge(record.r, record.p, pixel));
        ivec3 down = ivec3(record.q.x - record.p.x, record.r.x - record.q.x, record.p.x - record.r.x);
        [[unroll]] for (int k = 0; k < ROWS; ++k) {
            int z = depthBits(record.a, record.b * (y + double(k)) + record.c, x, record.low, record.high);
            bool inside = min(e.x, min(e.y, e.z)) >= 0;
            bool wins = inside && (z > depth[k] || (z == depth[k] && record.id < id[k]));
            depth[k] = wins ? z : depth[k];
            id[k] = wins ? record.id : id[k];
            e += down;
        }
    }
    bool shared_ = total > SEGMENT;
    [[unroll]] for (int k = 0; k < ROWS; ++k) {
        ivec2 at = pixel + ivec2(0, k);
        if (at.x < size.x && at.y < size.y && depth[k] != 0) {
            uint64_t key = visibilityKey(depth[k], id[k]);
            int index = at.y * size.x + at.x;
            if (shared_)
                atomicMax(visibility[index], key);
            else if (key > visibility[index])
                visibility[index] = key;
        }
    }
    if (lane == 0) atomicAdd(counters[COUNT_TILE_VISITED], uint64_t(end - begin));
}

#endif
