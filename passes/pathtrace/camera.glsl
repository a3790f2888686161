#ifndef HELIOGRAPH_PATHTRACE_CAMERA
#define HELIOGRAPH_PATHTRACE_CAMERA
/** @file Camera rays: the inverse of the rasterizer's projection. Pixel (0, 0) is the upper left one, its
 * centre at (0.5, 0.5). Cameras that are more than a pinhole or parallel rays are compiled with CAMERA_TABLE. */
#include "shaders/dispatch.glsl"

/** See CameraFrame in passes/pathtrace/camera_frame.hpp. */
struct CameraFrame {
    vec4 origin;
    vec4 right;    ///< from the middle of the image to its right edge, at distance 1 along `forward`
    vec4 up;       ///< to its upper edge
    vec4 forward;  ///< unit
};

layout(constant_id = 2) const bool ORTHOGRAPHIC = false;

#ifdef CAMERA_TABLE
#include "shaders/shared/lens.glsl"

const uint PROJECTION_PLANE = 0u;  // the values of helio::Projection
const uint PROJECTION_LAT_LONG = 1u;
const uint PROJECTION_EQUIDISTANT = 2u;
const uint PROJECTION_EQUISOLID = 3u;
layout(constant_id = 10) const uint PROJECTION = PROJECTION_PLANE;
layout(constant_id = 11) const bool HAS_LENS = false;
layout(constant_id = 12) const int BLADES = 0;

/** Texels of CameraTable in passes/pathtrace/camera_frame.hpp. */
layout(set = 0, binding = 38) uniform samplerBuffer uCamera;

/** Where on the lens a ray begins, for a uniform pair: in the unit disc. */
vec2 lensPoint(vec2 u) {
    return HAS_LENS ? apertureSample(u, BLADES, texelFetch(uCamera, 0).w) : vec2(0.0);
}

/** Direction of a panorama or fisheye; the axes are unit. False beyond a fisheye's image circle. */
bool wideDirection(CameraFrame camera, vec2 point, vec2 size, out vec3 direction) {
    if (PROJECTION == PROJECTION_LAT_LONG) {
        // Filters reach over the poles and round the seam: angles simply go on.
        float sinLongitude, cosLongitude, sinPolar, cosPolar;
        sinCosTurns(point.x / size.x - 0.5, sinLongitude, cosLongitude);
        sinCosTurns(point.y / size.y * 0.5, sinPolar, cosPolar);
        direction = camera.up.xyz * cosPolar +
                    (camera.right.xyz * sinLongitude + camera.forward.xyz * cosLongitude) * sinPolar;
        return true;
    }
    const vec4 field = texelFetch(uCamera, 1);
    const vec2 p = (2.0 * point - size) * vec2(1.0, -1.0) / min(size.x, size.y);
    const float r = length(p);
    float perRadius, cosine;  // sine of the angle from the axis over r
    if (PROJECTION == PROJECTION_EQUIDISTANT) {
        float sine;
        sinCosTurns(r * field.x, sine, cosine);
        perRadius = r > 1e-6 ? sine / r : field.x * 6.283185307179586;
    } else {
        const float half_ = min(r * field.y, 1.0);  // sine of half the angle
        perRadius = 2.0 * field.y * sqrt((1.0 - half_) * (1.0 + half_));
        cosine = 1.0 - 2.0 * half_ * half_;
    }
    direction = camera.forward.xyz * cosine + (camera.right.xyz * p.x + camera.up.xyz * p.y) * perRadius;
    return r <= 1.0;
}
#else
const bool HAS_LENS = false;
#endif

/** Ray through a point of the image, in pixels, and of the lens, in the unit disc; the direction is unit. Returns what
 * of its light counts: 1, or 0 where the camera sees nothing. */
float cameraRay(CameraFrame camera, vec2 point, uvec2 size, vec2 lens, out vec3 origin, out vec3 direction) {
    const float x = point.x / float(size.x) * 2.0 - 1.0;
    const float y = 1.0 - point.y / float(size.y) * 2.0;
    const vec3 across = camera.right.xyz * x + camera.up.xyz * y;
#ifdef CAMERA_TABLE
    if (PROJECTION != PROJECTION_PLANE) {
        origin = camera.origin.xyz;
        const bool seen = wideDirection(camera, point, vec2(size), direction);
        direction = normalize(direction);
        return seen ? 1.0 : 0.0;
    }
    if (HAS_LENS) {
        // All rays of a point of the image meet at its point of the sharp plane.
        const vec4 table = texelFetch(uCamera, 0);
        const vec3 offset = camera.right.xyz * (lens.x * table.x) + camera.up.xyz * (lens.y * table.y);
        origin = camera.origin.xyz + offset;
        direction = normalize(camera.forward.xyz + across - offset * table.z);
        return 1.0;
    }
#endif
    origin = ORTHOGRAPHIC ? camera.origin.xyz + across : camera.origin.xyz;
    direction = ORTHOGRAPHIC ? camera.forward.xyz : normalize(camera.forward.xyz + across);
    return 1.0;
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
