#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
/** @file What the rays of waiting paths meet. */
#include "passes/pathtrace/wavefront.glsl"

void main() {
    const uint at = queuePlace();
    const bool waits = at < uLengths.queue[parameters.budget].w;
    uint abandoned = 0u;
    if (waits) {
        const uint index = queuedPixel(parameters.budget, at);
        const uvec2 pixel = pixelOf(index);
        const Path path = loadPath(pixel);
        const PixelSampler numbers = numbersOf(pixel, path.sampleIndex);
#ifdef MOTION_KEYS
        setMotionTime(pathTime(numbers, pixel));
#endif
        float distance;
        int slot;
        const int turns = closestSurface(path.origin, path.direction, path.source, opacityKey(numbers, pixel, path), false, distance, slot);
        uHits.hits[index] = uvec2(floatBitsToUint(distance), uint(slot));
        if (COUNT_TURNS) abandoned = turns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
    }
    COUNT(abandoned, abandoned)
}
