#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
/** @file Takes waiting paths through what their rays met: the same steps as a turn of trace.comp. */
#include "passes/pathtrace/wavefront.glsl"

void main() {
    const uint at = queuePlace();
    const bool waits = at < uLengths.queue[parameters.budget].w;
    const uint index = waits ? queuedPixel(parameters.budget, at) : 0u;
    uint bounceRays = 0u, cutPaths = 0u;
    bool asks = false;
    if (waits) {
        const uvec2 pixel = pixelOf(index);
        const uvec2 hit = uHits.hits[index];
        const int slot = int(hit.y);
        Path path = loadPath(pixel);
        const PixelSampler numbers = numbersOf(pixel, path.sampleIndex);
#ifdef MOTION_KEYS
        setMotionTime(pathTime(numbers, pixel));
#endif
        seeSurroundings(path, pixel, slot < 0);
#ifdef BOUNCES
        const uint depth = path.depth;
        const vec3 before = path.radiance;
        path.radiance = vec3(0.0);
#endif
        ShadowRay rays[LIGHTS_ASKED];
        bool cut;
        bool alive = scatter(path, numbers, uintBitsToFloat(hit.x), slot, parameters.maxDepth, rays, cut);
#ifdef BOUNCES
        addBounce(pixel, parameters.size, depth, path.radiance);
        path.radiance += before;
#endif
#ifdef CAMERA_TABLE
        alive = alive && largestOf(path.throughput) > 0.0;  // where the camera sees nothing
#endif
        bounceRays = alive ? 1u : 0u;
        cutPaths = cut ? parameters.countCut : 0u;
        storePath(pixel, path);
        imageStore(uState, stateTexel(pixel) + ivec2(1, 1),
                   vec4(imageLoad(uState, stateTexel(pixel) + ivec2(1, 1)).xyz, float(path.lightPlace)));
        [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i) {
            const ShadowRay ray = rays[i];
            const bool asked = ray.limit > 0.0;
            const uint waiting = (alive ? 0u : WAITING_END) | (asked ? WAITING_ASKS : 0u) |
                                 (ray.limit == INFINITE_DISTANCE ? WAITING_INFINITE : 0u);
            const uint place = shadowPlace(index, uint(i));
            uShadows.shadows[place] = uvec4(floatBitsToUint(ray.origin), uint(ray.target.x));
            uShadows.shadows[place + 1u] = uvec4(floatBitsToUint(ray.direction), uint(ray.target.y));
            uShadows.shadows[place + 2u] = uvec4(floatBitsToUint(asked ? ray.radiance : vec3(0.0)), waiting);
            asks = asks || asked;
        }
    }
    enqueue(SHADOW_QUEUE, index, asks);
    COUNT(bounce, bounceRays)
    COUNT(cut, cutPaths)
}
