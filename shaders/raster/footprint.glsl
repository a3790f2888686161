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

/// A material's texture at `row` (3 or 5) over the pixel's footprint; white where there is none.
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

#endif
