// Shadow maps: which part of a punctual light a point sees.
#ifndef SHADERS_RASTER_SHADOW_GLSL
#define SHADERS_RASTER_SHADOW_GLSL

#include "shaders/raster/view.glsl"

layout(constant_id = 126) const int SHADOWS = 0;  ///< SHADOWS_*
const int SHADOWS_NONE = 0, SHADOWS_HARD = 1, SHADOWS_PCF = 2, SHADOWS_PCSS = 3, SHADOWS_VARIANCE = 4;

/**
 * One texel a light of the table: first face, number of faces (0: without a map, 1, or the 6 of a cube: +x, -x, +y, -y,
 * +z, -z). Then 6 texels a face:
 * 0, 1, 2: rowX, rowY, rowW of its view (shaders/raster/view.glsl) | bits of depthOffset, depthSlope, the map's size
 * 3: first texel in uShadowMaps, 1 where orthographic, 0, 0
 * 4, 5: eye as doubles: x, y; z, 0
 */
layout(set = 0, binding = 8) uniform usamplerBuffer uShadowFaces;
layout(set = 0, binding = 9) uniform usamplerBuffer uShadowMaps;  ///< visibility keys (complement of the id, depth)
layout(set = 0, binding = 10) uniform samplerBuffer uShadowFilter;  ///< radius in texels; light's size; LIGHT_COUNT
const int SHADOW_FACE_TEXELS = 6;

/// A receiver as a face of a map sees it: its plane's depth is affine over the map.
struct ShadowReceiver {
    vec2 at;           // texels
    float depth;       // at `at`
    vec2 slope;        // of the plane's depth, per texel
    float distance_;   // along the face's axis
    int first, size;
    uint notId;        // complement of the receiver's own triangle
    float texelsPerUnit;  // at distance 1; at any where orthographic
    bool orthographic;
    float depthOffset;
};

/// Depth of the receiver's plane less what rounding can make of it, at a texel's centre.
float receiverDepth(ShadowReceiver r, ivec2 texel) {
    vec2 d = vec2(texel) + 0.5 - r.at;
    float plane = r.depth + dot(r.slope, d);
    // Beyond the plane's horizon it has no depth of its own.
    return (plane > 0.0 ? plane : r.depth) + 1e-5 * abs(r.depth) + 0.02 * (abs(r.slope.x) + abs(r.slope.y));
}

/// Whether something stands before the receiver at a texel; `nearest` is the depth there.
bool occluded(ShadowReceiver r, ivec2 texel, out float nearest) {
    texel = clamp(texel, ivec2(0), ivec2(r.size - 1));
    uvec2 key = texelFetch(uShadowMaps, r.first + texel.y * r.size + texel.x).xy;
    nearest = uintBitsToFloat(key.y);
    // Its own triangle never shadows a point.
    return key.x != r.notId && nearest > receiverDepth(r, texel);
}

/// Lit share of a box of so many texels either way: texels by their overlap with it, exactly.
float boxLit(ShadowReceiver r, float radius) {
    int reach = int(ceil(radius));
    ivec2 centre = ivec2(floor(r.at));
    vec2 low = r.at - radius, high = r.at + radius;
    float dark = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            ivec2 texel = centre + ivec2(x, y);
            vec2 overlap = max(min(vec2(texel) + 1.0, high) - max(vec2(texel), low), 0.0);
            float nearest;
            dark += overlap.x * overlap.y * (occluded(r, texel, nearest) ? 1.0 : 0.0);
        }
    return max(1.0 - dark / (4.0 * radius * radius), 0.0);
}

/// Chebyshev's bound from mean and variance of depth over the box (Donnelly and Lauritzen 2006).
float varianceLit(ShadowReceiver r, float radius) {
    int reach = int(ceil(radius));
    ivec2 centre = ivec2(floor(r.at));
    vec2 low = r.at - radius, high = r.at + radius;
    float mean = 0.0, square = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            ivec2 texel = centre + ivec2(x, y);
            vec2 overlap = max(min(vec2(texel) + 1.0, high) - max(vec2(texel), low), 0.0);
            float nearest;
            // Over the receiver's plane, relative to its depth: nothing of a lit plane is left.
            bool isBefore = occluded(r, texel, nearest);
            float excess = isBefore ? nearest / receiverDepth(r, texel) - 1.0 : 0.0;
            float weight = overlap.x * overlap.y / (4.0 * radius * radius);
            mean += weight * excess;
            square += weight * excess * excess;
        }
    float variance = max(square - mean * mean, 0.0);
    return mean > 0.0 ? variance / (variance + mean * mean) : 1.0;
}

const int PCSS_TAPS = 8;  // each way

/// Percentage-closer soft shadows (Fernando 2005): the mean distance of what stands before the receiver gives the width
/// of the penumbra, which is then filtered.
float softLit(ShadowReceiver r, float lightSize) {
    // The cone from the receiver to the light's disc, on the map at distance 1 (directional: of its tangent).
    float search = r.orthographic ? 8.0 : max(r.texelsPerUnit * lightSize / r.distance_, 1.0);
    float blockers = 0.0, sum = 0.0;
    for (int k = 0; k < PCSS_TAPS * PCSS_TAPS; ++k) {
        vec2 tap = (vec2(k % PCSS_TAPS, k / PCSS_TAPS) + 0.5) * (2.0 / float(PCSS_TAPS)) - 1.0;
        float nearest;
        if (occluded(r, ivec2(floor(r.at + search * tap)), nearest)) {
            blockers += 1.0;
            sum += r.orthographic ? (nearest - r.depth) * r.depthOffset : r.depthOffset / nearest;
        }
    }
    float mean = sum / max(blockers, 1.0);
    // Orthographic: `mean` is the gap itself; perspective: the blockers' distance.
    float width = r.orthographic ? mean * lightSize * r.texelsPerUnit
                                 : (r.distance_ - mean) / mean * lightSize * r.texelsPerUnit / r.distance_;
    float radius = clamp(width, 1.0, 64.0), lit = 0.0;
    for (int k = 0; k < PCSS_TAPS * PCSS_TAPS; ++k) {
        vec2 tap = (vec2(k % PCSS_TAPS, k / PCSS_TAPS) + 0.5) * (2.0 / float(PCSS_TAPS)) - 1.0;
        float nearest;
        lit += occluded(r, ivec2(floor(r.at + radius * tap)), nearest) ? 0.0 : 1.0;
    }
    return blockers > 0.0 ? lit / float(PCSS_TAPS * PCSS_TAPS) : 1.0;
}

/// Part of a light of the table that a point sees. `position` is relative to the eye; `normal` is the face's.
float lightVisibility(int light, vec3 position, vec3 normal, int g) {
    uvec2 faces = texelFetch(uShadowFaces, light).xy;
    if (faces.y == 0u) return 1.0;
    vec4 filter_ = texelFetch(uShadowFilter, 0);
    int table = int(filter_.z);
    dvec3 camera = dvec3(push.rowX.w, push.rowY.w, push.rowW.w);
    int face = table + SHADOW_FACE_TEXELS * int(faces.x);
    uvec4 eyeXY = texelFetch(uShadowFaces, face + 4), eyeZ = texelFetch(uShadowFaces, face + 5);
    dvec3 eye = dvec3(packDouble2x32(eyeXY.xy), packDouble2x32(eyeXY.zw), packDouble2x32(eyeZ.xy));
    vec3 d = vec3(dvec3(position) + (camera - eye));
    if (faces.y == 6u) {
        vec3 size = abs(d);
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        float along = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
        face += SHADOW_FACE_TEXELS * (2 * axis + (along < 0.0 ? 1 : 0));
    }
    uvec4 t0 = texelFetch(uShadowFaces, face), t1 = texelFetch(uShadowFaces, face + 1),
          t2 = texelFetch(uShadowFaces, face + 2), t3 = texelFetch(uShadowFaces, face + 3);
    vec3 rowX = uintBitsToFloat(t0.xyz), rowY = uintBitsToFloat(t1.xyz), rowW = uintBitsToFloat(t2.xyz);
    float depthOffset = uintBitsToFloat(t0.w), depthSlope = uintBitsToFloat(t1.w);
    ShadowReceiver r;
    r.size = int(t2.w);
    r.first = int(t3.x);
    r.orthographic = t3.y != 0u;
    r.notId = ~uint(g);
    r.distance_ = dot(rowW, d);
    vec2 image = vec2(dot(rowX, d), dot(rowY, d));
    float half_ = 0.5 * float(r.size);
    if (r.orthographic) {
        r.at = image + half_;
        r.depth = depthOffset + depthSlope * r.distance_;
        r.texelsPerUnit = length(rowX);
        r.depthOffset = -1.0 / depthSlope;
        // The plane n.q = n.d over q = (x rowX/|rowX|^2 + y rowY/|rowY|^2 + v rowW): dv/dx = -n.rowX / (|rowX|^2 n.rowW).
        float along = dot(normal, rowW), scale = 1.0 / dot(rowX, rowX);
        r.slope = -depthSlope * scale * vec2(dot(normal, rowX), dot(normal, rowY)) / along;
    } else {
        r.at = image / r.distance_;
        r.depth = depthOffset / r.distance_;
        vec3 right = rowX - half_ * rowW, down = rowY - half_ * rowW;  // focal times unit axes
        float focal = length(right);
        r.texelsPerUnit = focal;
        r.depthOffset = depthOffset;
        // 1/w = n.(x - half, y - half, focal)/(focal n.d) on the plane, in the face's axes.
        float scale = depthOffset / (focal * focal * dot(normal, d));
        r.slope = scale * vec2(dot(normal, right), dot(normal, down));
    }
    // A plane seen edge-on has no slope, and hardly any light.
    if (!(abs(r.slope.x) + abs(r.slope.y) < 1e30)) r.slope = vec2(0.0);
    bool isInside = r.distance_ > 0.0 && all(greaterThanEqual(r.at, vec2(0.0))) && all(lessThan(r.at, vec2(r.size)));
    float lit = 1.0;
    if (SHADOWS == SHADOWS_HARD) {
        float nearest;
        lit = occluded(r, ivec2(floor(r.at)), nearest) ? 0.0 : 1.0;
    }
    if (SHADOWS == SHADOWS_PCF) lit = boxLit(r, filter_.x);
    if (SHADOWS == SHADOWS_PCSS) lit = softLit(r, filter_.y);
    if (SHADOWS == SHADOWS_VARIANCE) lit = varianceLit(r, filter_.x);
    return isInside ? lit : 1.0;
}

#endif
