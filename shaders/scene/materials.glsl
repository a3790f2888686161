#ifndef HELIOGRAPH_SCENE_MATERIALS
#define HELIOGRAPH_SCENE_MATERIALS
/** @file Materials: 49 texels each (kMaterialTexels). Base colour and emission are read here, the rest, where the
 * scene has more than diffuse surfaces, in shaders/scene/surface_material.glsl. */
#include "shaders/scene/attributes.glsl"
#include "shaders/scene/features.glsl"
#include "shaders/scene/textures.glsl"

/**
 * 0: base colour RGBA
 * 1: emission RGB (W/(sr m^2)), bits of flags
 * 2: light sampling density per area (1/m^2), metallic, roughness, alpha cutoff
 * 3, 4: base colour texture: rows of its transform, bits of texture index | bits of slot of texture coordinates
 * 5, 6: the same of the emissive texture
 * 13: z: strength of the occlusion texture; 47, 48: that texture, of which red is read, or the lightmap, in the raster
 * pipeline alone
 * 45: first colour of the solid texture, bits of its pattern (0: none); 46: second colour, features a unit
 */
layout(set = 0, binding = 25) uniform usamplerBuffer uMaterials;
const int MATERIAL_TEXELS = 49;
const uint MATERIAL_DOUBLE_SIDED = 1u << 0;
const uint MATERIAL_MASK = 1u << 1;           ///< opaque where alpha is at least the cutoff
const uint MATERIAL_BLEND = 1u << 2;          ///< opaque with the chance alpha
const uint MATERIAL_UNLIT = 1u << 3;          ///< shows its base colour, whatever the light
const uint MATERIAL_THIN = 1u << 4;           ///< no volume behind the surface
const uint MATERIAL_TURNED_FACETS = 1u << 5;  ///< widths along tangent and bitangent differ
const uint MATERIAL_BECKMANN = 1u << 6;
const uint MATERIAL_SCHLICK = 1u << 7;
const uint MATERIAL_COMPENSATED = 1u << 8;    ///< light of several reflections between facets is added
const uint MATERIAL_LIGHTMAP = 1u << 9;       ///< 47 is the texture of the irradiance on its front
const uint MATERIAL_MODEL_SHIFT = 16u;        ///< Scattering::Model + 1; 0: glTF's

/** Texel of a material's texture use at `row` (3 or 5): the texture's colour, white where there is none. */
vec4 materialTexture(int material, int row, vec4 uv) {
    const uvec4 first = texelFetch(uMaterials, material * MATERIAL_TEXELS + row);
    const uvec4 second = texelFetch(uMaterials, material * MATERIAL_TEXELS + row + 1);
    const vec3 p = vec3(second.w == 0u ? uv.xy : uv.zw, 1.0);
    const vec2 transformed = vec2(dot(uintBitsToFloat(first.xyz), p), dot(uintBitsToFloat(second.xyz), p));
    vec4 value = vec4(1.0);
    if (int(first.w) >= 0) value = sampleTexture(int(first.w), transformed);
    return value;
}

#ifdef SOLID_TEXTURES
/** 256 texels: the noise's permutation at i, at i + 1; then corners' places in their mesh, 3 texels a triangle. */
layout(set = 0, binding = 49) uniform samplerBuffer uSolidPoints;
const int SOLID_HEADER = 256;
#define NOISE_PAIR(i) ivec2(texelFetch(uSolidPoints, i).xy)
#include "shaders/texture/noise.glsl"

/** Colour of a material's solid texture, white where it has none. `derivatives` of the second and the third barycentric,
 * each along x and y, over a pixel; 0 where samples are points. */
vec3 solidColor(int material, int g, vec3 b, vec4 derivatives) {
    const uvec4 first = texelFetch(uMaterials, material * MATERIAL_TEXELS + 45);
    const vec4 second = uintBitsToFloat(texelFetch(uMaterials, material * MATERIAL_TEXELS + 46));
    if (first.w == 0u) return vec3(1.0);
    const int at = SOLID_HEADER + g * 3;
    const vec3 p0 = texelFetch(uSolidPoints, at).xyz, e1 = texelFetch(uSolidPoints, at + 1).xyz - p0,
               e2 = texelFetch(uSolidPoints, at + 2).xyz - p0;
    const vec3 dx = derivatives.x * e1 + derivatives.z * e2, dy = derivatives.y * e1 + derivatives.w * e2;
    const float width = abs(second.w) * sqrt(max(dot(dx, dx), dot(dy, dy)));
    const vec3 p = second.w * (p0 + b.y * e1 + b.z * e2);
    return mix(uintBitsToFloat(first.xyz), second.rgb, solidPattern(int(first.w), p, width));
}
#endif

/** Linear base colour: factor times texture times vertex colour. `b`: barycentrics in triangle g. */
vec4 baseColor(int material, int g, vec3 b) {
    vec4 color = uintBitsToFloat(texelFetch(uMaterials, material * MATERIAL_TEXELS)) * vertexColor(g, b);
    if (HAS_BASE_TEXTURES) color *= materialTexture(material, 3, texcoords(g, b));
#ifdef SOLID_TEXTURES
    color.rgb *= solidColor(material, g, b, vec4(0.0));
#endif
    return color;
}

struct Emission {
    vec3 radiance;        ///< of a face that emits
    bool doubleSided;     ///< the back face emits too
    float areaDensity;    ///< chance density per area that light sampling chooses a point of this material
};

Emission emission(int material, int g, vec3 b) {
    const uvec4 row = texelFetch(uMaterials, material * MATERIAL_TEXELS + 1);
    Emission e = Emission(uintBitsToFloat(row.xyz), (row.w & MATERIAL_DOUBLE_SIDED) != 0u, 0.0);
    if (HAS_EMISSION_TEXTURES) e.radiance *= materialTexture(material, 5, texcoords(g, b)).rgb;
    if (HAS_AREA_LIGHTS) e.areaDensity = uintBitsToFloat(texelFetch(uMaterials, material * MATERIAL_TEXELS + 2).x);
    return e;
}
#endif
