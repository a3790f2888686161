// Set-up: triangles are transformed and culled; small ones are drawn at once by 64-bit atomics, others are listed for the
// tiles or for clipping.
#ifndef PASSES_RASTER_SETUP_GLSL
#define PASSES_RASTER_SETUP_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/scene/triangles.glsl"
#include "shaders/raster/triangle.glsl"
#include "shaders/raster/state.glsl"

layout(local_size_x = 64) in;
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
const uint PER_THREAD = 8u;

shared uint packed[4];

bool beyondGuardBand(HomogeneousVertex v) {
    double reach = GUARD_BAND * v.w;
    return v.x > reach || v.x < -reach || v.y > reach || v.y < -reach;
}

#ifdef CLUSTERS
/// First triangle of the cluster that this workgroup sets up in turn k, and whether there is one.
uint clusterAt(uint k, out bool isThere) {
    uint place = push.first + gl_WorkGroupID.x * PER_THREAD + k;
    isThere = place < texelFetch(uClusterState, CLUSTER_COUNT + PHASE).x;
    uint all = texelFetch(uClusterState, CLUSTER_ALL).x, front = texelFetch(uClusterState, CLUSTER_SEEN).x;
    uint at = PHASE == 1 ? all + place : place < front ? place : all - 1u - (place - front);
    return texelFetch(uClusterList, isThere ? int(at) : 0).x * CLUSTER_TRIANGLES;
}
#endif

/// The triangle that an invocation set up in turn k.
uint ownTriangle(uint k, uint lane) {
#ifdef CLUSTERS
    bool isThere;
    return clusterAt(k, isThere) + lane;
#else
    return push.first + gl_WorkGroupID.x * (64u * PER_THREAD) + k * 64u + lane;
#endif
}

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < 4u) packed[lane] = 0u;
    barrier();

    ivec2 size = imageSizePixels();
    double width = double(size.x), height = double(size.y);
    uint outsideCount = 0u, backCount = 0u, emptyCount = 0u, smallCount = 0u, largeCount = 0u,
         clippedCount = 0u, visited = 0u, covered = 0u;
    uint tiledBits = 0u, clippedBits = 0u;  // of this invocation's triangles
    [[dont_unroll]] for (uint k = 0u; k < PER_THREAD; ++k) {
#ifdef CLUSTERS
        bool valid;
        uint t = clusterAt(k, valid) + lane;
        valid = valid && t < push.count;
        t = valid ? t : 0u;
#else
        uint index = gl_WorkGroupID.x * (64u * PER_THREAD) + k * 64u + lane;
        bool valid = index < push.count;
        uint t = push.first + min(index, push.count - 1u);
#endif
        Triangle source = fetchTriangle(int(t));
        HomogeneousVertex a = projectVertex(source.v0), b = projectVertex(source.v1), c = projectVertex(source.v2);

        // Each test is linear in homogeneous pixels, hence right for vertices behind the eye too.
        double least = lesser(a.near, lesser(b.near, c.near)), most = greater(a.near, greater(b.near, c.near));
        bool outside = (a.x < 0.0LF && b.x < 0.0LF && c.x < 0.0LF) || (a.y < 0.0LF && b.y < 0.0LF && c.y < 0.0LF) ||
                       (a.x > width * a.w && b.x > width * b.w && c.x > width * c.w) ||
                       (a.y > height * a.w && b.y > height * b.w && c.y > height * c.w) || most < 0.0LF;
        outsideCount += uint(valid && outside);
        valid = valid && !outside;

        DepthPlane plane = depthPlane(a, b, c);
        bool back = (push.flags & RASTER_CULL_BACK) != 0u && plane.facing < 0.0LF;
        backCount += uint(valid && back);
        valid = valid && !back;

        bool clip = valid && (beyondGuardBand(a) || beyondGuardBand(b) || beyondGuardBand(c) || least < 0.0LF);
        clippedBits |= uint(clip) << k;
        valid = valid && !clip;

        ivec2 p = snap(a.x, a.y, a.w), q = snap(b.x, b.y, b.w), r = snap(c.x, c.y, c.w);
        int64_t area = signedArea(p, q, r);
        ivec4 bounds = pixelBounds(p, q, r, size);
        ivec2 cells = bounds.zw - bounds.xy + 1;
        bool none = area == 0 || min(cells.x, cells.y) <= 0;
        emptyCount += uint(valid && none);
        valid = valid && !none;

        ivec2 extent = max(p, max(q, r)) - min(p, min(q, r));
        bool small = max(cells.x, cells.y) <= SMALL && max(extent.x, extent.y) <= SMALL_EXTENT;
        bool tiled = valid && !small;
        tiledBits |= uint(tiled) << k;

        valid = valid && small;
        smallCount += uint(valid);
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
        visited += valid ? uint(cells.x * cells.y) : 0u;
        // First which pixels are covered, row by row, then those alone: an atomic's code costs far more than a test,
        // even where it is masked out. Bit 8 y + x.
        int width_ = valid ? cells.x : 0, rows = valid ? cells.y : 0;
        uint inRow = (1u << width_) - 1u;
        uint64_t coverage = 0ul;
        for (int y = 0; y < rows; ++y) {
            uint outsideRow = 0u;
            ivec3 edge = e;
            for (int first = 0; first < width_; first += 4) {
                uint outside4 = 0u;
                [[unroll]] for (int x = 0; x < 4; ++x) {
                    outside4 |= uint(edge.x | edge.y | edge.z) >> (31 - x) & (1u << x);
                    edge += right;
                }
                outsideRow |= outside4 << first;
            }
            coverage |= uint64_t(~outsideRow & inRow) << (8 * y);
            e += down;
        }
        uvec2 mask = unpackUint2x32(coverage);
        covered += uint(bitCount(mask.x) + bitCount(mask.y));
        int origin = bounds.y * size.x + bounds.x;
        double cornerX = double(bounds.x) + 0.5LF, cornerY = double(bounds.y) + 0.5LF;
        for (; (mask.x | mask.y) != 0u;) {
            bool upper = mask.x == 0u;
            uint word = upper ? mask.y : mask.x;
            int at = findLSB(word), x = at & 7, y = (at >> 3) + (upper ? 4 : 0);
            word &= word - 1u;
            mask = upper ? uvec2(0u, word) : uvec2(word, mask.y);
            int depth = depthBits(plane.a, plane.b * (cornerY + double(y)) + plane.c, cornerX + double(x), low, high);
            uint64_t key = visibilityKey(depth, id);
            // Without a look at what is there: that takes a fifth longer on CPUs, hidden triangles or not.
            int index = origin + y * size.x + x;
#ifdef PEEL
            if (key >= packUint2x32(texelFetch(uLimit, index).xy)) key = 0ul;
#endif
            atomicMax(visibility[index], key);
        }
    }

    // Lists last, and once: an atomic's code and a store's cost as much where every invocation is masked out.
    largeCount = bitCount(tiledBits);
    uint at = 0u;
    if (tiledBits != 0u) at = atomicAdd(state.largeCount, largeCount);
    for (; tiledBits != 0u; tiledBits &= tiledBits - 1u) large[at++] = ownTriangle(uint(findLSB(tiledBits)), lane);
    clippedCount = bitCount(clippedBits);
    if (clippedBits != 0u) at = atomicAdd(state.clippedCount, clippedCount);
    for (; clippedBits != 0u; clippedBits &= clippedBits - 1u) clipped[at++] = ownTriangle(uint(findLSB(clippedBits)), lane);

    // Packed, since an atomic costs more than the rest of a tiny triangle's bookkeeping: a workgroup has 512
    // triangles, which 10 bits hold, and tests at most 2^9 pixels a lane in 2^6 lanes.
    uvec4 sums = subgroupAdd(uvec4(outsideCount | backCount << 10 | emptyCount << 20,
                                   smallCount | largeCount << 10 | clippedCount << 20, visited, covered));
    if (subgroupElect()) {
        atomicAdd(packed[0], sums.x);
        atomicAdd(packed[1], sums.y);
        atomicAdd(packed[2], sums.z);
        atomicAdd(packed[3], sums.w);
    }
    barrier();
    if (lane == 0u) {
#ifndef CLUSTERS  // else culling has counted them
        uint begin = gl_WorkGroupID.x * (64u * PER_THREAD);
        atomicAdd(counters[COUNT_TRIANGLES], uint64_t(min(64u * PER_THREAD, push.count - begin)));
#endif
    } else if (lane <= 6u) {
        uint value = packed[(lane - 1u) / 3u] >> (10u * ((lane - 1u) % 3u)) & 1023u;
        atomicAdd(counters[COUNT_OUTSIDE + int(lane) - 1], uint64_t(value));
        if (COUNT_OUTSIDE + int(lane) - 1 == COUNT_SMALL) atomicAdd(state.smallCount, value);
    } else if (lane <= 8u) {
        atomicAdd(counters[COUNT_SMALL_VISITED + int(lane) - 7], uint64_t(packed[lane - 5u]));
    }
}

#endif
