#ifndef HELIOGRAPH_PATHTRACE_CAMERA
#define HELIOGRAPH_PATHTRACE_CAMERA
/** @file Camera rays: the inverse of the rasterizer's projection. Pixel (0, 0) is the upper left one, its
 * centre at (0.5, 0.5). */
#include "shaders/dispatch.glsl"

/** See CameraFrame in passes/pathtrace/camera_frame.hpp. */
struct CameraFrame {
    vec4 origin;
    vec4 right;    ///< from the middle of the image to its right edge, at distance 1 along `forward`
    vec4 up;       ///< to its upper edge
    vec4 forward;  ///< unit
};

layout(constant_id = 2) const bool ORTHOGRAPHIC = false;

/** Ray through a point of the image, in pixels; the direction is unit. */
void cameraRay(CameraFrame camera, vec2 point, uvec2 size, out vec3 origin, out vec3 direction) {
    const float x = point.x / float(size.x) * 2.0 - 1.0;
    const float y = 1.0 - point.y / float(size.y) * 2.0;
    const vec3 across = camera.right.xyz * x + camera.up.xyz * y;
    origin = ORTHOGRAPHIC ? camera.origin.xyz + across : camera.origin.xyz;
    direction = ORTHOGRAPHIC ? camera.forward.xyz : normalize(camera.forward.xyz + across);
}

/** Pixel of this invocation in workgroups of 64: 8 x 8 tiles of 4 x 2 blocks, so that lanes of a group of 8
 * are neighbours. May lie outside of the image. */
uvec2 tilePixel(uvec2 size) {
    const uint group = interleavedGroup(), lane = gl_LocalInvocationIndex;
    const uint columns = (size.x + 7u) >> 3;
    const uvec2 tile = uvec2(group % columns, group / columns) * 8u;
    return tile + uvec2((lane & 3u) + ((lane >> 3) & 1u) * 4u, ((lane >> 2) & 1u) + (lane >> 4) * 2u);
}
#endif
