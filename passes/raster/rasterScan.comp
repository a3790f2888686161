// Says where the cells' lists lie: in their slots or, of those that have more entries, behind all slots by exclusive prefix
// sums. Lists the tiles that have entries, and finds how many segments the longest of their lists has. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) buffer uState { RasterState state; };
layout(set = 0, binding = 1, std430) buffer uCounts { uint counts[]; };
layout(set = 0, binding = 5, r32ui) uniform uimageBuffer uCountTexels;  ///< the same, to read: faster on CPUs
layout(set = 0, binding = 2, std430) writeonly buffer uStarts { uvec2 starts[]; };  ///< place, length
layout(set = 0, binding = 3, std430) buffer uCounters { uint64_t counters[]; };
layout(set = 0, binding = 4, std430) writeonly buffer uTiles { uint tiles[]; };

layout(constant_id = 126) const uint GROUP_TILES = 1u;  ///< tiles that a workgroup of the tile kernel draws
layout(constant_id = 125) const bool MAY_START_FRESH = false;  ///< this is the image's first batch

const int LANES = 256;
shared uint sums[LANES];
shared uint listed, entries;

uint countOf(int cell) { return imageLoad(uCountTexels, cell).x; }

void main() {
    int lane = int(gl_LocalInvocationIndex);
    if (lane == 0) listed = entries = 0u;
    barrier();
    ivec2 size = imageSizePixels();
    bool idle = state.recordCount == 0u;
    int cells = idle ? 0 : levelStart(size, LEVELS);
    ivec2 grid = levelCells(size, 0);
    int count = idle ? 0 : grid.x * grid.y;
    int firstOf[LEVELS + 1];
    uint firstSlot[LEVELS + 1];
    [[unroll]] for (int level = 0; level <= LEVELS; ++level) {
        firstOf[level] = levelStart(size, level);
        firstSlot[level] = slotStart(size, level);
    }
    uint longest = 0u;
    for (int tile = lane; tile < count; tile += LANES) {
        int ty = tile / grid.x, tx = tile - ty * grid.x;
        uint length_ = 0u;
        [[unroll]] for (int level = 0; level < LEVELS; ++level) {
            int stride = levelCells(size, level).x;
            length_ += countOf(firstOf[level] + (ty >> (2 * level)) * stride + (tx >> (2 * level)));
        }
        longest = max(longest, length_);
        if (length_ > 0u) tiles[atomicAdd(listed, 1u)] = uint(tx) | uint(ty) << 16;
    }
    sums[lane] = longest;
    barrier();
    for (int offset = LANES / 2; offset > 0; offset /= 2) {
        if (lane < offset) sums[lane] = max(sums[lane], sums[lane + offset]);
        barrier();
    }
    longest = sums[0];
    barrier();

    // Places of the lists behind the slots.
    int share = (cells + LANES - 1) / LANES;
    int begin = min(lane * share, cells), end = min(begin + share, cells);
    uint sum = 0u, all = 0u;
    for (int k = begin; k < end; ++k) {
        uint length_ = countOf(k), slots = slotsOf(size, 0);
        [[unroll]] for (int level = 1; level < LEVELS; ++level) slots = k >= firstOf[level] ? slotsOf(size, level) : slots;
        sum += length_ > slots ? length_ : 0u;
        all += length_;
    }
    atomicAdd(entries, all);
    sums[lane] = sum;
    barrier();
    for (int offset = 1; offset < LANES; offset *= 2) {
        uint other = lane >= offset ? sums[lane - offset] : 0u;
        barrier();
        sums[lane] += other;
        barrier();
    }
    uint running = firstSlot[LEVELS] + sums[lane] - sum;
    for (int k = begin; k < end; ++k) {
        uint length_ = countOf(k), slots = slotsOf(size, 0), place = uint(k) * slots;
        [[unroll]] for (int level = 1; level < LEVELS; ++level) {
            bool isThere = k >= firstOf[level];
            slots = isThere ? slotsOf(size, level) : slots;
            place = isThere ? firstSlot[level] + uint(k - firstOf[level]) * slots : place;
        }
        bool fits = length_ <= slots;
        starts[k] = uvec2(fits ? place : running, length_);
        running += fits ? 0u : length_;
        if (fits) counts[k] = 0u;
    }
    if (lane == LANES - 1) {
        state.fillGroups[0] = sums[lane] > 0u ? (state.recordCount + 63u) / 64u : 0u;
        state.fillGroups[1] = state.fillGroups[2] = 1u;
        atomicAdd(counters[COUNT_ENTRIES], uint64_t(entries));
    }
    if (lane == 0) {
        state.tileCount = listed;
        uint groups = (listed + GROUP_TILES - 1u) / GROUP_TILES;
        bool fresh = MAY_START_FRESH && state.smallPixels == 0u;
        state.freshGroups[0] = state.tileGroups[0] = min(groups, TILE_ROW);
        state.freshGroups[1] = state.tileGroups[1] = (groups + TILE_ROW - 1u) / TILE_ROW;
        state.freshGroups[2] = fresh ? 1u : 0u;
        state.tileGroups[2] = fresh ? 0u : 1u;
        state.moreGroups[0] = min(listed, TILE_ROW);
        state.moreGroups[1] = (listed + TILE_ROW - 1u) / TILE_ROW;
        state.moreGroups[2] = max((longest + SEGMENT - 1u) / SEGMENT, 1u) - 1u;
    }
}
