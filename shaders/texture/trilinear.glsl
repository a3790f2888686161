// Trilinear filtering in full floats from the packed textures and their mip levels.
#ifndef SHADERS_TEXTURE_TRILINEAR_GLSL
#define SHADERS_TEXTURE_TRILINEAR_GLSL

#include "shaders/scene/textures.glsl"
#include "shaders/shared/exponential.glsl"
#include "shaders/texture/mip_table.glsl"

layout(set = 0, binding = 31) uniform samplerBuffer uMips;  ///< linear RGBA of all levels from 1

/// Level of detail from the derivatives of (u, v) over one pixel each way, for a base of so many texels: log2 of the
/// longer footprint in texels (lecture 9), at least 0.
float mipLevel(vec2 size, vec2 dx, vec2 dy) {
    vec2 tx = dx * size, ty = dy * size;
    float squared = max(dot(tx, tx), dot(ty, ty));
    // Infinite derivatives end at the last level; NaN compares false and takes the base.
    return squared > 1.0 ? 0.5 * realLog2(min(squared, 1e38)) : 0.0;
}

/// Bilinear value of one level. `offset` is the level's place in uMips, negative for the base.
vec4 sampleMipLevel(uvec4 header, int offset, ivec2 size, vec2 uv) {
    uint wrapU = header.w & 3u, wrapV = header.w >> 2 & 3u;
    // As in sampleTexture: even repeats are taken out before scaling, which keeps the fraction's bits.
    vec2 position = clamp(uv, -1048576.0, 1048576.0);
    vec2 whole = floor(position * 0.5) * 2.0;
    vec2 base = vec2(wrapU == 2u ? position.x : position.x - whole.x, wrapV == 2u ? position.y : position.y - whole.y);
    vec2 texel = clamp(base, -4.0, 4.0) * vec2(size) - 0.5;
    vec2 corner = floor(texel);
    ivec2 i = ivec2(corner);
    vec2 f = texel - corner;
    int x0 = wrapIndex(i.x, size.x, wrapU), y0 = wrapIndex(i.y, size.y, wrapV);
    int x1 = wrapIndex(i.x + 1, size.x, wrapU), y1 = wrapIndex(i.y + 1, size.y, wrapV);
    vec4 c00 = vec4(0.0), c10 = vec4(0.0), c01 = vec4(0.0), c11 = vec4(0.0);
    if (offset < 0) {
        c00 = fetchTexel(header, x0, y0);
        c10 = fetchTexel(header, x1, y0);
        c01 = fetchTexel(header, x0, y1);
        c11 = fetchTexel(header, x1, y1);
    } else {
        c00 = texelFetch(uMips, offset + y0 * size.x + x0);
        c10 = texelFetch(uMips, offset + y0 * size.x + x1);
        c01 = texelFetch(uMips, offset + y1 * size.x + x0);
        c11 = texelFetch(uMips, offset + y1 * size.x + x1);
    }
    return mix(mix(c00, c10, f.x), mix(c01, c11, f.x), f.y);
}

/// Linear colour at (u, v) whose derivatives over one pixel are dx and dy. Magnified NEAREST textures stay nearest.
vec4 sampleTrilinear(int texture, vec2 uv, vec2 dx, vec2 dy) {
    uvec4 header = texelFetch(uTextures, texture);
    ivec2 size = ivec2(header.yz);
    MipChain chain = fetchMipChain(texture);
    float level = clamp(mipLevel(vec2(size), dx, dy), 0.0, float(chain.levels - 1));
    if (level == 0.0) return sampleTexture(texture, uv);
    int fine = int(level);
    float f = level - float(fine);
    int coarse = min(fine + 1, chain.levels - 1);
    ivec3 a = fine == 0 ? ivec3(-1, size) : fetchMipLevel(chain, fine);
    ivec3 b = fetchMipLevel(chain, coarse);
    return mix(sampleMipLevel(header, a.x, a.yz, uv), sampleMipLevel(header, b.x, b.yz, uv), f);
}

#endif
