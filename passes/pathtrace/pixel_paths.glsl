#ifndef HELIOGRAPH_PATHTRACE_PIXEL_PATHS
#define HELIOGRAPH_PATHTRACE_PIXEL_PATHS
/** @file
 * The paths of a pixel, whatever schedules them: how a sample starts, what is kept of it between dispatches, and
 * counters. State is exact, and the same of all schedulers: one can go on where another paused.
 */
#define FILM_BINDING 1
#include "passes/pathtrace/camera.glsl"
#include "passes/pathtrace/path.glsl"
#include "passes/pathtrace/see_through.glsl"
#include "shaders/film/film.glsl"
#include "shaders/film/filter.glsl"
#include "shaders/intersection/scene_hit.glsl"
#ifdef BOUNCES
#include "passes/pathtrace/bounces.glsl"
#endif

/** See TraceParameters in passes/pathtrace/parameters.hpp. */
layout(push_constant) uniform Parameters {
    CameraFrame camera;
    vec4 environment;   ///< radiance of rays that leave the scene
    uvec2 size;         ///< pixels
    uint sampleEnd;     ///< samples per pixel to reach
    uint seed;
    uint maxDepth;
    uint countCut;      ///< 1: paths cut at maxDepth are counted
    uint budget;        ///< trace.comp: loop turns of the whole group to start with; wavefronts: see wavefront.glsl
    uint begin;         ///< 1: the first dispatch, uState holds nothing yet
} parameters;

/** A pixel's state between dispatches: 4 x 2 texels, 4 x 3 where paths are guided. */
layout(set = 0, binding = 0, rgba32f) uniform image2D uState;
/** What is kept of a pixel that has samples to go: its state, between two paths or within one, and a batch with samples. */
const uint KEPT = 1u, KEPT_BETWEEN = 2u, KEPT_BATCH = 4u;

#ifdef ADAPTIVE
layout(set = 0, binding = 45) uniform usamplerBuffer uSampleEnds;  ///< R32UI: each pixel's own sampleEnd
#endif

/** Counters of all dispatches; 64 bits as two words, lower first. */
layout(set = 0, binding = 2, std430) buffer Counters {
    uint open;        ///< pixels that have not reached sampleEnd, of this dispatch
    uint unused;
    uint camera[2];
    uint bounce[2];
    uint shadow[2];
    uint cut[2];
    uint abandoned[2];  ///< rays given up in the tree
} uCounters;

#define COUNT(member, value)                                                     \
    {                                                                            \
        const uint total = subgroupAdd(value);                                   \
        if (subgroupElect() && total > 0u) {                                     \
            const uint before = atomicAdd(uCounters.member[0], total);            \
            if (before + total < before) atomicAdd(uCounters.member[1], 1u);      \
        }                                                                        \
    }

layout(constant_id = 4) const uint FILTER_KIND = FILTER_BOX;
layout(constant_id = 3) const bool COUNT_TURNS = true;  ///< the loop's body has loops of its own

#ifdef CAMERA_TABLE
/** The time of a path's rays. */
float pathTime(PixelSampler numbers, uvec2 pixel) {
    return rayTime(pixel.y, parameters.size.y, sample1D(SAMPLER_KIND, numbers, DIMENSION_TIME));
}
#endif

#ifdef METER
#include "passes/pathtrace/meter.glsl"
#else
Path startPath(PixelSampler numbers, uvec2 pixel, uint sampleIndex) {
    Path path;
    const vec2 place = vec2(pixel) + 0.5 + filterOffset(FILTER_KIND, sample2D(SAMPLER_KIND, numbers, DIMENSION_FILTER));
    CameraFrame camera = parameters.camera;
    vec2 lens = vec2(0.0);
#ifdef CAMERA_TABLE
    if (HAS_LENS || LENS_SURFACES > 0) lens = lensPoint(sample2D(SAMPLER_KIND, numbers, DIMENSION_LENS));
#endif
#ifdef CAMERA_TABLE
    if (CAMERA_KEYS > 0) camera = movedCamera(camera, pathTime(numbers, pixel));
#endif
    path.throughput = vec3(cameraRay(camera, place, parameters.size, lens, path.origin, path.direction));
    path.radiance = vec3(0.0);
    path.density = -1.0;
    path.depth = 0u;
    path.sampleIndex = sampleIndex;
    path.source = -1;
    path.lightPlace = 0;
#ifdef GUIDED
    path.reach = largestOf(path.throughput);
#endif
    return path;
}
#endif

/** By what a pixel's numbers are scrambled. */
uint pixelKey(uvec2 pixel) {
    return SAMPLER_KIND == SAMPLER_SOBOL_BLUE ? mortonCode(pixel.x, pixel.y) : pixel.y * parameters.size.x + pixel.x;
}

PixelSampler numbersOf(uvec2 pixel, uint sampleIndex) {
    return startSample(SAMPLER_KIND, pixelKey(pixel), sampleIndex, parameters.seed, SAMPLER_STRATA);
}

/** By what alpha decides whether the path's next ray is stopped. */
uint opacityKey(PixelSampler numbers, uvec2 pixel, Path path) {
    return hashCombine(numbers.key ^ pixelKey(pixel), numbers.index + path.depth * 2u);
}

/** Samples that a pixel is to reach. */
uint samplesToReach(uvec2 pixel) {
#ifdef ADAPTIVE
    return texelFetch(uSampleEnds, int(pixel.y * parameters.size.x + pixel.x)).x;
#else
    return parameters.sampleEnd;
#endif
}

/** The first of a pixel's texels in uState. */
ivec2 stateTexel(uvec2 pixel) {
#ifdef GUIDED
    return ivec2(pixel) * ivec2(4, 3);
#else
    return ivec2(pixel) * ivec2(4, 2);
#endif
}

// Bits are kept as float texels: indices are stored as exact floats where they are small (depth, source).
Path loadPath(uvec2 pixel) {
    const ivec2 place = stateTexel(pixel);
    const vec4 s0 = imageLoad(uState, place), s1 = imageLoad(uState, place + ivec2(1, 0));
    const vec4 s2 = imageLoad(uState, place + ivec2(2, 0)), s3 = imageLoad(uState, place + ivec2(3, 0));
    const float lightPlace = imageLoad(uState, place + ivec2(1, 1)).w;
    Path path;
    path.origin = s0.xyz;
    path.direction = s1.xyz;
    path.throughput = s2.xyz;
    path.radiance = s3.xyz;
    path.density = s1.w;
    path.depth = uint(s2.w);
    path.sampleIndex = uint(s0.w);
    path.source = int(s3.w);
    path.lightPlace = int(lightPlace);
#ifdef GUIDED
    path.reach = imageLoad(uState, place + ivec2(0, 2)).x;
#endif
#ifdef INSTANCES
    path.source += int(path.depth >> 17) << 24;
    path.depth &= 0x1ffffu;
#endif
    return path;
}

void storePath(uvec2 pixel, Path path) {
    const ivec2 place = stateTexel(pixel);
    imageStore(uState, place, vec4(path.origin, float(path.sampleIndex)));
    imageStore(uState, place + ivec2(1, 0), vec4(path.direction, path.density));
#ifdef GUIDED
    imageStore(uState, place + ivec2(0, 2), vec4(path.reach, 0.0, 0.0, 0.0));
#endif
#ifdef INSTANCES
    // Slots of placed meshes have 31 bits, 7 of them beside the depth.
    const int high = max(path.source, 0) >> 24;
    path.depth += uint(high) << 17;
    path.source -= high << 24;
#endif
    imageStore(uState, place + ivec2(2, 0), vec4(path.throughput, float(path.depth)));
    imageStore(uState, place + ivec2(3, 0), vec4(path.radiance, float(path.source)));
}

/** Bits of KEPT; 0 where nothing is kept. */
uint loadKept(uvec2 pixel) {
    return uint(imageLoad(uState, stateTexel(pixel) + ivec2(3, 1)).w);
}

/** The batch that is kept. */
FilmBatch loadBatch(uvec2 pixel) {
    const ivec2 place = stateTexel(pixel);
    const vec4 s4 = imageLoad(uState, place + ivec2(0, 1)), s5 = imageLoad(uState, place + ivec2(1, 1));
    const vec4 s6 = imageLoad(uState, place + ivec2(2, 1)), s7 = imageLoad(uState, place + ivec2(3, 1));
    // Each half has at most 2048 of a batch's samples.
    const float countB = floor(s4.w * (1.0 / 4096.0));
    return FilmBatch(s7.xyz, s4.xyz, s5.xyz, s6.xyz, s4.w - 4096.0 * countB, countB, s6.w, true);
}

/** Keeps a batch, of a path at `lightPlace`, and whether the pixel is `between` two paths. */
void storeBatch(uvec2 pixel, FilmBatch batch, int lightPlace, bool between) {
    const ivec2 place = stateTexel(pixel);
    imageStore(uState, place + ivec2(0, 1), vec4(batch.sumA, batch.countA + 4096.0 * batch.countB));
    imageStore(uState, place + ivec2(1, 1), vec4(batch.sumB, float(lightPlace)));
    imageStore(uState, place + ivec2(2, 1), vec4(batch.squares, batch.rejected));
    const uint kept = KEPT | (between ? KEPT_BETWEEN : 0u) | (batch.shifted ? KEPT_BATCH : 0u);
    imageStore(uState, place + ivec2(3, 1), vec4(batch.shift, float(kept)));
}

/** Merges the batch of a pixel that has all its samples into the film. */
void finishPixel(uvec2 pixel, FilmPixel stored, FilmBatch batch, uint sampleIndex) {
    storeFilm(ivec2(pixel), mergeFilmBatch(stored, batch));
#ifdef BOUNCES
    mergeBounces(pixel, parameters.size);
#endif
    imageStore(uState, stateTexel(pixel), vec4(0.0, 0.0, 0.0, float(sampleIndex)));
    imageStore(uState, stateTexel(pixel) + ivec2(3, 1), vec4(0.0));
}

/** What the surroundings add to a path whose ray `misses`. */
void seeSurroundings(inout Path path, uvec2 pixel, bool misses) {
    if (HAS_ENVIRONMENT) {
        const vec3 seen = environmentLight(path.direction, path.density, path.lightPlace, parameters.environment.xyz);
        const vec3 sky = misses ? path.throughput * seen : vec3(0.0);
#ifdef BOUNCES
        addBounce(pixel, parameters.size, path.depth, sky);
#endif
        path.radiance += sky;
    }
}
#endif
