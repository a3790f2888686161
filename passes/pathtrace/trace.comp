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
#include "passes/pathtrace/pixel_paths.glsl"

layout(local_size_x = 64) in;

/** While no ray of a group meets anything, next samples are begun without what surfaces need: masks skip no code where
 * the driver has no branches, a loop does. Of small scenes that costs more than it saves. */
const bool SKIPS_MISSES = HAS_ENVIRONMENT && COUNT_TURNS;

void main() {
    const uvec2 pixel = tilePixel(parameters.size);
    const bool inside = all(lessThan(pixel, parameters.size));
    const bool begin = parameters.begin != 0u;
    Path path = loadPath(pixel);
    const uint kept = begin ? 0u : loadKept(pixel);
    path.sampleIndex = begin ? 0u : path.sampleIndex;
    PixelSampler numbers = numbersOf(pixel, path.sampleIndex);
    bool between = kept == 0u || (kept & KEPT_BETWEEN) != 0u;
    const FilmPixel stored = loadFilm(ivec2(pixel));
    FilmBatch batch = startFilmBatch(stored);
    if ((kept & KEPT_BATCH) != 0u) batch = loadBatch(pixel);
    const uint sampleEnd = inside ? samplesToReach(pixel) : 0u;
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
                numbers = numbersOf(pixel, path.sampleIndex);
                path = startPath(numbers, pixel, path.sampleIndex);
                cameraRays += 1u;
            }
#ifdef MOTION_KEYS
            setMotionTime(pathTime(numbers, pixel));
#endif
            closestTurns = closestSurface(path.origin, path.direction, path.source, opacityKey(numbers, pixel, path), false, distance, slot);
            const bool misses = slot < 0;
            seeSurroundings(path, pixel, misses);
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
        ShadowRay shadows[LIGHTS_ASKED];
#ifdef BOUNCES
        const uint depth = path.depth;
        const vec3 before = path.radiance;
        path.radiance = vec3(0.0);
#endif
        bool alive = scatter(path, numbers, distance, slot, parameters.maxDepth, shadows, cut);
        vec3 direct = vec3(0.0);
#if LIGHTS_ASKED > 1
        [[dont_unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i)
#endif
        {
            const ShadowRay shadow = shadows[0];
            bool blocked;
            float passes;
            const int turns = shadowed(shadow.origin, shadow.direction, path.source, shadow.target, shadow.limit, blocked, passes);
            direct += shadow.limit > 0.0 && !blocked ? shadow.radiance * passes : vec3(0.0);
            shadowRays += shadow.limit > 0.0 ? 1u : 0u;
            if (COUNT_TURNS) {
                abandonedRays += turns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
                spent += uint(subgroupMax(turns));
            }
            [[unroll]] for (int j = 1; j < LIGHTS_ASKED; ++j) shadows[j - 1] = shadows[j];
        }
#ifdef BOUNCES
        addBounce(pixel, parameters.size, depth, path.radiance);
        addBounce(pixel, parameters.size, depth + 1u, direct);
        path.radiance += before;
#endif
        path.radiance += direct;

#ifdef CAMERA_TABLE
        alive = alive && largestOf(path.throughput) > 0.0;  // where the camera sees nothing
#endif
        bounceRays += alive ? 1u : 0u;
        cutPaths += cut ? parameters.countCut : 0u;
        if (!alive && !between) {
            addFilmSample(batch, path.sampleIndex, path.radiance);
            path.sampleIndex += 1u;
            between = true;
        }
        spent += LOOP_TURNS;
    }

    const bool finished = path.sampleIndex >= sampleEnd;
    if (inside) {
        if (finished) {
            finishPixel(pixel, stored, batch, path.sampleIndex);
        } else {
            storePath(pixel, path);
            storeBatch(pixel, batch, path.lightPlace, between);
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
