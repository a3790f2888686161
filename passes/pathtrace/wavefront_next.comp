#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
/** @file
 * Ends a round: light that arrived is added, samples that ended go into the film, the pixel's next sample starts at
 * once, and what is not done waits for the next round.
 */
#include "passes/pathtrace/wavefront.glsl"

void main() {
    const uint at = queuePlace();
    const bool waits = at < uLengths.queue[parameters.budget].w;
    const uint index = waits ? queuedPixel(parameters.budget, at) : 0u;
    uint cameraRays = 0u;
    bool open = false;
    if (waits) {
        const uvec2 pixel = pixelOf(index);
        const uvec4 arrived = uShadows.shadows[shadowPlace(index, 0u) + 2u];
        const vec3 light = uintBitsToFloat(arrived.xyz);
        const uint waiting = arrived.w;
        const uint kept = loadKept(pixel);
        Path path = loadPath(pixel);
        const FilmPixel stored = loadFilm(ivec2(pixel));
        FilmBatch batch = startFilmBatch(stored);
        if ((kept & KEPT_BATCH) != 0u) batch = loadBatch(pixel);
        const bool begins = (waiting & WAITING_BEGIN) != 0u, ends = (waiting & WAITING_END) != 0u;
#ifdef BOUNCES
        if (!begins) addBounce(pixel, parameters.size, path.depth, light);
#endif
        if (!begins) path.radiance += light;
        if (ends) {
            addFilmSample(batch, path.sampleIndex, path.radiance);
            path.sampleIndex += 1u;
        }
        open = path.sampleIndex < samplesToReach(pixel);
        const bool between = ends || (begins && (kept == 0u || (kept & KEPT_BETWEEN) != 0u));
        if (between && open) {
            path = startPath(numbersOf(pixel, path.sampleIndex), pixel, path.sampleIndex);
            cameraRays = 1u;
        }
        if (open) {
            storePath(pixel, path);
            storeBatch(pixel, batch, path.lightPlace, false);
        } else {
            finishPixel(pixel, stored, batch, path.sampleIndex);
        }
    }
    enqueue(1u - parameters.budget, index, open);
    COUNT(camera, cameraRays)
}
