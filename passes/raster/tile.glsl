// The tile kernel: a workgroup owns 16x16 pixels and one segment of the tile's lists; an invocation owns ROWS rows of
// two columns, in registers. The invocations of a subgroup set up a triangle each for the tile and then draw all of
// them together, handing the set-ups round by shuffles. No barriers, and no atomics but for segments after the first
// (TILE_SHARED): even masked out, they cost more than drawing.
#ifndef PASSES_RASTER_TILE_GLSL
#define PASSES_RASTER_TILE_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

#ifdef TILE_SHARED
const uint FIRST_SEGMENT = 1u;
#else
const uint FIRST_SEGMENT = 0u;
#endif
const int LANES = 128 / ROWS;  // 8 pairs of columns, 16 / ROWS strips
layout(local_size_x = 128 / ROWS) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uRecords;
layout(set = 0, binding = 1) uniform usamplerBuffer uEntries;
layout(set = 0, binding = 2) uniform usamplerBuffer uStarts;
layout(set = 0, binding = 3, std430) buffer uVisibility { uint64_t visibility[]; };
layout(set = 0, binding = 4, std430) buffer uCounters { uint64_t counters[]; };
#ifndef TILE_SHARED
layout(set = 0, binding = 5, rg32ui) uniform uimageBuffer uVisibilityTexels;  ///< the same, to read: faster on CPUs
#endif

// Edge values are cut here: over a tile they change by less than 2^29, so what is cut keeps its sign.
const int64_t EDGE_LIMIT = 1l << 30;

int cutEdge(ivec2 p, ivec2 q, ivec2 pixel) { return int(clamp(edgeAt(p, q, pixel), -EDGE_LIMIT, EDGE_LIMIT)); }

/// A triangle in the tile: values at the centre of its first pixel, and what they gain per pixel.
struct TileTriangle {
    ivec3 edge, right, down;
    double depth, depthRight, depthDown;
    int low, high;
    uint id;
};

TileTriangle setUp(Record record, ivec2 pixel) {
    TileTriangle t;
    t.edge = ivec3(cutEdge(record.p, record.q, pixel), cutEdge(record.q, record.r, pixel),
                   cutEdge(record.r, record.p, pixel));
    t.right = ivec3(record.p.y - record.q.y, record.q.y - record.r.y, record.r.y - record.p.y);
    t.down = ivec3(record.q.x - record.p.x, record.r.x - record.q.x, record.p.x - record.r.x);
    t.depth = record.a * (double(pixel.x) + 0.5LF) + (record.b * (double(pixel.y) + 0.5LF) + record.c);
    t.depthRight = record.a;
    t.depthDown = record.b;
    t.low = record.low;
    t.high = record.high;
    t.id = record.id;
    return t;
}

double shuffleDouble(double value, uint from) { return packDouble2x32(subgroupShuffle(unpackDouble2x32(value), from)); }

TileTriangle shuffleTriangle(TileTriangle t, uint from) {
    return TileTriangle(subgroupShuffle(t.edge, from), subgroupShuffle(t.right, from), subgroupShuffle(t.down, from),
                        shuffleDouble(t.depth, from), shuffleDouble(t.depthRight, from),
                        shuffleDouble(t.depthDown, from), subgroupShuffle(t.low, from), subgroupShuffle(t.high, from),
                        subgroupShuffle(t.id, from));
}

/// A triangle at the row of an invocation's strip that is drawn now.
struct Strip {
    TileTriangle t;
    ivec3 edge;  // left column
    double left, right;    // depth of the columns at the tile's first row ...
    double zLeft, zRight;  // ... and at this one
};

Strip beginStrip(TileTriangle t, ivec2 at) {
    Strip s;
    s.t = t;
    s.edge = t.edge + t.right * at.x + t.down * at.y;
    s.left = t.depth + t.depthRight * double(at.x);
    s.right = t.depth + t.depthRight * double(at.x + 1);
    double gain = t.depthDown * double(at.y);
    s.zLeft = s.left + gain;
    s.zRight = s.right + gain;
    return s;
}

/// Goes on from row k. Sums begin again every four rows, so that strips of any length round alike.
void nextRow(inout Strip s, int k, ivec2 at) {
    s.edge += s.t.down;
    if ((k & 3) == 3) {
        double gain = s.t.depthDown * double(at.y + k + 1);
        s.zLeft = s.left + gain;
        s.zRight = s.right + gain;
    } else {
        s.zLeft += s.t.depthDown;
        s.zRight += s.t.depthDown;
    }
}

/// Key of a column's pixel, 0 where it is not covered.
uint64_t stripKey(Strip s, int column) {
    ivec3 e = column == 0 ? s.edge : s.edge + s.t.right;
    int z = clamp(floatBitsToInt(float(column == 0 ? s.zLeft : s.zRight)), s.t.low, s.t.high);
    return (e.x | e.y | e.z) >= 0 ? visibilityKey(z, s.t.id) : 0ul;
}

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
    int firstCell = 0;
    [[unroll]] for (int level = 0; level < LEVELS; ++level) {
        ivec2 cells = levelCells(size, level), cell = tile >> (2 * level);
        int at = firstCell + cell.y * cells.x + cell.x;
        uint first = texelFetch(uStarts, at).x;
        shift[level] = first - total;
        total += texelFetch(uStarts, at + 1).x - first;
        ends[level] = total;
        firstCell += cells.x * cells.y;
    }
    uint segment = gl_WorkGroupID.z + FIRST_SEGMENT;
    uint begin = min(segment * SEGMENT, total), end = min(begin + SEGMENT, total);

    int lane = int(gl_LocalInvocationIndex);
    ivec2 origin = tile * TILE_SIZE, at = ivec2(2 * (lane & 7), (lane >> 3) * ROWS);
    uint64_t best[2 * ROWS];
    [[unroll]] for (int k = 0; k < 2 * ROWS; ++k) best[k] = 0ul;
    // A workgroup may be smaller than a subgroup.
    uint chunk = min(gl_SubgroupSize, uint(LANES));
    for (uint first = begin; first < end; first += chunk) {
        uint i = first + gl_SubgroupInvocationID;
        i = min(i, end - 1u);
        uint place = i + shift[0];
        [[unroll]] for (int level = 1; level < LEVELS; ++level) place = i >= ends[level - 1] ? i + shift[level] : place;
        int texel = int(texelFetch(uEntries, int(place)).x) * RECORD_TEXELS;
        TileTriangle mine = setUp(unpackRecord(texelFetch(uRecords, texel), texelFetch(uRecords, texel + 1),
                                               texelFetch(uRecords, texel + 2), texelFetch(uRecords, texel + 3)),
                                  origin);
        uint count = min(chunk, end - first);
        for (uint j = 0u; j < count; ++j) {
            Strip strip = beginStrip(shuffleTriangle(mine, j), at);
            [[unroll]] for (int k = 0; k < ROWS; ++k) {
                [[unroll]] for (int c = 0; c < 2; ++c) best[2 * k + c] = max(best[2 * k + c], stripKey(strip, c));
                nextRow(strip, k, at);
            }
        }
    }
    [[unroll]] for (int k = 0; k < 2 * ROWS; ++k) {
        ivec2 pixel = origin + at + ivec2(k & 1, k >> 1);
        int index = pixel.y * size.x + pixel.x;
        bool seen = pixel.x < size.x && pixel.y < size.y && best[k] != 0ul;
#ifdef TILE_SHARED
        if (seen) atomicMax(visibility[index], best[k]);
#else
        uvec2 old = imageLoad(uVisibilityTexels, seen ? index : 0).xy;
        if (seen && best[k] > packUint2x32(old)) visibility[index] = best[k];
#endif
    }
    if (lane == 0) atomicAdd(counters[COUNT_TILE_VISITED], uint64_t(end - begin));
}

#endif
