#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
/** @file
 * Empties the queues that a round of the wavefront fills; where `parameters.begin` is above 1, puts every pixel that
 * has samples to go in the queue in use. In that case the first dispatch ever has 3.
 */
#include "passes/pathtrace/wavefront.glsl"

void main() {
    const uint index = queuePlace(), queue = parameters.budget;
    const bool inside = index < pixelCount();
    const uvec2 pixel = pixelOf(inside ? index : 0u);
    if (parameters.begin > 1u) {
        const bool anew = parameters.begin == 3u;
        const uint sampleIndex = anew ? 0u : loadPath(pixel).sampleIndex;
        const bool open = inside && sampleIndex < samplesToReach(pixel);
#ifdef BOUNCES
        if (inside && anew) clearBounces(pixel, parameters.size);
#endif
        if (inside && anew) {
            imageStore(uState, stateTexel(pixel), vec4(0.0));
            imageStore(uState, stateTexel(pixel) + ivec2(3, 1), vec4(0.0));
        }
        if (open) uShadows.shadows[shadowPlace(index, 0u) + 2u] = uvec4(0u, 0u, 0u, WAITING_BEGIN);
        enqueue(queue, index, open);
    } else if (index == 0u) {
        uLengths.queue[1u - queue] = uvec4(0u, 1u, 1u, 0u);
        uLengths.queue[SHADOW_QUEUE] = uvec4(0u, 1u, 1u, 0u);
    }
}
