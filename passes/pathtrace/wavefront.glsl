#ifndef HELIOGRAPH_PATHTRACE_WAVEFRONT
#define HELIOGRAPH_PATHTRACE_WAVEFRONT
/** @file
 * The wavefront scheduler's queues. Each pixel has one path at a time; one round of kernels takes every path that
 * waits in a queue through one scattering, and pixels that are done wait in none:
 *   wavefront_closest  what the paths' rays meet
 *   wavefront_shade    scattering (path.glsl), which gives the next ray and a shadow ray
 *   wavefront_shadow   whether the ways to lights are free
 *   wavefront_next     adds their light, ends samples, starts next ones, and fills the queue of the next round.
 * Queues hold pixels, in an order that does not matter. Two are used in turn: `parameters.budget` is the one in use.
 */
#include "passes/pathtrace/pixel_paths.glsl"

layout(local_size_x = 128) in;

/** Pixels: two queues of paths and one of shadow rays, one behind the other. */
layout(set = 0, binding = 50, std430) buffer Queues { uint pixels[]; } uQueues;
/** Of each queue: workgroups in x, y, z for its pixels, and their number. */
layout(set = 0, binding = 51, std430) buffer Lengths { uvec4 queue[3]; } uLengths;
/** Of each pixel: bits of the distance, slot (-1: none). */
layout(set = 0, binding = 52, std430) buffer Hits { uvec2 hits[]; } uHits;
/** Of each pixel's LIGHTS_ASKED rays to lights three, floats by their bits: origin, target.x; direction, target.y;
 * radiance, WAITING bits. What arrives by all of them takes the first's radiance once they have been asked. */
layout(set = 0, binding = 53, std430) buffer Shadows { uvec4 shadows[]; } uShadows;

const uint SHADOW_QUEUE = 2u;
/** What waits with a pixel: the end of its sample, its state as an earlier dispatch left it; with a ray: that it is asked,
 * and infinite. */
const uint WAITING_END = 1u, WAITING_BEGIN = 2u, WAITING_ASKS = 8u, WAITING_INFINITE = 4u;

/** The first word of a pixel's i-th ray in uShadows. */
uint shadowPlace(uint index, uint i) {
    return (index * uint(LIGHTS_ASKED) + i) * 3u;
}

uint pixelCount() {
    return parameters.size.x * parameters.size.y;
}

/** This invocation's place in a queue; past `length` there is none. */
uint queuePlace() {
    return gl_GlobalInvocationID.x;
}

uint queuedPixel(uint queue, uint at) {
    return uQueues.pixels[queue * pixelCount() + at];
}

uvec2 pixelOf(uint index) {
    return uvec2(index % parameters.size.x, index / parameters.size.x);
}

/** Puts the pixel in the queue where `wanted`. One atomic operation a subgroup. */
void enqueue(uint queue, uint index, bool wanted) {
    const uint before = subgroupExclusiveAdd(wanted ? 1u : 0u);
    const uint count = subgroupAdd(wanted ? 1u : 0u);
    uint first = 0u;
    if (subgroupElect() && count > 0u) {
        first = atomicAdd(uLengths.queue[queue].w, count);
        atomicMax(uLengths.queue[queue].x, (first + count + 127u) / 128u);
    }
    first = subgroupBroadcastFirst(first);
    if (wanted) uQueues.pixels[queue * pixelCount() + first + before] = index;
}
#endif
