// The tile kernel: a workgroup owns 16x16 pixels and one segment of the tile's lists; an invocation owns ROWS rows of
// two columns, in registers, and eight neighbours a strip. The invocations of a subgroup set up a triangle each, keep
// those that may touch the subgroup's strips and that none which covers them hides, and then draw these all together,
// handing the set-ups round by shuffles. No barriers, and no atomics but for segments after the first and images of odd
// width (TILE_SHARED): even masked out, they cost more than drawing.
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
const int LANES = 128 / ROWS;  // of a tile: 8 pairs of columns, 16 / ROWS strips
layout(local_size_x = 128 / ROWS * TILES) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uRecords;
layout(set = 0, binding = 1) uniform usamplerBuffer uEntries;
layout(set = 0, binding = 2) uniform usamplerBuffer uStarts;
#ifdef TILE_SHARED
layout(set = 0, binding = 3, std430) buffer uVisibility { uint64_t visibility[]; };
#else
// Two neighbouring pixels at a time: the image's width is even.
layout(set = 0, binding = 3, std430) buffer uVisibility { u64vec2 visibility[]; };
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
#if ROWS == 8
    // Subgroups are narrow: a few shuffles cost less than the driver's loop over invocations.
    [[unroll]] for (uint step = 1u; step < 16u; step *= 2u) {
        int other = subgroupShuffleXor(value, step);
        value = step < gl_SubgroupSize ? max(value, other) : value;
    }
    return value;
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

/// Writes two neighbouring pixels' keys where they are nearer than what is there.
void store(ivec2 pixel, ivec2 size, u64vec2 best) {
    bool insideY = pixel.y < size.y, inside0 = insideY && pixel.x < size.x, inside1 = insideY && pixel.x + 1 < size.x;
    int index = pixel.y * size.x + pixel.x;
    bool hit0 = inside0 && unpackUint2x32(best.x).y != 0u, hit1 = inside1 && unpackUint2x32(best.y).y != 0u;
#ifdef TILE_SHARED
    if (hit0) atomicMax(visibility[index], best.x);
    if (hit1) atomicMax(visibility[index + 1], best.y);
#else
    uvec4 seen = uvec4(0u);
    if (!FRESH) seen = imageLoad(uVisibilityTexels, inside0 ? index >> 1 : 0);
    u64vec2 old = u64vec2(packUint2x32(seen.xy), packUint2x32(seen.zw));
    if (hit0 || hit1) visibility[index >> 1] = u64vec2(hit0 ? max(best.x, old.x) : old.x, hit1 ? max(best.y, old.y) : old.y);
#endif
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

    ivec2 origin = tile * TILE_SIZE, at = ivec2(2 * (lane & 7), (lane >> 3) * ROWS);
    ivec2 corner = ivec2(0, (firstLane >> 3) * ROWS);
    ivec2 extent = ivec2(15, max(int(gl_SubgroupSize) >> 3, 1) * ROWS - 1);
    u64vec2 best[ROWS];
    [[unroll]] for (int k = 0; k < ROWS; ++k) best[k] = u64vec2(0ul);
#ifdef PEEL
    u64vec2 limit[ROWS];
    [[unroll]] for (int k = 0; k < ROWS; ++k) {
        ivec2 pixel = min(origin + at + ivec2(0, k), size - 1);
        int index = pixel.y * size.x + pixel.x, next = pixel.y * size.x + min(pixel.x + 1, size.x - 1);
        limit[k] = u64vec2(packUint2x32(texelFetch(uLimit, index).xy), packUint2x32(texelFetch(uLimit, next).xy));
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
        bool kept = valid && mayTouch(mine, corner, extent);
#ifndef PEEL
        DepthRange range = depthRange(mine, corner, extent);
        covered = max(covered, mostOfSubgroup(kept && covers(mine, corner, extent) ? range.farthest : 0));
        kept = kept && range.nearest >= covered;
#endif
        uint pending = subgroupBallot(kept).x;
        for (; pending != 0u; pending &= pending - 1u) {
            TileTriangle t = shuffleTriangle(mine, uint(findLSB(pending)));
            ivec3 edge = t.edge + t.right * at.x + t.down * at.y;
            double left = t.depth + t.depthRight * double(at.x), right = t.depth + t.depthRight * double(at.x + 1);
            double gain = t.depthDown * double(at.y), zLeft = left + gain, zRight = right + gain;
            [[unroll]] for (int k = 0; k < ROWS; ++k) {
                u64vec2 key = u64vec2(coveredKey(t, edge, zLeft), coveredKey(t, edge + t.right, zRight));
#ifdef PEEL
                key = u64vec2(key.x < limit[k].x ? key.x : 0ul, key.y < limit[k].y ? key.y : 0ul);
#endif
                best[k] = u64vec2(max(best[k].x, key.x), max(best[k].y, key.y));
                edge += t.down;
                // Sums begin again every four rows, so that they round little.
                if ((k & 3) == 3) {
                    gain = t.depthDown * double(at.y + k + 1);
                    zLeft = left + gain;
                    zRight = right + gain;
                } else {
                    zLeft += t.depthDown;
                    zRight += t.depthDown;
                }
            }
        }
    }
    [[unroll]] for (int k = 0; k < ROWS; ++k) store(origin + at + ivec2(0, k), size, best[k]);
    if (lane == 0) atomicAdd(counters[COUNT_TILE_VISITED], uint64_t(end - begin));
}

#endif
