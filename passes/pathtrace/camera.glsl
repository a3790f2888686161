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
#include "shaders/shared/lens_system.glsl"

const uint PROJECTION_PLANE = 0u;  // the values of helio::Projection
const uint PROJECTION_LAT_LONG = 1u;
const uint PROJECTION_EQUIDISTANT = 2u;
const uint PROJECTION_EQUISOLID = 3u;
layout(constant_id = 10) const uint PROJECTION = PROJECTION_PLANE;
layout(constant_id = 11) const bool HAS_LENS = false;
layout(constant_id = 12) const int BLADES = 0;
layout(constant_id = 15) const int LENS_SURFACES = 0;  ///< of a lens table
layout(constant_id = 16) const int LENS_BASE = 0;      ///< where it begins in uCamera
const int PUPIL_RINGS = 32;
layout(constant_id = 13) const bool HAS_TIME = false;  ///< something moves while the shutter is open
layout(constant_id = 14) const int CAMERA_KEYS = 0;    ///< places of a camera that moves; 0 or 2 and more

/** Texels of CameraTable in passes/pathtrace/camera_frame.hpp. */
layout(set = 0, binding = 38) uniform samplerBuffer uCamera;

/** Where on the lens a ray begins, for a uniform pair: in the unit disc; of a lens table in the square about its
 * exit pupil. */
vec2 lensPoint(vec2 u) {
    if (LENS_SURFACES > 0) return 2.0 * u - 1.0;
    return HAS_LENS ? apertureSample(u, BLADES, texelFetch(uCamera, 0).w) : vec2(0.0);
}

/** Time of a ray through a row of the image, 0 to 1 over what is rendered, for a uniform number. */
float rayTime(uint row, uint rows, float u) {
    const vec2 shutter = texelFetch(uCamera, 2).xy;
    return (float(row) + 0.5) / float(rows) * shutter.x + u * shutter.y;
}

/** The camera at that time: keys are so close that straight lines between them, brought back to their lengths, are
 * its turns. */
CameraFrame movedCamera(CameraFrame camera, float time) {
    if (CAMERA_KEYS == 0) return camera;
    const float place = clamp(time, 0.0, 1.0) * float(CAMERA_KEYS - 1);
    const int key = min(int(place), CAMERA_KEYS - 2);
    const float s = place - float(key);
    vec4 rows[4];
    for (int i = 0; i < 4; ++i)
        rows[i] = texelFetch(uCamera, 3 + key * 4 + i) * (1.0 - s) + texelFetch(uCamera, 7 + key * 4 + i) * s;
    camera.origin = rows[0];
    camera.right = vec4(normalize(rows[1].xyz) * rows[1].w, 0.0);
    camera.up = vec4(normalize(rows[2].xyz) * rows[2].w, 0.0);
    camera.forward = vec4(normalize(rows[3].xyz), 0.0);
    return camera;
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
/** A ray from the film through the lens table, in the camera's frame and the table's units; x and y of the image from
 * -1 to 1. Returns what its light counts: cos^4 of its angle on the film and the pupil's area, over that of an ideal
 * lens of the same f-number. */
float lensTableRay(vec2 image, vec2 lens, out vec3 origin, out vec3 direction) {
    const vec4 film = texelFetch(uCamera, LENS_BASE), worth = texelFetch(uCamera, LENS_BASE + 1);
    origin = vec3(-image * film.xy, film.z);
    const float r = length(origin.xy);
    const int ring = min(int(r * worth.y), PUPIL_RINGS - 1);
    const vec4 pupil = texelFetch(uCamera, LENS_BASE + 2 + ring);
    // The pupil was found for a point on the x axis.
    const vec2 towards = r > 0.0 ? origin.xy / r : vec2(1.0, 0.0);
    const vec2 p = vec2(mix(pupil.x, pupil.y, 0.5 + 0.5 * lens.x), pupil.z * lens.y);
    const vec3 target = vec3(towards * p.x + vec2(-towards.y, towards.x) * p.y, film.w);
    direction = normalize(target - origin);
    const float cosine = direction.z * direction.z;
    float weight = max(pupil.y - pupil.x, 0.0) * 2.0 * pupil.z * worth.z * cosine * cosine;
    [[dont_unroll]] for (int i = 0; i < LENS_SURFACES; ++i)
        if (!crossLensSurface(texelFetch(uCamera, LENS_BASE + 2 + PUPIL_RINGS + i), origin, direction)) weight = 0.0;
    origin *= worth.x;
    return weight;
}
#else
const bool HAS_LENS = false;
const int LENS_SURFACES = 0;
const bool HAS_TIME = false;
const int CAMERA_KEYS = 0;
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
    if (LENS_SURFACES > 0) {
        vec3 from, along;
        const float weight = lensTableRay(vec2(x, y), lens, from, along);
        origin = camera.origin.xyz + camera.right.xyz * from.x + camera.up.xyz * from.y + camera.forward.xyz * from.z;
        direction = normalize(camera.right.xyz * along.x + camera.up.xyz * along.y + camera.forward.xyz * along.z);
        return weight;
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
