// Records of triangles for the tile kernel, and the walk over the cells that a record touches. Every cell has slots for
// its first entries. The lists of cells that have more lie behind all slots: their entries are counted first and written
// by a second walk, so that a list can neither overflow nor lose a triangle.
#ifndef SHADERS_RASTER_BIN_GLSL
#define SHADERS_RASTER_BIN_GLSL

#include "shaders/raster/triangle.glsl"
#include "shaders/raster/state.glsl"

/// A triangle of positive area whose corners are snapped.
struct Record {
    ivec2 p, q, r;
    uint id;
    int low, high;  // bits of the depths it may have
    double a, b, c;
    bool used;  // false for a part of a clipped triangle that there is not
};

// In memory a record is 4 texels: (p, q), (r, id, low), (a, b), (c, high, used).
const int RECORD_TEXELS = 4;

void packRecord(Record record, out uvec4 t0, out uvec4 t1, out uvec4 t2, out uvec4 t3) {
    t0 = uvec4(record.p, record.q);
    t1 = uvec4(record.r, record.id, record.low);
    t2 = uvec4(unpackDouble2x32(record.a), unpackDouble2x32(record.b));
    t3 = uvec4(unpackDouble2x32(record.c), record.high, record.used ? 1u : 0u);
}

Record unpackRecord(uvec4 t0, uvec4 t1, uvec4 t2, uvec4 t3) {
    Record record;
    record.p = ivec2(t0.xy);
    record.q = ivec2(t0.zw);
    record.r = ivec2(t1.xy);
    record.id = t1.z;
    record.low = int(t1.w);
    record.a = packDouble2x32(t2.xy);
    record.b = packDouble2x32(t2.zw);
    record.c = packDouble2x32(t3.xy);
    record.high = int(t3.z);
    record.used = t3.w != 0u;
    return record;
}

/// A record of three snapped corners in either order; unused where they have no area or cover no pixel's centre.
Record makeRecord(ivec2 p, ivec2 q, ivec2 r, DepthPlane plane, uint id, ivec2 size) {
    int64_t area = signedArea(p, q, r);
    ivec4 bounds = pixelBounds(p, q, r, size);
    Record record;
    record.p = p;
    record.q = area < 0 ? r : q;
    record.r = area < 0 ? q : r;
    record.id = id;
    record.low = depthCode(double(plane.low));
    record.high = depthCode(double(plane.high));
    record.a = plane.a;
    record.b = plane.b;
    record.c = plane.c;
    record.used = area != 0 && bounds.x <= bounds.z && bounds.y <= bounds.w;
    return record;
}

/// Cells of a level in x and y.
ivec2 levelCells(ivec2 size, int level) {
    int shift = cellShift(level);
    return (size + ((1 << shift) - 1)) >> shift;
}

/// Number of cells of all levels before this one; of all cells for LEVELS.
int levelStart(ivec2 size, int level) {
    int start = 0;
    for (int k = 0; k < LEVELS; ++k) {
        ivec2 cells = levelCells(size, k);
        start += k < level ? cells.x * cells.y : 0;
    }
    return start;
}

/// Slots of a cell: as many for a pixel at the next levels, up to a limit; none in images so large that they would be
/// many. As cellSlots() in raster_passes.cpp.
uint slotsOf(ivec2 size, int level) {
    ivec2 tiles = levelCells(size, 0);
    return tiles.x * tiles.y <= SLOT_TILES ? min(TILE_SLOTS << (4 * level), MOST_SLOTS) : 0u;
}

/// Number of slots of all levels before this one; of all cells for LEVELS.
uint slotStart(ivec2 size, int level) {
    uint start = 0u;
    for (int k = 0; k < LEVELS; ++k) {
        ivec2 cells = levelCells(size, k);
        start += k < level ? uint(cells.x * cells.y) * slotsOf(size, k) : 0u;
    }
    return start;
}

/// The walk over the cells that a record may touch, at the finest level where its bounds touch no more than
/// `maxCells` of them. `cell` is valid while `left` is positive; advance() goes on.
struct CellWalk {
    ivec4 range;
    ivec2 at;
    int left;
    int shift, first, stride;
    uint slots, firstSlot;
    int64_t base[3];  // edges at pixel (0, 0), plus what the farthest inside pixel of a cell adds
    ivec2 slope[3];
};

CellWalk beginWalk(Record record, ivec2 size, uint maxCells) {
    ivec4 bounds = pixelBounds(record.p, record.q, record.r, size);
    CellWalk walk;
    int level = LEVELS - 1;
    for (int k = LEVELS - 2; k >= 0; --k) {
        ivec4 range = bounds >> cellShift(k);
        ivec2 cells = range.zw - range.xy + 1;
        level = uint(cells.x) * uint(cells.y) <= maxCells ? k : level;
    }
    walk.shift = cellShift(level);
    walk.first = levelStart(size, level);
    walk.stride = levelCells(size, level).x;
    walk.slots = slotsOf(size, level);
    walk.firstSlot = slotStart(size, level);
    walk.range = bounds >> walk.shift;
    ivec2 cells = walk.range.zw - walk.range.xy + 1;
    walk.left = record.used ? cells.x * cells.y : 0;
    walk.at = walk.range.xy;
    ivec2 corner[4] = ivec2[4](record.p, record.q, record.r, record.p);
    [[unroll]] for (int k = 0; k < 3; ++k) {
        ivec2 d = corner[k + 1] - corner[k];
        walk.slope[k] = ivec2(-d.y, d.x);
        int gain = max(walk.slope[k].x, 0) + max(walk.slope[k].y, 0);
        walk.base[k] = edgeAt(corner[k], corner[k + 1], ivec2(0)) + int64_t(gain) * int64_t((1 << walk.shift) - 1);
    }
    return walk;
}

/// Whether some pixel's centre of the current cell is inside all three edges taken one by one.
bool touches(CellWalk walk) {
    ivec2 pixel = walk.at << walk.shift;
    bool inside = true;
    [[unroll]] for (int k = 0; k < 3; ++k) {
        int64_t e = walk.base[k] + int64_t(walk.slope[k].x) * int64_t(pixel.x) +
                    int64_t(walk.slope[k].y) * int64_t(pixel.y);
        inside = inside && e >= 0;
    }
    return inside;
}

int cellIndex(CellWalk walk) { return walk.first + walk.at.y * walk.stride + walk.at.x; }

/// Where the entries of the current cell begin that have slots.
uint slotPlace(CellWalk walk) { return walk.firstSlot + uint(walk.at.y * walk.stride + walk.at.x) * walk.slots; }

void advance(inout CellWalk walk) {
    --walk.left;
    bool wrap = walk.at.x == walk.range.z;
    walk.at = wrap ? ivec2(walk.range.x, walk.at.y + 1) : walk.at + ivec2(1, 0);
}

#endif
