// Drawing where few triangles cover a pixel: set-up goes on until every invocation of the subgroup has pixels to draw, so
// that atomics, which cost CPUs about as much for one invocation as for all, serve all of them. Pays where most triangles
// cover none; for subgroups of at most 16 invocations, whose sums are made by shuffles, since the driver's own are loops.
#ifndef PASSES_RASTER_GATHER_GLSL
#define PASSES_RASTER_GATHER_GLSL

const uint WIDEST = 16u;

/// How many of the invocations before this one say yes, and of all.
uint countBefore(bool yes, out uint all) {
    uint sum = uint(yes);
    [[unroll]] for (uint step = 1u; step < WIDEST; step *= 2u) {
        bool isThere = gl_SubgroupInvocationID >= step;
        uint other = subgroupShuffle(sum, isThere ? gl_SubgroupInvocationID - step : 0u);
        sum += isThere ? other : 0u;
    }
    all = subgroupShuffle(sum, gl_SubgroupSize - 1u);
    return sum - uint(yes);
}

/// Invocation i gets the place of the one that is the i-th to say yes; `before` as countBefore() says.
uint placesOf(bool yes, uint before) {
    // Each moves down by as many places as there are that say no before it, one power of two after the other.
    uint self = gl_SubgroupInvocationID, value = self | (yes ? (self - before) << 8 : 0u);
    [[unroll]] for (uint step = 1u; step < WIDEST; step *= 2u) {
        bool isThere = self + step < gl_SubgroupSize;
        uint other = subgroupShuffle(value, isThere ? self + step : 0u);
        bool moves = isThere && (other & step << 8) != 0u;
        value = moves ? other : (value & step << 8) != 0u ? 0u : value;
    }
    return value & 0xffu;
}

Pending shufflePending(Pending p, uint from) {
    return Pending(subgroupShuffle(p.mask, from), subgroupShuffle(p.first, from), subgroupShuffle(p.a, from),
                   subgroupShuffle(p.b, from), subgroupShuffle(p.c, from), subgroupShuffle(p.low, from),
                   subgroupShuffle(p.high, from), subgroupShuffle(p.id, from));
}

/// Triangles of one turn that wait for an invocation to draw them.
struct Waiting {
    Pending triangle;
    uint places;        // of invocation i: where the i-th lies
    uint taken, count;  // that have found one, and that have not
};

/// Gives invocations that have drawn theirs what waits; how many have something to draw.
uint handOut(inout Pending drawn, inout Waiting waiting) {
    uint free, rank = countBefore(isDrawn(drawn), free);
    bool takes = isDrawn(drawn) && rank < waiting.count;
    Pending other = shufflePending(waiting.triangle, subgroupShuffle(waiting.places, takes ? waiting.taken + rank : 0u));
    if (takes) drawn = other;
    uint found = min(free, waiting.count);
    waiting.taken += found;
    waiting.count -= found;
    return gl_SubgroupSize - free + found;
}

/// All turns of an invocation.
void drawTogether(uint lane, ivec2 size, inout Work work) {
    Pending drawn = Pending(uvec2(0u), 0u, uvec2(0u), uvec2(0u), uvec2(0u), 0, 0, 0u);
    Waiting waiting = Waiting(drawn, 0u, 0u, 0u);
    uint k = 0u, busy = 0u;
    do {
        do {
            waiting.triangle = setUp(k, lane, size, work);
            bool waits = !isDrawn(waiting.triangle);
            waiting.places = placesOf(waits, countBefore(waits, waiting.count));
            waiting.taken = 0u;
            busy = handOut(drawn, waiting);
            ++k;
        } while (waiting.count == 0u && k < PER_THREAD);
        do {
            drawPixel(drawn, size);
            busy = handOut(drawn, waiting);
        } while (waiting.count != 0u || (k == PER_THREAD && busy != 0u));
    } while (k < PER_THREAD);
}

#endif
