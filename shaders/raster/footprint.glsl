// Textures of a material over what a pixel sees of a triangle.
#ifndef SHADERS_RASTER_FOOTPRINT_GLSL
#define SHADERS_RASTER_FOOTPRINT_GLSL

#include "shaders/raster/surface.glsl"
#include "shaders/scene/materials.glsl"
#include "shaders/texture/filters.glsl"

/// Both slots of texture coordinates at a pixel's centre, and their derivatives over the screen.
void footprint(int g, Surface surface, out vec4 uv, out vec4 dx, out vec4 dy) {
    vec4 uv0 = texelFetch(uTexcoords, g * 3), e1 = texelFetch(uTexcoords, g * 3 + 1) - uv0,
         e2 = texelFetch(uTexcoords, g * 3 + 2) - uv0;
    uv = uv0 + surface.b.y * e1 + surface.b.z * e2;
    dx = surface.db1.x * e1 + surface.db2.x * e2;
    dy = surface.db1.y * e1 + surface.db2.y * e2;
}

/// A material's texture at `row` (3, 5, or a normal map's) over the pixel's footprint; white where there is none.
vec4 filteredMaterialTexture(int material, int row, vec4 uv, vec4 dx, vec4 dy) {
    uvec4 first = texelFetch(uMaterials, material * MATERIAL_TEXELS + row);
    uvec4 second = texelFetch(uMaterials, material * MATERIAL_TEXELS + row + 1);
    bool set0 = second.w == 0u;
    vec3 u = uintBitsToFloat(first.xyz), v = uintBitsToFloat(second.xyz);
    vec3 p = vec3(set0 ? uv.xy : uv.zw, 1.0);
    vec2 px = set0 ? dx.xy : dx.zw, py = set0 ? dy.xy : dy.zw;
    vec2 at = vec2(dot(u, p), dot(v, p));
    vec2 atX = vec2(dot(u.xy, px), dot(v.xy, px)), atY = vec2(dot(u.xy, py), dot(v.xy, py));
    vec4 value = vec4(1.0);
    if (int(first.w) >= 0)
        value = sampleFiltered(int(first.w), at, atX, atY);
    return value;
}

#ifdef FOOTPRINT_NORMALS
const bool HAS_FOOTPRINT_NORMALS = true;
/// Derivatives over the pixel at hand of both slots of texture coordinates: set before a material is looked up.
vec4 pixelX = vec4(0.0), pixelY = vec4(0.0);
/// How much the normals of the surface's and of the coat's map vary within the pixel: variance of a slope.
vec2 mapVariance = vec2(0.0);

/// Mean of a normal map's vectors (not unit) over the pixel. Normals whose slopes vary by s^2 each way have a mean of
/// length about 1 - s^2, of which Toksvig ("Mipmapping normal maps", 2005) makes s^2 = (1 - l) / l. Within a texel, where
/// only the bilinear filter shortens vectors, nothing varies.
vec3 footprintNormal(int material, int row, vec4 uv, float scale) {
    uvec4 first = texelFetch(uMaterials, material * MATERIAL_TEXELS + row);
    vec3 n = filteredMaterialTexture(material, row, uv, pixelX, pixelY).xyz * 2.0 - 1.0;
    float variance = 0.0;
    if (int(first.w) >= 0) {
        bool set0 = texelFetch(uMaterials, material * MATERIAL_TEXELS + row + 1).w == 0u;
        vec2 u = uintBitsToFloat(first.xy), v = uintBitsToFloat(texelFetch(uMaterials, material * MATERIAL_TEXELS + row + 1).xy);
        vec2 px = set0 ? pixelX.xy : pixelX.zw, py = set0 ? pixelY.xy : pixelY.zw;
        int texture = int(first.w);
        float level = mipLevel(vec2(texelFetch(uTextures, texture).yz), vec2(dot(u, px), dot(v, px)), vec2(dot(u, py), dot(v, py)));
        float length_ = clamp(length(n), 1e-3, 1.0);
        if (fetchMipChain(texture).levels > 1) variance = min(level, 1.0) * (1.0 - length_) / length_ * scale * scale;
    }
    // The rows of shaders/scene/surface_material.glsl: 16 the surface's map, 28 the coat's.
    if (row == 16) mapVariance.x = variance;
    else mapVariance.y = variance;
    return n;
}
#else
const bool HAS_FOOTPRINT_NORMALS = false;
#endif

#endif
