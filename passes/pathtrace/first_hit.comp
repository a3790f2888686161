#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
/** @file What the ray through each pixel's centre meets first: ids, depth, shading normal, base
 * colour (what a surface is tinted by, be it diffuse, metal or glass). A lens is passed at its middle, a shutter
 * in the middle of its time. Holes of alpha masks are seen through, blended
 * surfaces count as opaque. */
#include "passes/pathtrace/camera.glsl"
#include "passes/pathtrace/surface.glsl"
#include "passes/pathtrace/see_through.glsl"

layout(local_size_x = 64) in;

/** See FirstHitParameters in passes/pathtrace/parameters.hpp. */
layout(push_constant) uniform Parameters {
    CameraFrame camera;
    uvec2 size;
} parameters;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2D uIds;     ///< instance, triangle, depth, 0
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D uNormal;
layout(set = 0, binding = 2, rgba32f) writeonly uniform image2D uAlbedo;
layout(set = 0, binding = 30) uniform usamplerBuffer uInstanceFirst;  ///< R32UI: first g of each instance

void main() {
    const uvec2 pixel = tilePixel(parameters.size);
    if (any(greaterThanEqual(pixel, parameters.size))) return;
    vec3 origin, direction;
    CameraFrame camera = parameters.camera;
#ifdef CAMERA_TABLE
    if (HAS_TIME) {
        const float time = rayTime(pixel.y, parameters.size.y, 0.5);
        camera = movedCamera(camera, time);
#ifdef MOTION_KEYS
        setMotionTime(time);
#endif
    }
#endif
    const bool seen = cameraRay(camera, vec2(pixel) + 0.5, parameters.size, vec2(0.0), origin, direction) > 0.0;
    float distance;
    int slot;
    closestSurface(origin, direction, -1, 0u, true, distance, slot);
    const bool hit = slot >= 0 && seen;
    const SurfacePoint s = surfaceAt(origin, direction, -1, max(slot, 0));
    const int first = int(texelFetch(uInstanceFirst, s.triangle.instance).x);
    const float depth = dot(s.position - camera.origin.xyz, camera.forward.xyz);
    const vec3 albedo = baseColor(s.triangle.material, s.triangle.g, s.b).rgb;
    // Ids are exact as floats: there are fewer than 2^24 triangles.
    imageStore(uIds, ivec2(pixel),
               hit ? vec4(float(s.triangle.instance), float(s.triangle.g - first), depth, 0.0) : vec4(-1.0, -1.0, 0.0, 0.0));
    imageStore(uNormal, ivec2(pixel), vec4(hit ? s.shading : vec3(0.0), 0.0));
    imageStore(uAlbedo, ivec2(pixel), vec4(hit ? albedo : vec3(0.0), 0.0));
}
