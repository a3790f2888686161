#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
/** @file
 * Regenerating megakernel: one invocation per pixel traces path after path; a path that ends is followed by
 * the pixel's next sample at once, so that lanes stay busy. A dispatch takes a bounded number of loop turns
 * (`budget`), then keeps every lane's state in uState and goes on in the next dispatch. Where it pauses does
 * not change the result: state is exact, and samples are merged into the film in batches whose ends depend on
 * `sampleEnd` alone.
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

layout(local_size_x = 64) in;

/** See TraceParameters in passes/pathtrace/parameters.hpp. */
layout(push_constant) uniform Parameters {
    CameraFrame camera;
    vec4 environment;   ///< radiance of rays that leave the scene
    uvec2 size;         ///< pixels
    uint sampleEnd;     ///< samples per pixel to reach
    uint seed;
    uint maxDepth;
    uint countCut;      ///< 1: paths cut at maxDepth are counted
    uint budget;        ///< loop turns of the whole group to start with
    uint begin;         ///< 1: the first dispatch, uState holds nothing yet
} parameters;

/** A pixel's state between dispatches: 4 x 2 texels. */
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
/** While no ray of a group meets anything, next samples are begun without what surfaces need: masks skip no code where
 * the driver has no branches, a loop does. Of small scenes that costs more than it saves. */
const bool SKIPS_MISSES = HAS_ENVIRONMENT && COUNT_TURNS;

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
    return path;
}
#endif

void main() {
    const uvec2 pixel = tilePixel(parameters.size);
    const bool inside = all(lessThan(pixel, parameters.size));
    const uint pixelIndex = SAMPLER_KIND == SAMPLER_SOBOL_BLUE ? mortonCode(pixel.x, pixel.y)
                                                               : pixel.y * parameters.size.x + pixel.x;
    const ivec2 place = ivec2(pixel) * ivec2(4, 2);
    const ivec2 filmPixel = ivec2(pixel);

    // Bits are kept as float texels: indices are stored as exact floats where they are small (depth,
    // source), the sample index in two halves.
    const bool begin = parameters.begin != 0u;
    const vec4 s0 = begin ? vec4(0.0) : imageLoad(uState, place), s1 = imageLoad(uState, place + ivec2(1, 0));
    const vec4 s2 = imageLoad(uState, place + ivec2(2, 0)), s3 = imageLoad(uState, place + ivec2(3, 0));
    const vec4 s4 = imageLoad(uState, place + ivec2(0, 1)), s5 = imageLoad(uState, place + ivec2(1, 1));
    const vec4 s6 = imageLoad(uState, place + ivec2(2, 1)), s7 = begin ? vec4(0.0) : imageLoad(uState, place + ivec2(3, 1));
    FilmPixel stored = loadFilm(filmPixel);
    FilmBatch batch = startFilmBatch(stored);
    uint sampleIndex = uint(s0.w);
    PixelSampler numbers = startSample(SAMPLER_KIND, pixelIndex, sampleIndex, parameters.seed, SAMPLER_STRATA);
    const uint kept = uint(s7.w);
    const bool resumed = kept != 0u;
    bool between = !resumed || (kept & KEPT_BETWEEN) != 0u;
    Path path = Path(s0.xyz, s1.xyz, s2.xyz, s3.xyz, s1.w, uint(s2.w), sampleIndex, int(s3.w), int(s5.w));
    if ((kept & KEPT_BATCH) != 0u) {
        // Each half has at most 2048 of a batch's samples.
        const float countB = floor(s4.w * (1.0 / 4096.0));
        batch = FilmBatch(s7.xyz, s4.xyz, s5.xyz, s6.xyz, s4.w - 4096.0 * countB, countB, s6.w, true);
    }

#ifdef ADAPTIVE
    const uint sampleEnd = inside ? texelFetch(uSampleEnds, int(pixel.y * parameters.size.x + pixel.x)).x : 0u;
#else
    const uint sampleEnd = parameters.sampleEnd;
#endif
#ifdef BOUNCES
    if (inside && begin) clearBounces(pixel, parameters.size);
#endif
    uint cameraRays = 0u, bounceRays = 0u, shadowRays = 0u, cutPaths = 0u, abandonedRays = 0u;
    uint spent = 0u;
    while (inside && path.sampleIndex < sampleEnd && spent < parameters.budget) {
        float distance;
        int slot, closestTurns;
        bool skips;
        do {
            if (between) {
                numbers = startSample(SAMPLER_KIND, pixelIndex, path.sampleIndex, parameters.seed, SAMPLER_STRATA);
                path = startPath(numbers, pixel, path.sampleIndex);
                cameraRays += 1u;
            }
#ifdef MOTION_KEYS
            setMotionTime(pathTime(numbers, pixel));
#endif
            closestTurns = closestSurface(path.origin, path.direction, path.source, hashCombine(numbers.key ^ pixelIndex, numbers.index + path.depth * 2u), false, distance, slot);
            const bool misses = slot < 0;
            if (HAS_ENVIRONMENT) {
                const vec3 seen = environmentLight(path.direction, path.density, path.lightPlace, parameters.environment.xyz);
                const vec3 sky = misses ? path.throughput * seen : vec3(0.0);
#ifdef BOUNCES
                addBounce(pixel, parameters.size, path.depth, sky);
#endif
                path.radiance += sky;
            }
            between = SKIPS_MISSES && misses;
            if (between) {
                addFilmSample(batch, path.sampleIndex, path.radiance);
                path.sampleIndex += 1u;
            }
            spent += 1u + uint(LENS_SURFACES);
#ifdef METER
            spent += meterTurns;
            meterTurns = 0u;
#endif
            if (COUNT_TURNS) {
                abandonedRays += closestTurns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
                spent += uint(subgroupMax(closestTurns));
            }
            skips = between && path.sampleIndex < sampleEnd && spent < parameters.budget;
        } while (SKIPS_MISSES && subgroupAll(skips));

        bool cut;
        ShadowRay shadow;
#ifdef BOUNCES
        const uint depth = path.depth;
        const vec3 before = path.radiance;
        path.radiance = vec3(0.0);
#endif
        bool alive = scatter(path, numbers, distance, slot, parameters.maxDepth, shadow, cut);
        bool blocked;
        float passes;
        const int shadowTurns = shadowed(shadow.origin, shadow.direction, path.source, shadow.target, shadow.limit, blocked, passes);
        const vec3 direct = shadow.limit > 0.0 && !blocked ? shadow.radiance * passes : vec3(0.0);
#ifdef BOUNCES
        addBounce(pixel, parameters.size, depth, path.radiance);
        addBounce(pixel, parameters.size, depth + 1u, direct);
        path.radiance += before;
#endif
        path.radiance += direct;

#ifdef CAMERA_TABLE
        alive = alive && largestOf(path.throughput) > 0.0;  // where the camera sees nothing
#endif
        shadowRays += shadow.limit > 0.0 ? 1u : 0u;
        bounceRays += alive ? 1u : 0u;
        cutPaths += cut ? parameters.countCut : 0u;
        if (!alive && !between) {
            addFilmSample(batch, path.sampleIndex, path.radiance);
            path.sampleIndex += 1u;
            between = true;
        }
        spent += LOOP_TURNS;
        if (COUNT_TURNS) {
            abandonedRays += shadowTurns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
            spent += uint(subgroupMax(shadowTurns));
        }
    }

    const bool finished = path.sampleIndex >= sampleEnd;
    if (inside) {
        if (finished) {
            storeFilm(filmPixel, mergeFilmBatch(stored, batch));
#ifdef BOUNCES
            mergeBounces(pixel, parameters.size);
#endif
            imageStore(uState, place, vec4(0.0, 0.0, 0.0, float(path.sampleIndex)));
            imageStore(uState, place + ivec2(3, 1), vec4(0.0));
        } else {
            imageStore(uState, place, vec4(path.origin, float(path.sampleIndex)));
            imageStore(uState, place + ivec2(1, 0), vec4(path.direction, path.density));
            imageStore(uState, place + ivec2(2, 0), vec4(path.throughput, float(path.depth)));
            imageStore(uState, place + ivec2(3, 0), vec4(path.radiance, float(path.source)));
            imageStore(uState, place + ivec2(0, 1), vec4(batch.sumA, batch.countA + 4096.0 * batch.countB));
            imageStore(uState, place + ivec2(1, 1), vec4(batch.sumB, float(path.lightPlace)));
            imageStore(uState, place + ivec2(2, 1), vec4(batch.squares, batch.rejected));
            imageStore(uState, place + ivec2(3, 1), vec4(batch.shift, float(KEPT | (between ? KEPT_BETWEEN : 0u) | (batch.shifted ? KEPT_BATCH : 0u))));
        }
    }
    const uint unfinished = subgroupAdd(inside && !finished ? 1u : 0u);
    if (subgroupElect() && unfinished > 0u) atomicAdd(uCounters.open, unfinished);
    COUNT(camera, cameraRays)
    COUNT(bounce, bounceRays)
    COUNT(shadow, shadowRays)
    COUNT(cut, cutPaths)
    COUNT(abandoned, abandonedRays)
}
