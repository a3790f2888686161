#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
/** @file Whether the ways to lights are free, and what they then bring. */
#include "passes/pathtrace/wavefront.glsl"

void main() {
    const uint at = queuePlace();
    const bool waits = at < uLengths.queue[SHADOW_QUEUE].w;
    uint abandoned = 0u;
    if (waits) {
        const uint index = queuedPixel(SHADOW_QUEUE, at);
        const uvec2 pixel = pixelOf(index);
#ifdef MOTION_KEYS
        setMotionTime(pathTime(numbersOf(pixel, loadPath(pixel).sampleIndex), pixel));
#endif
        const uvec4 from = uShadows.shadows[index * 3u], towards = uShadows.shadows[index * 3u + 1u];
        const uvec4 light = uShadows.shadows[index * 3u + 2u];
        const float limit = (light.w & WAITING_INFINITE) != 0u ? INFINITE_DISTANCE : 1.0;
        bool blocked;
        float passes;
        const int turns = shadowed(uintBitsToFloat(from.xyz), uintBitsToFloat(towards.xyz), loadPath(pixel).source,
                                   ivec2(from.w, towards.w), limit, blocked, passes);
        uShadows.shadows[index * 3u + 2u] = uvec4(floatBitsToUint(blocked ? vec3(0.0) : uintBitsToFloat(light.xyz) * passes), light.w);
        if (COUNT_TURNS) abandoned = turns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
    }
    COUNT(shadow, waits ? 1u : 0u)
    COUNT(abandoned, abandoned)
}
