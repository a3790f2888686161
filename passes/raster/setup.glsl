// Set-up: triangles are transformed and culled; small ones are drawn at once by 64-bit atomics, or dropped where they cover
// no pixel, others are listed for the tiles or for clipping.
#ifndef PASSES_RASTER_SETUP_GLSL
#define PASSES_RASTER_SETUP_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/scene/triangles.glsl"
#include "shaders/raster/triangle.glsl"
#include "shaders/raster/state.glsl"

/// Few where subgroups are narrow: what a subgroup does once, loading the view above all, then serves more triangles.
layout(constant_id = 127) const uint LANES = 64u;
layout(constant_id = 121) const bool DIRECT = true;  ///< else small triangles are left to the tiles too
layout(local_size_x = 64, local_size_x_id = 127) in;
layout(set = 0, binding = 1, std430) buffer uVisibility { uint64_t visibility[]; };
layout(set = 0, binding = 2, std430) buffer uState { RasterState state; };
layout(set = 0, binding = 3, std430) buffer uCounters { uint64_t counters[]; };
layout(set = 0, binding = 4, std430) writeonly buffer uLarge { uint large[]; };
layout(set = 0, binding = 5, std430) writeonly buffer uClipped { uint clipped[]; };

#ifdef CLUSTERS
#include "shaders/raster/cluster.glsl"
layout(set = 0, binding = 8) uniform usamplerBuffer uClusterList;   ///< as ClusterState says
layout(set = 0, binding = 9) uniform usamplerBuffer uClusterState;  ///< ClusterState
layout(constant_id = 126) const int PHASE = 0;                      ///< 0: before culling by depth, 1: after it
#endif
#ifdef PEEL
layout(set = 0, binding = 7) uniform usamplerBuffer uLimit;  ///< what is not behind these keys is left out
#endif

// A small triangle covers at most SMALL x SMALL pixels' centres; SMALL_EXTENT keeps its edge functions in 32 bits.
const int SMALL = 8;
const int SMALL_EXTENT = 8192;
const uint GROUP_TRIANGLES = 512u, PER_THREAD = GROUP_TRIANGLES / LANES;

shared uint packed[4];

/// A snapped coordinate of the guard band's edge; of what lies at or beyond it clipping decides.
const int SNAP_LIMIT = int(GUARD_BAND) * SUBPIXELS;

/// As snap() does before the guard band's edge, and no nearer than that beyond it. Anything behind the eye.
ivec2 snapWithin(HomogeneousVertex v) {
    const double limit = double(SNAP_LIMIT);
    precise double x = floor(v.x / v.w * 256.0LF + 0.5LF);
    precise double y = floor(v.y / v.w * 256.0LF + 0.5LF);
    return ivec2(int(greater(lesser(x, limit), -limit)), int(greater(lesser(y, limit), -limit)));
}

/// The triangle that an invocation sets up in turn k, and whether there is one. A subgroup's turns lie one after the
/// other in memory.
uint ownTriangle(uint k, uint lane, out bool isThere) {
    uint wide = min(gl_SubgroupSize, LANES), inside = lane % wide;
    uint place = (lane - inside) * PER_THREAD + k * wide + inside;
#ifdef CLUSTERS
    uint turn = push.first + gl_WorkGroupID.x * (GROUP_TRIANGLES / CLUSTER_TRIANGLES) + place / CLUSTER_TRIANGLES;
    isThere = turn < texelFetch(uClusterState, CLUSTER_COUNT + PHASE).x;
    uint all = texelFetch(uClusterState, CLUSTER_ALL).x, front = texelFetch(uClusterState, CLUSTER_SEEN).x;
    uint at = PHASE == 1 ? all + turn : turn < front ? turn : all - 1u - (turn - front);
    uint t = texelFetch(uClusterList, isThere ? int(at) : 0).x * CLUSTER_TRIANGLES + place % CLUSTER_TRIANGLES;
    isThere = isThere && t < push.count;
    return isThere ? t : 0u;
#else
    uint index = gl_WorkGroupID.x * GROUP_TRIANGLES + place;
    isThere = index < push.count;
    return push.first + min(index, push.count - 1u);
#endif
}

/// What an invocation has come across, and its triangles for the tiles and for clipping: bit k of turn k.
struct Work {
    uint outside, back, empty, small, visited, covered;
    uint tiledBits, clippedBits;
};

/// A small triangle's pixels that are still to be drawn.
struct Pending {
    uvec2 mask;     // bit 8 y + x: the pixel at (x, y) from the first
    uint first;     // x | y << 16
    uvec2 a, b, c;  // doubles: of the depth's plane
    int low, high;
    uint id;
};

/// Sets up the triangle of turn k: its pixels where it is small, else none.
Pending setUp(uint k, uint lane, ivec2 size, inout Work work) {
    bool valid;
    uint t = ownTriangle(k, lane, valid);
    Triangle source = fetchTriangle(int(t));
    HomogeneousVertex a = projectVertex(source.v0), b = projectVertex(source.v1), c = projectVertex(source.v2);

    // What lies behind the near plane in part is left to clipping; of the rest, snapped corners tell what is outside.
    double least = lesser(a.near, lesser(b.near, c.near)), most = greater(a.near, greater(b.near, c.near));
    bool before = least >= 0.0LF;
    ivec2 p = snapWithin(a), q = snapWithin(b), r = snapWithin(c);
    ivec2 lowest = min(p, min(q, r)), highest = max(p, max(q, r));
    bool beside = min(highest.x, highest.y) < 0 || lowest.x > size.x * SUBPIXELS || lowest.y > size.y * SUBPIXELS;
    bool outside = most < 0.0LF || (before && beside);
    work.outside += uint(valid && outside);
    valid = valid && !outside;

    DepthPlane plane = depthPlane(a, b, c);
    bool back = (push.flags & RASTER_CULL_BACK) != 0u && plane.facing < 0.0LF;
    work.back += uint(valid && back);
    valid = valid && !back;

    bool far = min(lowest.x, lowest.y) <= -SNAP_LIMIT || max(highest.x, highest.y) >= SNAP_LIMIT;
    bool clip = valid && (!before || far);
    work.clippedBits |= uint(clip) << k;
    valid = valid && !clip;

    int64_t area = signedArea(p, q, r);
    ivec4 bounds = pixelBounds(p, q, r, size);
    ivec2 cells = bounds.zw - bounds.xy + 1;
    bool none = area == 0 || min(cells.x, cells.y) <= 0;
    work.empty += uint(valid && none);
    valid = valid && !none;

    ivec2 extent = highest - lowest;
    bool small = max(cells.x, cells.y) <= SMALL && max(extent.x, extent.y) <= SMALL_EXTENT;
    bool tiled = valid && !small;
    work.tiledBits |= uint(tiled) << k;

    valid = valid && small;
    if (area < 0) {
        ivec2 swap = q;
        q = r;
        r = swap;
    }
    ivec3 e = ivec3(edgeAtSmall(p, q, bounds.xy), edgeAtSmall(q, r, bounds.xy), edgeAtSmall(r, p, bounds.xy));
    ivec3 right = ivec3(p.y - q.y, q.y - r.y, r.y - p.y);
    ivec3 down = ivec3(q.x - p.x, r.x - q.x, p.x - r.x);
    int low = depthCode(double(plane.low)), high = depthCode(double(plane.high));
    uint id = uint(source.g);
    work.visited += valid ? uint(cells.x * cells.y) : 0u;
    // First which pixels are covered, four by two at a time, then those alone: an atomic's code costs far more than
    // a test, even where it is masked out. Bit 8 y + x.
    int width_ = valid ? cells.x : 0, rows = valid ? cells.y : 0;
    uint inRow = (1u << width_) - 1u;
    uint64_t coverage = 0ul;
    for (int y = 0; y < rows; y += 2) {
        uint upper = 0u, lower = 0u;  // bit x: outside
        ivec3 edge = e, below = e + down;
        for (int first = 0; first < width_; first += 4) {
            uint upper4 = 0u, lower4 = 0u;
            [[unroll]] for (int x = 0; x < 4; ++x) {
                upper4 |= uint(edge.x | edge.y | edge.z) >> (31 - x) & (1u << x);
                lower4 |= uint(below.x | below.y | below.z) >> (31 - x) & (1u << x);
                edge += right;
                below += right;
            }
            upper |= upper4 << first;
            lower |= lower4 << first;
        }
        uint two = (~upper & inRow) | (y + 1 < rows ? (~lower & inRow) << 8 : 0u);
        coverage |= uint64_t(two) << (8 * y);
        e += 2 * down;
    }
    uvec2 mask = unpackUint2x32(coverage);
    uint pixels = uint(bitCount(mask.x) + bitCount(mask.y));
    if (!DIRECT) {
        bool left = pixels != 0u;
        work.tiledBits |= uint(left) << k;
        valid = valid && !left;
        mask = uvec2(0u);
        pixels = 0u;
    }
    work.small += uint(valid);
    work.covered += pixels;
    return Pending(mask, uint(max(bounds.x, 0)) | uint(max(bounds.y, 0)) << 16, unpackDouble2x32(plane.a),
                   unpackDouble2x32(plane.b), unpackDouble2x32(plane.c), low, high, id);
}

bool isDrawn(Pending p) { return (p.mask.x | p.mask.y) == 0u; }

/// Draws one of the pixels, where there are any.
void drawPixel(inout Pending p, ivec2 size) {
    bool isThere = !isDrawn(p), upper = p.mask.x == 0u;
    uint word = upper ? p.mask.y : p.mask.x;
    int bit = findLSB(word), x = int(p.first & 0xffffu) + (bit & 7), y = int(p.first >> 16) + (bit >> 3) + (upper ? 4 : 0);
    word &= word - 1u;
    p.mask = upper ? uvec2(0u, word) : uvec2(word, p.mask.y);
    double rowTerm = packDouble2x32(p.b) * (double(y) + 0.5LF) + packDouble2x32(p.c);
    int depth = depthBits(packDouble2x32(p.a), rowTerm, double(x) + 0.5LF, p.low, p.high);
    uint64_t key = visibilityKey(depth, p.id);
    // Without a look at what is there: that takes a fifth longer on CPUs, hidden triangles or not.
    int index = y * size.x + x;
#ifdef PEEL
    if (key >= packUint2x32(texelFetch(uLimit, isThere ? index : 0).xy)) key = 0ul;
#endif
    if (isThere) atomicMax(visibility[index], key);
}

#ifdef GATHER
#include "passes/raster/gather.glsl"
#endif

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < 4u) packed[lane] = 0u;
    barrier();

    ivec2 size = imageSizePixels();
    Work work = Work(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
#ifdef GATHER
    drawTogether(lane, size, work);
#else
    [[dont_unroll]] for (uint k = 0u; k < PER_THREAD; ++k) {
        Pending own = setUp(k, lane, size, work);
        if (DIRECT) {
            for (; !isDrawn(own);) drawPixel(own, size);
        }
    }
#endif

    // Lists last, and once: an atomic's code and a store's cost as much where every invocation is masked out.
    bool isThere;
    uint tiledBits = work.tiledBits, clippedBits = work.clippedBits, largeCount = bitCount(tiledBits);
    uint at = 0u;
    if (tiledBits != 0u) at = atomicAdd(state.largeCount, largeCount);
    for (; tiledBits != 0u; tiledBits &= tiledBits - 1u) large[at++] = ownTriangle(uint(findLSB(tiledBits)), lane, isThere);
    uint clippedCount = bitCount(clippedBits);
    if (clippedBits != 0u) at = atomicAdd(state.clippedCount, clippedCount);
    for (; clippedBits != 0u; clippedBits &= clippedBits - 1u) clipped[at++] = ownTriangle(uint(findLSB(clippedBits)), lane, isThere);

    // Packed, since an atomic costs more than the rest of a tiny triangle's bookkeeping: a workgroup has 512
    // triangles, which 10 bits hold, and tests at most 2^15 pixels.
    uvec4 sums = subgroupAdd(uvec4(work.outside | work.back << 10 | work.empty << 20,
                                   work.small | largeCount << 10 | clippedCount << 20, work.visited, work.covered));
    if (subgroupElect()) {
        atomicAdd(packed[0], sums.x);
        atomicAdd(packed[1], sums.y);
        atomicAdd(packed[2], sums.z);
        atomicAdd(packed[3], sums.w);
    }
    barrier();
    if (lane == 0u) {
#ifndef CLUSTERS  // else culling has counted them
        uint begin = gl_WorkGroupID.x * GROUP_TRIANGLES;
        atomicAdd(counters[COUNT_TRIANGLES], uint64_t(min(GROUP_TRIANGLES, push.count - begin)));
#endif
    } else if (lane <= 6u) {
        uint value = packed[(lane - 1u) / 3u] >> (10u * ((lane - 1u) % 3u)) & 1023u;
        atomicAdd(counters[COUNT_OUTSIDE + int(lane) - 1], uint64_t(value));
    } else if (lane <= 8u) {
        uint pixels = packed[lane - 5u];
        atomicAdd(counters[COUNT_SMALL_VISITED + int(lane) - 7], uint64_t(pixels));
        if (lane == 8u) atomicAdd(state.smallPixels, pixels);
    }
}

#endif
