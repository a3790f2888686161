#ifndef HELIOGRAPH_SCENE_TEXTURES
#define HELIOGRAPH_SCENE_TEXTURES
/** @file
 * Textures of any number and size in texel buffers, filtered here: 8-bit texels are decoded from sRGB before
 * they are filtered, weights are full floats. Base level only.
 */
#include "shaders/scene/features.glsl"

layout(set = 0, binding = 27) uniform usamplerBuffer uTextures;     ///< offset, width, height, flags
layout(set = 0, binding = 28) uniform usamplerBuffer uTexels8;      ///< R32UI words, R in the low byte, sRGB-encoded colour
layout(set = 0, binding = 29) uniform samplerBuffer uTexelsFloat;   ///< linear

const uint TEXTURE_NEAREST = 1u << 4;
const uint TEXTURE_FLOAT = 1u << 5;
const uint TEXTURE_LINEAR = 1u << 7;   ///< 8-bit texels hold data, which is not sRGB-encoded
const uint TEXTURE_MIPMAPS = 1u << 6;  ///< the rasterizer filters it over mip levels
const uint TEXTURE_NORMALS = 1u << 8;  ///< of unit vectors (v + 1) / 2: its levels are means of these, so that they are shorter where they vary

/** x^2.4 for 0 <= x <= 1 by powers of square roots: 2.4 = 2 + 0.4, and x^0.4 = (x^2)^(1/5) by Newton's
 * method from a quadratic guess in x^(1/4). Relative error below 3e-7, none at 0 and 1. */
vec3 power24(vec3 x) {
    const vec3 root = sqrt(x);
    // y^5 = x^2; the guess is within 3 % on [0.05, 1], which is where the power branch of sRGB is used.
    const vec3 quarter = sqrt(root);
    vec3 y = quarter * (0.322 + quarter * (0.976 - 0.298 * quarter));
    const vec3 squared = x * x;
    for (int i = 0; i < 3; ++i) {
        const vec3 y2 = y * y;
        y = 0.8 * y + 0.2 * squared / max(y2 * y2, vec3(1e-12));
    }
    return squared * y;
}

/** Exact sRGB curve (IEC 61966-2-1) for 0..1. */
vec3 decodeSrgb(vec3 c) {
    const vec3 curve = power24((c + 0.055) * (1.0 / 1.055));
    return mix(c * (1.0 / 12.92), curve, greaterThan(c, vec3(0.04045)));
}

/** Index wrapped into 0..size-1. Modes: 0 repeat, 1 mirrored repeat, 2 clamp to edge. */
int wrapIndex(int i, int size, uint mode) {
    if (mode == 2u) return clamp(i, 0, size - 1);
    const int period = mode == 1u ? 2 * size : size;
    // GLSL leaves the sign of % open for negative operands: bring it into range with a floor.
    int r = i - period * int(floor(float(i) / float(period)));
    r += r < 0 ? period : 0;
    r -= r >= period ? period : 0;
    return mode == 1u && r >= size ? period - 1 - r : r;
}

vec4 fetchTexel(uvec4 header, int x, int y) {
    const int index = int(header.x) + y * int(header.y) + x;
    vec4 value = vec4(0.0);
    if (!HAS_FLOAT_TEXTURES || (header.w & TEXTURE_FLOAT) == 0u) {
        const vec4 encoded = unpackUnorm4x8(texelFetch(uTexels8, index).x);
        value = vec4(decodeSrgb(encoded.rgb), encoded.a);
        if (HAS_LINEAR_TEXTURES && (header.w & TEXTURE_LINEAR) != 0u) value = encoded;
    }
    if (HAS_FLOAT_TEXTURES && (header.w & TEXTURE_FLOAT) != 0u) value = texelFetch(uTexelsFloat, index);
    return value;
}

/** Linear colour of a texture at (u, v), (0, 0) the upper left corner of the first texel. */
vec4 sampleTexture(int texture, vec2 uv) {
    const uvec4 header = texelFetch(uTextures, texture);
    const ivec2 size = ivec2(header.yz);
    const uint wrapU = header.w & 3u, wrapV = header.w >> 2 & 3u;
    const bool nearest = (header.w & TEXTURE_NEAREST) != 0u;
    // Beyond 2^20 repeats a float has no texel left to tell apart, and int(...) must not overflow.
    const vec2 position = clamp(uv, -1048576.0, 1048576.0);
    // Repeats are taken out before scaling, which keeps the fraction's bits.
    const vec2 whole = floor(position * 0.5) * 2.0;
    const vec2 base = vec2(wrapU == 2u ? position.x : position.x - whole.x,
                           wrapV == 2u ? position.y : position.y - whole.y);
    const vec2 texel = clamp(base, -4.0, 4.0) * vec2(size) - (nearest ? 0.0 : 0.5);
    const vec2 corner = floor(texel);
    const ivec2 i = ivec2(corner);
    const int x0 = wrapIndex(i.x, size.x, wrapU), y0 = wrapIndex(i.y, size.y, wrapV);
    const vec4 c00 = fetchTexel(header, x0, y0);
    const int x1 = wrapIndex(i.x + 1, size.x, wrapU), y1 = wrapIndex(i.y + 1, size.y, wrapV);
    const vec2 f = nearest ? vec2(0.0) : texel - corner;
    const vec4 c10 = fetchTexel(header, x1, y0), c01 = fetchTexel(header, x0, y1), c11 = fetchTexel(header, x1, y1);
    return mix(mix(c00, c10, f.x), mix(c01, c11, f.x), f.y);
}
#endif
