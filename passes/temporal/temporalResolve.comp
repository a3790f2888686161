// Temporal antialiasing and upscaling: mixes a frame, whose samples lie elsewhere in their pixels than the last frame's,
// into the picture so far, which is looked up where the surface of a pixel was then. After Karis, High Quality Temporal
// Supersampling (SIGGRAPH 2014).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/surface.glsl"

layout(constant_id = 123) const int UPSCALE = 1;  ///< pixels of the picture for one of the frame, each way

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uKeys;          ///< of the frame's samples
layout(set = 0, binding = 1) uniform samplerBuffer uColor;          ///< of the frame's samples
layout(set = 0, binding = 2) uniform samplerBuffer uHistory;        ///< picture so far: RGB, weight
layout(set = 0, binding = 3) uniform usamplerBuffer uPreviousKeys;  ///< of the last frame's samples
layout(set = 0, binding = 4, std430) writeonly buffer uResolved { vec4 resolved[]; };
#ifdef MOVING
layout(set = 0, binding = 6) uniform usamplerBuffer uPreviousTriangles;  ///< as uTriangles
#endif

struct TemporalFrame {
    dvec4 rowX, rowY, rowW;  // the last frame's view, samples at the pixels' centres: as RasterPush
    double depthOffset, depthSlope;
    vec2 position;     // of this frame's samples in their pixels, 0 to 1
    float mostWeight;  // of the picture so far, in samples
    uint flags;
};
const uint HAS_HISTORY = 1u, SAME_VIEW = 2u, SCENE_CHANGED = 4u;
layout(set = 0, binding = 5, std430) readonly buffer uFrame { TemporalFrame frame; };

/// Depths that differ by less are one surface's, to a pixel's size and slope.
const float SAME_DEPTH = 0.02;
/// Farther than this (pixels) is motion.
const float STILL = 1e-3;
/// Upscaling: what samples outside of the picture's pixel weigh, until there are some inside.
const float OUTSIDE = 0.03;

vec3 frameColor(ivec2 p, ivec2 size) { return texelFetch(uColor, p.y * size.x + p.x).rgb; }

/// What a sample weighs at a distance (pixels of the picture) from the middle of one of them.
float sampleWeight(vec2 d) {
    return (max(abs(d.x), abs(d.y)) <= 0.5 ? 1.0 : 0.0) + OUTSIDE * exp(-2.0 * dot(d, d));
}

vec4 cubicWeights(float t) {
    return vec4(t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2.0 - 1.5 * t)),
                t * t * (0.5 * t - 0.5));
}

/// The picture so far at pixel coordinates: Catmull and Rom's cubics, which keep it sharp over many frames.
vec3 historyColor(vec2 at, ivec2 size) {
    vec2 grid = at - 0.5;
    ivec2 base = ivec2(floor(grid));
    vec4 wx = cubicWeights(grid.x - float(base.x)), wy = cubicWeights(grid.y - float(base.y));
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 16; ++k) {
        ivec2 texel = clamp(base + ivec2(k & 3, k >> 2) - 1, ivec2(0), size - 1);
        sum += wx[k & 3] * wy[k >> 2] * texelFetch(uHistory, texel.y * size.x + texel.x).rgb;
    }
    return sum;
}

/// Where in the last frame (its pixels) the surface of a key was, and its depth there; 0: where nothing is. The sample's
/// place itself where there is no telling.
vec2 previousPlace(ivec2 pixel, uvec2 key, out float depth) {
    bool hit = (key.x | key.y) != 0u;
    int slot = hit ? int(~key.x) : 0;
    Triangle source = fetchTriangle(slot);
    Surface surface = surfaceAt(source, pixel);
    dvec3 eye = dvec3(push.rowX.w, push.rowY.w, push.rowW.w),
          previousEye = dvec3(frame.rowX.w, frame.rowY.w, frame.rowW.w);
#ifdef MOVING
    dvec3 v0 = dvec3(uintBitsToFloat(texelFetch(uPreviousTriangles, 3 * slot).xyz)),
          v1 = dvec3(uintBitsToFloat(texelFetch(uPreviousTriangles, 3 * slot + 1).xyz)),
          v2 = dvec3(uintBitsToFloat(texelFetch(uPreviousTriangles, 3 * slot + 2).xyz));
    dvec3 point = double(surface.b.x) * v0 + double(surface.b.y) * v1 + double(surface.b.z) * v2 - previousEye;
#else
    dvec3 point = dvec3(surface.position) + (eye - previousEye);
#endif
    // What is infinitely far moves as its direction.
    dvec3 d = hit ? point : dvec3(pixelDirection(pixel));
    double x = dot(frame.rowX.xyz, d), y = dot(frame.rowY.xyz, d), v = dot(frame.rowW.xyz, d);
    vec2 here = vec2(pixel) + frame.position, place = here;
    if (ORTHOGRAPHIC) {
        place = hit ? vec2(dvec2(x, y) + 0.5LF * dvec2(imageSizePixels())) : here;
        depth = hit ? float(frame.depthOffset + frame.depthSlope * v) : 0.0;
    } else {
        place = v > 0.0LF ? vec2(dvec2(x, y) / v) : vec2(-1.0);
        depth = hit ? float(frame.depthOffset / v) : 0.0;
    }
    return place;
}

void main() {
    ivec2 size = imageSizePixels(), pictureSize = size * UPSCALE, p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= pictureSize.x || p.y >= pictureSize.y) return;
    ivec2 own = p / UPSCALE;
    vec2 centre = (vec2(p) + 0.5) / float(UPSCALE);

    // This frame: its colour here, the range of colours around, and the nearest surface around, with which an edge
    // moves.
    vec3 sum = vec3(0.0), least = vec3(1e38), most = vec3(-1e38);
    float weight = 0.0;
    ivec2 nearest = own;
    uvec2 nearestKey = texelFetch(uKeys, own.y * size.x + own.x).xy;
    for (int k = 0; k < 9; ++k) {
        ivec2 offset = ivec2(k % 3, k / 3) - 1, at = own + offset, inside = clamp(at, ivec2(0), size - 1);
        vec3 color = frameColor(inside, size);
        least = min(least, color);
        most = max(most, color);
        float w = UPSCALE == 1 ? (k == 4 ? 1.0 : 0.0)
                               : sampleWeight((vec2(at) + frame.position - centre) * float(UPSCALE));
        w = at == inside ? w : 0.0;
        sum += w * color;
        weight += w;
        uvec2 key = texelFetch(uKeys, inside.y * size.x + inside.x).xy;
        bool isNearer = key.y > nearestKey.y;
        nearest = isNearer ? inside : nearest;
        nearestKey = isNearer ? key : nearestKey;
    }
    vec3 current = UPSCALE == 1 ? frameColor(own, size) : clamp(sum / weight, least, most);

    float depth;
    vec2 motion = vec2(nearest) + frame.position - previousPlace(nearest, nearestKey, depth);
    bool still = (frame.flags & SAME_VIEW) != 0u;
#ifdef MOVING
    still = still && max(abs(motion.x), abs(motion.y)) < STILL;
#endif
    vec2 from = still ? centre : centre - motion;
    bool known = all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, vec2(size)));
    // Whether that surface was seen there.
    bool seen = still;
    ivec2 about = ivec2(floor(from));
    for (int k = 0; k < 9; ++k) {
        ivec2 at = clamp(about + ivec2(k % 3, k / 3) - 1, ivec2(0), size - 1);
        float other = uintBitsToFloat(texelFetch(uPreviousKeys, at.y * size.x + at.x).y);
        seen = seen || abs(other - depth) <= SAME_DEPTH * depth;
    }
    bool usable = known && seen && (frame.flags & HAS_HISTORY) != 0u;
    vec2 historyAt = from * float(UPSCALE);
    ivec2 texel = clamp(still ? p : ivec2(floor(historyAt)), ivec2(0), pictureSize - 1);
    vec4 there = texelFetch(uHistory, texel.y * pictureSize.x + texel.x);
    float past = usable ? there.w : 0.0;
    vec3 history = still ? there.rgb : historyColor(historyAt, pictureSize);
    // What stands still keeps all that it has gathered; what moves, or may be lit anew, is held to the colours around.
    bool isHeld = !still || (frame.flags & SCENE_CHANGED) != 0u;
    history = isHeld ? clamp(history, least, most) : history;
    vec3 mixed = history + (current - history) * (weight / (past + weight));
    resolved[p.y * pictureSize.x + p.x] = vec4(past > 0.0 ? mixed : current, min(past + weight, frame.mostWeight));
}
