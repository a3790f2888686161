// Where the mip levels of each texture lie. Level 0 is the texture itself (shaders/scene/textures.glsl); level k has
// max(1, floor(size / 2^k)) texels, linear RGBA in full floats, rows from the top.
#ifndef SHADERS_TEXTURE_MIP_TABLE_GLSL
#define SHADERS_TEXTURE_MIP_TABLE_GLSL

/**
 * First one texel a texture: place of its level 1 in this table, number of levels (the base counted, 1 where it has
 * no mips), and of a ripmap the place of its level (0, 0) and how many there are along x (0: none). Then one texel a
 * level: offset of its first texel in uMips, width, height, 0; of a ripmap's (0, 0), the base, all 0.
 */
layout(set = 0, binding = 30) uniform usamplerBuffer uMipTable;

struct MipChain {
    int table;
    int levels;
};

MipChain fetchMipChain(int texture) {
    uvec4 chain = texelFetch(uMipTable, texture);
    return MipChain(int(chain.x), int(chain.y));
}

/// Offset, width and height of a level from 1.
ivec3 fetchMipLevel(MipChain chain, int level) { return ivec3(texelFetch(uMipTable, chain.table + level - 1).xyz); }

#endif
