// The tile kernel: 16x16 pixels and one segment of the tile's lists; an invocation owns ROWS rows of COLUMNS pixels, in
// registers, in each of PARTS parts of the tile. The invocations of a subgroup set up a triangle each, keep those that
// none which covers their pixels hides, and then draw all that may touch a part together, handing the set-ups round by
// shuffles. No barriers, and no atomics but for segments after the first and images of odd width (TILE_SHARED): even
// masked out, they cost more than drawing.
#ifndef PASSES_RASTER_TILE_GLSL
#define PASSES_RASTER_TILE_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

#ifdef TILE_SHARED
layout(constant_id = 123) const uint FIRST_SEGMENT = 1u;
#else
const uint FIRST_SEGMENT = 0u;
layout(constant_id = 125) const bool FRESH = false;  ///< nothing has been drawn before: all keys are 0
#endif
#ifndef TILES
#define TILES 1  // of a workgroup; more where its subgroups are no larger than what a tile needs
#endif
#ifndef COLUMNS
#define COLUMNS 2  // of an invocation's pixels
#endif
#if COLUMNS == 4
#define Keys u64vec4
#else
#define Keys u64vec2
#endif
#ifndef PARTS
#define PARTS 1  // of a tile, one below the other: an invocation has ROWS rows in each
#endif
const int LANES = 256 / (ROWS * COLUMNS * PARTS);  // of a tile
const int ACROSS = 16 / COLUMNS, ACROSS_BITS = COLUMNS == 4 ? 2 : 3;  // of them side by side
layout(local_size_x = 256 / (ROWS * COLUMNS * PARTS) * TILES) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uRecords;
layout(set = 0, binding = 1) uniform usamplerBuffer uEntries;
layout(set = 0, binding = 2) uniform usamplerBuffer uStarts;
#ifdef TILE_SHARED
layout(set = 0, binding = 3, std430) buffer uVisibility { uint64_t visibility[]; };
#else
// Neighbouring pixels at a time: the image's width is a multiple of COLUMNS.
layout(set = 0, binding = 3, std430) buffer uVisibility { Keys visibility[]; };
layout(set = 0, binding = 5, rgba32ui) uniform uimageBuffer uVisibilityTexels;  ///< the same, to read: faster on CPUs
#endif
layout(set = 0, binding = 4, std430) buffer uCounters { uint64_t counters[]; };
layout(set = 0, binding = 6) uniform usamplerBuffer uTiles;  ///< state.tileCount tiles that have entries
layout(set = 0, binding = 7) uniform usamplerBuffer uState;  ///< RasterState

#ifdef PEEL
layout(set = 0, binding = 9) uniform usamplerBuffer uLimit;  ///< what is not behind these keys is left out
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

/// Whether some pixel of a rectangle (first pixel from the tile's, and the last from that) is inside all three edges
/// taken one by one.
bool mayTouch(TileTriangle t, ivec2 first, ivec2 extent) {
    ivec3 most = t.edge + t.right * first.x + t.down * first.y + max(t.right, ivec3(0)) * extent.x +
                 max(t.down, ivec3(0)) * extent.y;
    return (most.x | most.y | most.z) >= 0;
}

/// Whether all pixels of such a rectangle are inside all three edges.
bool covers(TileTriangle t, ivec2 first, ivec2 extent) {
    ivec3 least = t.edge + t.right * first.x + t.down * first.y + min(t.right, ivec3(0)) * extent.x +
                  min(t.down, ivec3(0)) * extent.y;
    return (least.x | least.y | least.z) >= 0;
}

int mostOfSubgroup(int value) {
#if PARTS == 2
    // Subgroups are narrow: three shuffles cost less than the driver's loop over invocations.
    int other = subgroupShuffleXor(value, 1u);
    value = gl_SubgroupSize > 1u ? max(value, other) : value;
    other = subgroupShuffleXor(value, 2u);
    value = gl_SubgroupSize > 2u ? max(value, other) : value;
    other = subgroupShuffleXor(value, 4u);
    return gl_SubgroupSize > 4u ? max(value, other) : value;
#else
    return subgroupMax(value);
#endif
}

/// Depth codes between which a triangle stays in such a rectangle.
struct DepthRange {
    int farthest, nearest;
};

DepthRange depthRange(TileTriangle t, ivec2 first, ivec2 extent) {
    double start = t.depth + t.depthRight * double(first.x) + t.depthDown * double(first.y);
    double across = t.depthRight * double(extent.x), along = t.depthDown * double(extent.y);
    // A dozen sums of a pixel's depth round by 2^-53 of their largest term each.
    double slack = 1e-14LF * (abs(t.depth) + 16.0LF * (abs(t.depthRight) + abs(t.depthDown)));
    double least = start + lesser(across, 0.0LF) + lesser(along, 0.0LF) - slack;
    double most = start + greater(across, 0.0LF) + greater(along, 0.0LF) + slack;
    // A plane seen edge-on may have no finite slopes.
    bool finite = slack <= 1e300LF;
    return DepthRange(finite ? clamp(depthCode(least), t.low, t.high) : t.low,
                      finite ? clamp(depthCode(most), t.low, t.high) : t.high);
}

/// Key of a pixel; where the triangle does not cover it, one of depth 0: behind everything, and at the end a miss.
uint64_t coveredKey(TileTriangle t, ivec3 edge, double z) {
    int depth = clamp(depthCode(z), t.low, t.high) & ~((edge.x | edge.y | edge.z) >> 31);
    return visibilityKey(depth, t.id);
}

/// Writes neighbouring pixels' keys where they are nearer than what is there.
void store(ivec2 pixel, ivec2 size, Keys best) {
    int index = pixel.y * size.x + pixel.x;
    bool hit[COLUMNS], any_ = false;
    [[unroll]] for (int c = 0; c < COLUMNS; ++c) {
        hit[c] = pixel.y < size.y && pixel.x + c < size.x && unpackUint2x32(best[c]).y != 0u;
        any_ = any_ || hit[c];
    }
#ifdef TILE_SHARED
    [[unroll]] for (int c = 0; c < COLUMNS; ++c)
        if (hit[c]) atomicMax(visibility[index + c], best[c]);
#else
    bool inside = pixel.y < size.y && pixel.x < size.x;
    Keys keys;
    [[unroll]] for (int c = 0; c < COLUMNS; c += 2) {
        uvec4 seen = uvec4(0u);
        if (!FRESH) seen = imageLoad(uVisibilityTexels, inside ? (index + c) / 2 : 0);
        u64vec2 old = u64vec2(packUint2x32(seen.xy), packUint2x32(seen.zw));
        keys[c] = hit[c] ? max(best[c], old.x) : old.x;
        keys[c + 1] = hit[c + 1] ? max(best[c + 1], old.y) : old.y;
    }
    if (any_) visibility[index / COLUMNS] = keys;
#endif
}

#ifdef PEEL
/// The limits of neighbouring pixels; of ones in the image those beyond it.
Keys keysAt(ivec2 pixel, ivec2 size) {
    Keys keys;
    [[unroll]] for (int c = 0; c < COLUMNS; ++c) {
        ivec2 inside = min(pixel + ivec2(c, 0), size - 1);
        keys[c] = packUint2x32(texelFetch(uLimit, inside.y * size.x + inside.x).xy);
    }
    return keys;
}
#define LIMIT(keys) , keys
#else
#define LIMIT(keys)
#endif

/// Draws the triangles that invocations keep over the pixels from `at` on.
void drawKept(TileTriangle mine, bool kept, ivec2 at, inout Keys best[ROWS] LIMIT(Keys limit[ROWS])) {
    uint pending = subgroupBallot(kept).x;
    for (; pending != 0u; pending &= pending - 1u) {
        TileTriangle t = shuffleTriangle(mine, uint(findLSB(pending)));
        ivec3 edge = t.edge + t.right * at.x + t.down * at.y;
        double start[COLUMNS], z[COLUMNS];
        [[unroll]] for (int c = 0; c < COLUMNS; ++c) {
            start[c] = t.depth + t.depthRight * double(at.x + c);
            z[c] = start[c] + t.depthDown * double(at.y);
        }
        [[unroll]] for (int k = 0; k < ROWS; ++k) {
            ivec3 across = edge;
            [[unroll]] for (int c = 0; c < COLUMNS; ++c) {
                uint64_t key = coveredKey(t, across, z[c]);
#ifdef PEEL
                key = key < limit[k][c] ? key : 0ul;
#endif
                best[k][c] = max(best[k][c], key);
                across += t.right;
                z[c] += t.depthDown;
            }
            edge += t.down;
        }
    }
}

void main() {
    ivec2 size = imageSizePixels();
    // Workgroups from both ends of the list alternate: drivers that cut the grid in contiguous parts, one for a
    // thread, then share the work evenly.
    int count = int(texelFetch(uState, STATE_TILE_COUNT).x), half_ = (count + 1) / 2;
    // Invocations in the order of the subgroups, so that what a subgroup owns is a rectangle.
    int lane = int(gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID);
    int firstLane = int(gl_SubgroupID * gl_SubgroupSize);
    int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    group = group * TILES + firstLane / LANES;
    lane -= firstLane / LANES * LANES;
    firstLane -= firstLane / LANES * LANES;
    if (group >= count) return;
    uint packed = texelFetch(uTiles, group < half_ ? 2 * group : 2 * (group - half_) + 1).x;
    ivec2 tile = ivec2(int(packed & 0xffffu), int(packed >> 16));

    // The lists of the tile's cells, end to end: entry i of all lies at i + shift[level].
    uint ends[LEVELS];
    uint shift[LEVELS];
    uint total = 0u;
    int firstCell = 0;
    [[unroll]] for (int level = 0; level < LEVELS; ++level) {
        ivec2 cells = levelCells(size, level), cell = tile >> (2 * level);
        uvec2 list = texelFetch(uStarts, firstCell + cell.y * cells.x + cell.x).xy;
        shift[level] = list.x - total;
        total += list.y;
        ends[level] = total;
        firstCell += cells.x * cells.y;
    }
    uint segment = gl_WorkGroupID.z + FIRST_SEGMENT;
    uint begin = min(segment * SEGMENT, total), end = min(begin + SEGMENT, total);

    ivec2 origin = tile * TILE_SIZE, at = ivec2(COLUMNS * (lane & (ACROSS - 1)), (lane >> ACROSS_BITS) * ROWS);
    ivec2 corner = ivec2(0, (firstLane >> ACROSS_BITS) * ROWS);
    ivec2 partExtent = ivec2(15, max(int(gl_SubgroupSize) >> ACROSS_BITS, 1) * ROWS - 1);
    ivec2 extent = partExtent + ivec2(0, (PARTS - 1) * (TILE_SIZE / PARTS));
    const ivec2 lower = ivec2(0, TILE_SIZE / PARTS);
    Keys best0[ROWS], best1[ROWS];
    [[unroll]] for (int k = 0; k < ROWS; ++k) best0[k] = best1[k] = Keys(0ul);
#ifdef PEEL
    Keys limit0[ROWS], limit1[ROWS];
    [[unroll]] for (int k = 0; k < ROWS; ++k) {
        limit0[k] = keysAt(origin + at + ivec2(0, k), size);
        limit1[k] = keysAt(origin + at + lower + ivec2(0, k), size);
    }
#endif
    // A workgroup may be smaller than a subgroup.
    uint chunk = min(gl_SubgroupSize, uint(LANES));
    int covered = 0;  // some triangle covers the rectangle, and nowhere with a lesser depth code
    for (uint first = begin; first < end; first += chunk) {
        uint i = first + gl_SubgroupInvocationID;
        bool valid = i < end;
        i = min(i, end - 1u);
        uint place = i + shift[0];
        [[unroll]] for (int level = 1; level < LEVELS; ++level) place = i >= ends[level - 1] ? i + shift[level] : place;
        int texel = int(texelFetch(uEntries, int(place)).x) * RECORD_TEXELS;
        TileTriangle mine = setUp(unpackRecord(texelFetch(uRecords, texel), texelFetch(uRecords, texel + 1),
                                               texelFetch(uRecords, texel + 2), texelFetch(uRecords, texel + 3)),
                                  origin);
#ifndef PEEL
        DepthRange range = depthRange(mine, corner, extent);
        bool whole = valid && covers(mine, corner, extent);
        covered = max(covered, mostOfSubgroup(whole ? range.farthest : 0));
        valid = valid && range.nearest >= covered;
#endif
        drawKept(mine, valid && mayTouch(mine, corner, partExtent), at, best0 LIMIT(limit0));
#if PARTS == 2
        drawKept(mine, valid && mayTouch(mine, corner + lower, partExtent), at + lower, best1 LIMIT(limit1));
#endif
    }
    [[unroll]] for (int k = 0; k < ROWS; ++k) store(origin + at + ivec2(0, k), size, best0[k]);
#if PARTS == 2
    [[unroll]] for (int k = 0; k < ROWS; ++k) store(origin + at + lower + ivec2(0, k), size, best1[k]);
#endif
    if (lane == 0) atomicAdd(counters[COUNT_TILE_VISITED], uint64_t(end - begin));
}

#endif
