// Turns the cells' counts into the places of their lists (exclusive prefix sums, the total last), and finds how many
// segments the longest of the tiles' lists has. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/bin.glsl"

layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) buffer uState { RasterState state; };
layout(set = 0, binding = 1, std430) readonly buffer uCounts { uint counts[]; };
layout(set = 0, binding = 2, std430) writeonly buffer uStarts { uint starts[]; };
layout(set = 0, binding = 3, std430) buffer uCounters { uint64_t counters[]; };

const int LANES = 256;
shared uint sums[LANES];

void main() {
    int lane = int(gl_LocalInvocationIndex);
    ivec2 size = imageSizePixels();
    int cells = levelStart(size, LEVELS);
    int share = (cells + LANES - 1) / LANES;
    int begin = min(lane * share, cells), end = min(begin + share, cells);

    uint sum = 0u;
    for (int k = begin; k < end; ++k) sum += counts[k];
    sums[lane] = sum;
    barrier();
    for (int offset = 1; offset < LANES; offset *= 2) {
        uint other = lane >= offset ? sums[lane - offset] : 0u;
        barrier();
        sums[lane] += other;
        barrier();
    }
    uint running = sums[lane] - sum;
    for (int k = begin; k < end; ++k) {
        starts[k] = running;
        running += counts[k];
    }
    if (lane == LANES - 1) {
        starts[cells] = sums[lane];
        atomicAdd(counters[COUNT_ENTRIES], uint64_t(sums[lane]));
    }
    barrier();

    ivec2 tiles = levelCells(size, 0);
    int count = tiles.x * tiles.y;
    int firstOf[LEVELS];
    [[unroll]] for (int level = 0; level < LEVELS; ++level) firstOf[level] = levelStart(size, level);
    uint longest = 0u;
    for (int tile = lane; tile < count; tile += LANES) {
        int ty = tile / tiles.x, tx = tile - ty * tiles.x;
        uint entries = 0u;
        [[unroll]] for (int level = 0; level < LEVELS; ++level) {
            int stride = levelCells(size, level).x;
            entries += counts[firstOf[level] + (ty >> (2 * level)) * stride + (tx >> (2 * level))];
        }
        longest = max(longest, entries);
    }
    sums[lane] = longest;
    barrier();
    for (int offset = LANES / 2; offset > 0; offset /= 2) {
        if (lane < offset) sums[lane] = max(sums[lane], sums[lane + offset]);
        barrier();
    }
    if (lane == 0) {
        state.tileGroups[0] = uint(tiles.x);
        state.tileGroups[1] = uint(tiles.y);
        state.tileGroups[2] = 1u;
        state.moreGroups[0] = uint(tiles.x);
        state.moreGroups[1] = uint(tiles.y);
        state.moreGroups[2] = max((sums[0] + SEGMENT - 1u) / SEGMENT, 1u) - 1u;
    }
}
