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
    uint asked = 0u, abandoned = 0u;
    if (waits) {
        const uint index = queuedPixel(SHADOW_QUEUE, at);
        const uvec2 pixel = pixelOf(index);
#ifdef MOTION_KEYS
        setMotionTime(pathTime(numbersOf(pixel, loadPath(pixel).sampleIndex), pixel));
#endif
        const int source = loadPath(pixel).source;
        vec3 arrived = vec3(0.0);
#if LIGHTS_ASKED > 1
        [[dont_unroll]]
#endif
        for (uint i = 0u; i < uint(LIGHTS_ASKED); ++i) {
            const uint place = shadowPlace(index, i);
            const uvec4 from = uShadows.shadows[place], towards = uShadows.shadows[place + 1u], light = uShadows.shadows[place + 2u];
            const bool asks = (light.w & WAITING_ASKS) != 0u;
            const float limit = asks ? ((light.w & WAITING_INFINITE) != 0u ? INFINITE_DISTANCE : 1.0) : 0.0;
            bool blocked;
            float passes;
            const int turns = shadowed(uintBitsToFloat(from.xyz), uintBitsToFloat(towards.xyz), source,
                                       ivec2(from.w, towards.w), limit, blocked, passes);
            arrived += asks && !blocked ? uintBitsToFloat(light.xyz) * passes : vec3(0.0);
            asked += asks ? 1u : 0u;
            if (COUNT_TURNS) abandoned += turns >= MAX_TRAVERSAL_STEPS ? 1u : 0u;
        }
        uShadows.shadows[shadowPlace(index, 0u) + 2u].xyz = floatBitsToUint(arrived);
    }
    COUNT(shadow, asked)
    COUNT(abandoned, abandoned)
}
