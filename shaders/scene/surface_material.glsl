#ifndef HELIOGRAPH_SCENE_SURFACE_MATERIAL
#define HELIOGRAPH_SCENE_SURFACE_MATERIAL
/** @file
 * All of a material that decides how its surface scatters; only for scenes with more than diffuse surfaces.
 * Further texels of a material (shaders/scene/materials.glsl has the first seven):
 *
 * 7: specular colour, specular
 * 8: index, transmission, dispersion, scale of the normal map
 * 9: absorption of the volume behind the front face RGB (1/m), scale of the height map
 * 10: clearcoat, its roughness, scale of its normal map, anisotropy
 * 11: sheen colour, sheen roughness
 * 12: cosine and sine of the anisotropy's rotation, iridescence, index of its film
 * 13: least and largest thickness of the film (nm), of occlusion's texture, thickness of the volume
 * 14..39: textures, two texels each as for the base colour: metallic and roughness, normal, specular, specular
 *   colour, transmission, clearcoat, clearcoat roughness, clearcoat normal, sheen colour, sheen roughness,
 *   anisotropy, iridescence, iridescence thickness
 * 40, 41: in the raster pipeline, texture of the volume's thickness; or
 * 40: Scattering: n, roughness; 41: k, exponent; 42: alpha, first texel of its table of losses, 0
 * 43, 44: texture of heights
 *
 * Behind the materials lie tables: of sheen's albedo (passes/scene/albedo_tables.hpp), then of what facets lose
 * (passes/scene/facet_losses.hpp).
 */
#include "shaders/scene/materials.glsl"

layout(set = 0, binding = 37) uniform samplerBuffer uTangents;  ///< 3 texels a triangle: unit tangent, bitangent's sign times the instance's scale

/** Bits of passes/scene/material_layout.hpp: what the materials in use need. A definition, since whole bodies of code
 * go by it. */
const uint MATERIAL_FEATURES = SURFACE_MATERIALS;
/** First texel of sheen's table. */
layout(constant_id = 130) const int ALBEDO_TABLES = 0;
/** Some material has microfacets of a width; else all that is not diffuse is a mirror or smooth glass. */
layout(constant_id = 131) const bool HAS_ROUGH_FACETS = true;
/** Some surface whose lobes have a width has vertex normals or a normal map, which tilt them. */
layout(constant_id = 132) const bool HAS_TILTED_LOBES = true;
const bool HAS_GLTF = (MATERIAL_FEATURES & (1u << 0)) != 0u;
const bool HAS_TRANSMISSION = (MATERIAL_FEATURES & (1u << 1)) != 0u;
const bool HAS_CLEARCOAT = (MATERIAL_FEATURES & (1u << 2)) != 0u;
const bool HAS_SHEEN = (MATERIAL_FEATURES & (1u << 3)) != 0u;
const bool HAS_IRIDESCENCE = (MATERIAL_FEATURES & (1u << 4)) != 0u;
const bool HAS_ANISOTROPY = (MATERIAL_FEATURES & (1u << 5)) != 0u;
const bool HAS_VOLUMES = (MATERIAL_FEATURES & (1u << 6)) != 0u;
const bool HAS_DISPERSION = (MATERIAL_FEATURES & (1u << 7)) != 0u;
const bool HAS_NORMAL_MAPS = (MATERIAL_FEATURES & (1u << 8)) != 0u;
const bool HAS_METALLIC_TEXTURES = (MATERIAL_FEATURES & (1u << 9)) != 0u;
const bool HAS_SPECULAR_TEXTURES = (MATERIAL_FEATURES & (1u << 10)) != 0u;
const bool HAS_TRANSMISSION_TEXTURES = (MATERIAL_FEATURES & (1u << 11)) != 0u;
const bool HAS_CLEARCOAT_TEXTURES = (MATERIAL_FEATURES & (1u << 12)) != 0u;
const bool HAS_SHEEN_TEXTURES = (MATERIAL_FEATURES & (1u << 13)) != 0u;
const bool HAS_ANISOTROPY_TEXTURES = (MATERIAL_FEATURES & (1u << 14)) != 0u;
const bool HAS_IRIDESCENCE_TEXTURES = (MATERIAL_FEATURES & (1u << 15)) != 0u;
const bool HAS_ALPHA = (MATERIAL_FEATURES & (1u << 16)) != 0u;
const bool HAS_UNLIT = (MATERIAL_FEATURES & (1u << 17)) != 0u;
const bool HAS_SPECULAR = (MATERIAL_FEATURES & (1u << 18)) != 0u;
/** Some glTF material is no pure metal. */
const bool HAS_DIELECTRIC = (MATERIAL_FEATURES & (1u << 31)) != 0u;
const bool HAS_COMPENSATION = (MATERIAL_FEATURES & (1u << 19)) != 0u;
const uint FIRST_MODEL_FEATURE = 20u;
const bool HAS_MODELS = ((MATERIAL_FEATURES & 0x07ffffffu) >> FIRST_MODEL_FEATURE) != 0u;
/** Some height map tilts normals. */
const bool HAS_BUMPS = (MATERIAL_FEATURES & (1u << 27)) != 0u;
#define HAS_MODEL(model) ((MATERIAL_FEATURES & (1u << (FIRST_MODEL_FEATURE + (model)))) != 0u)
const bool HAS_TANGENTS = HAS_ANISOTROPY || HAS_NORMAL_MAPS || HAS_BUMPS || HAS_CLEARCOAT_TEXTURES || HAS_MODEL(4u) || HAS_MODEL(2u);
/** Some material's light goes through its surface. */
const bool HAS_LIGHT_THROUGH = HAS_TRANSMISSION || HAS_MODEL(2u) || HAS_MODEL(3u);

/** A table of 31 x 31 texels, each the four corners of a cell. Bilinear. */
const int ALBEDO_CELLS = 31;
float albedoTable(int first, float x, float y) {
    const vec2 at = clamp(vec2(x, y), 0.0, 1.0) * float(ALBEDO_CELLS);
    const vec2 cell = min(floor(at), float(ALBEDO_CELLS - 1)), f = at - cell;
    const vec4 corner = uintBitsToFloat(texelFetch(uMaterials, ALBEDO_TABLES + first + int(cell.y) * ALBEDO_CELLS + int(cell.x)));
    return mix(mix(corner.x, corner.y, f.x), mix(corner.z, corner.w, f.x), f.y);
}
float sheenAlbedo(float cosine, float roughness) {
    return albedoTable(0, sqrt(max(cosine, 0.0)), roughness);
}
vec4 lossTexel(int i) {
    return uintBitsToFloat(texelFetch(uMaterials, i));
}

#include "shaders/scattering/gltf.glsl"
#include "shaders/scattering/models.glsl"

vec4 materialRow(int material, int row) {
    return uintBitsToFloat(texelFetch(uMaterials, material * MATERIAL_TEXELS + row));
}
uint materialFlags(int material) {
    return texelFetch(uMaterials, material * MATERIAL_TEXELS + 1).w;
}

/** Interpolated tangent frame about a unit normal (of the front side): orthonormal, x along the tangent. */
mat3 tangentFrame(int g, vec3 b, vec3 normal) {
    vec3 x, y;
    orthonormalBasis(normal, x, y);
    if (HAS_TANGENTS) {
        const vec4 t = b.x * texelFetch(uTangents, g * 3) + b.y * texelFetch(uTangents, g * 3 + 1) + b.z * texelFetch(uTangents, g * 3 + 2);
        const vec3 across = t.xyz - dot(t.xyz, normal) * normal;
        const float squared = dot(across, across);
        if (squared > 1e-10) {
            x = across * inversesqrt(squared);
            y = cross(normal, x) * (t.w < 0.0 ? -1.0 : 1.0);
        }
    }
    return mat3(x, y, normal);
}

/** Normal of a map, in the frame's coordinates: unit. */
vec3 mappedNormal(int material, int row, vec4 uv, float scale) {
#ifdef FOOTPRINT_NORMALS
    const vec3 n = footprintNormal(material, row, uv, scale);
#else
    const vec3 n = materialTexture(material, row, uv).xyz * 2.0 - 1.0;
#endif
    const vec3 scaled = vec3(n.xy * scale, n.z);
    return int(texelFetch(uMaterials, material * MATERIAL_TEXELS + row).w) < 0 ? vec3(0.0, 0.0, 1.0) : normalizeSafe(scaled, vec3(0.0, 0.0, 1.0));
}

/** Differences of a texture's red from a texel before to a texel behind, along u and v: those at the four texels around,
 * bilinear, so that they are exactly 0 where the map is flat. */
vec2 heightDifferences(int texture, vec2 uv) {
    const uvec4 header = texelFetch(uTextures, texture);
    const ivec2 size = ivec2(header.yz);
    const uint wrapU = header.w & 3u, wrapV = header.w >> 2 & 3u;
    // As in sampleTexture: even repeats are taken out before scaling, which keeps the fraction's bits.
    const vec2 position = clamp(uv, -1048576.0, 1048576.0), whole = floor(position * 0.5) * 2.0;
    const vec2 base = vec2(wrapU == 2u ? position.x : position.x - whole.x, wrapV == 2u ? position.y : position.y - whole.y);
    const vec2 texel = clamp(base, -4.0, 4.0) * vec2(size) - 0.5, corner = floor(texel), f = texel - corner;
    const ivec2 i = ivec2(corner);
    const ivec4 x = ivec4(wrapIndex(i.x - 1, size.x, wrapU), wrapIndex(i.x, size.x, wrapU), wrapIndex(i.x + 1, size.x, wrapU),
                          wrapIndex(i.x + 2, size.x, wrapU));
    const ivec4 y = ivec4(wrapIndex(i.y - 1, size.y, wrapV), wrapIndex(i.y, size.y, wrapV), wrapIndex(i.y + 1, size.y, wrapV),
                          wrapIndex(i.y + 2, size.y, wrapV));
    const float h11 = fetchTexel(header, x.y, y.y).x, h21 = fetchTexel(header, x.z, y.y).x,
                h12 = fetchTexel(header, x.y, y.z).x, h22 = fetchTexel(header, x.z, y.z).x;
    const vec2 across1 = vec2(h21 - fetchTexel(header, x.x, y.y).x, fetchTexel(header, x.w, y.y).x - h11);
    const vec2 across2 = vec2(h22 - fetchTexel(header, x.x, y.z).x, fetchTexel(header, x.w, y.z).x - h12);
    const vec2 down1 = vec2(h12 - fetchTexel(header, x.y, y.x).x, h22 - fetchTexel(header, x.z, y.x).x);
    const vec2 down2 = vec2(fetchTexel(header, x.y, y.w).x - h11, fetchTexel(header, x.z, y.w).x - h21);
    return vec2(mix(mix(across1.x, across1.y, f.x), mix(across2.x, across2.y, f.x), f.y),
                mix(mix(down1.x, down1.y, f.x), mix(down2.x, down2.y, f.x), f.y));
}

/**
 * The normal (unit, of the front side) of a surface that stands out by a height map: n - grad h, by the surface gradient
 * of Mikkelsen, "Bump mapping unparametrized surfaces on the GPU", 2010, over the triangle's own coordinates. Slopes are
 * heightDifferences(). `e1`, `e2`: the triangle's edges; a flat map leaves the normal's bits.
 */
vec3 bumpedNormal(int material, int g, vec3 b, vec4 uv, vec3 normal, vec3 e1, vec3 e2) {
    const int at = material * MATERIAL_TEXELS + 43;
    const uvec4 first = texelFetch(uMaterials, at), second = texelFetch(uMaterials, at + 1);
    if (int(first.w) < 0) return normal;
    const vec3 rowU = uintBitsToFloat(first.xyz), rowV = uintBitsToFloat(second.xyz);
    const bool set0 = second.w == 0u;
    const vec4 t0 = texelFetch(uTexcoords, g * 3), t1 = texelFetch(uTexcoords, g * 3 + 1) - t0,
               t2 = texelFetch(uTexcoords, g * 3 + 2) - t0;
    const vec2 s1 = set0 ? t1.xy : t1.zw, s2 = set0 ? t2.xy : t2.zw;
    const vec2 d1 = vec2(dot(rowU.xy, s1), dot(rowV.xy, s1)), d2 = vec2(dot(rowU.xy, s2), dot(rowV.xy, s2));
    const vec3 p = vec3(set0 ? uv.xy : uv.zw, 1.0);
    const vec2 here = vec2(dot(rowU, p), dot(rowV, p));
    const vec2 size = vec2(texelFetch(uTextures, int(first.w)).yz);
    // Heights along the edges of the triangle, from which the gradient follows whatever the coordinates.
    const float scale = materialRow(material, 9).w * abs(texelFetch(uTangents, g * 3).w);
    // Nothing is steeper, whatever a file says: squares stay finite.
    const float STEEPEST = 1e15;
    const vec2 slope = 0.5 * scale * heightDifferences(int(first.w), here) * size;
    // Scaled first: products of a small triangle's edges are no normal floats.
    const vec3 largest3 = max(abs(e1), abs(e2));
    const float largest = max(max(largest3.x, largest3.y), largest3.z);
    const float inverse = largest > 0.0 ? 1.0 / largest : 0.0;
    const vec3 a1 = e1 * inverse, a2 = e2 * inverse;
    const float h1 = clamp(dot(slope, d1) * inverse, -STEEPEST, STEEPEST), h2 = clamp(dot(slope, d2) * inverse, -STEEPEST, STEEPEST);
    const float volume = dot(normal, cross(a1, a2));
    const vec3 tilt = (h1 * cross(a2, normal) + h2 * cross(normal, a1)) / volume;
    const vec3 bounded = clamp(tilt, -STEEPEST, STEEPEST);
    const bool isFlat = (h1 == 0.0 && h2 == 0.0) || !(abs(volume) > 0.0);
    return isFlat ? normal : normalizeSafe(normal - bounded, normal);
}

/** Chance that a surface of this material stops light where its base colour has this alpha. */
float opacityOf(int material, float alpha) {
    const uint flags = materialFlags(material);
    const float cutoff = materialRow(material, 2).w;
    return (flags & MATERIAL_MASK) != 0u ? (alpha >= cutoff ? 1.0 : 0.0) : ((flags & MATERIAL_BLEND) != 0u ? clamp(alpha, 0.0, 1.0) : 1.0);
}

/** The same at a point. */
float opacity(int material, int g, vec3 b) {
    return opacityOf(material, baseColor(material, g, b).a);
}

/** glTF's parameters of a point, but for the coat's normal. `front`: seen from the front side; `channel` (0..2) picks
 * the wavelength where the index depends on it. */
GltfSurface gltfSurface(int material, vec3 color, vec4 uv, bool front, int channel) {
    const vec4 row2 = materialRow(material, 2);
    GltfSurface s;
    s.baseColor = min(color, vec3(1.0));
    s.metallic = row2.y;
    float roughness = row2.z;
    if (HAS_METALLIC_TEXTURES) {
        const vec4 t = materialTexture(material, 14, uv);
        s.metallic *= t.b;
        roughness *= t.g;
    }
    const vec4 row7 = materialRow(material, 7), row8 = materialRow(material, 8);
    float specular = row7.w;
    vec3 specularColor = row7.rgb;
    if (HAS_SPECULAR_TEXTURES) {
        specular *= materialTexture(material, 18, uv).a;
        specularColor *= materialTexture(material, 20, uv).rgb;
    }
    float index = row8.x;
    s.f0 = min(normalReflectance(index) * specularColor, vec3(1.0)) * specular;
    s.f90 = specular;
    const float alpha = roughness * roughness;
    s.alpha = vec2(HAS_ROUGH_FACETS ? alpha : 0.0);
    s.transmission = 0.0;
    s.thin = true;
    s.eta = 1.0;
    if (HAS_TRANSMISSION) {
        s.transmission = row8.y;
        if (HAS_TRANSMISSION_TEXTURES) s.transmission *= materialTexture(material, 22, uv).r;
        s.thin = (materialFlags(material) & MATERIAL_THIN) != 0u || s.transmission <= 0.0;
        if (HAS_DISPERSION) index += (index - 1.0) * 0.025 * row8.z * float(channel - 1);
        index = max(index, 1.0);
        s.eta = front ? index : 1.0 / index;
    }
    s.coat = 0.0;
    s.coatAlpha = 0.0;
    s.coatNormal = vec3(0.0, 0.0, 1.0);
    if (HAS_CLEARCOAT) {
        const vec4 row10 = materialRow(material, 10);
        s.coat = row10.x;
        float rough = row10.y;
        if (HAS_CLEARCOAT_TEXTURES) {
            s.coat *= materialTexture(material, 24, uv).r;
            rough *= materialTexture(material, 26, uv).g;
        }
        s.coatAlpha = rough * rough;
    }
    s.sheenColor = vec3(0.0);
    s.sheenRoughness = 0.0;
    if (HAS_SHEEN) {
        const vec4 row11 = materialRow(material, 11);
        s.sheenColor = row11.rgb;
        s.sheenRoughness = row11.w;
        if (HAS_SHEEN_TEXTURES) {
            s.sheenColor *= materialTexture(material, 30, uv).rgb;
            s.sheenRoughness *= materialTexture(material, 32, uv).a;
        }
    }
    s.film = 0.0;
    s.filmIndex = 1.3;
    s.filmThickness = 0.0;
    if (HAS_IRIDESCENCE) {
        const vec4 row12 = materialRow(material, 12), row13 = materialRow(material, 13);
        s.film = row12.z;
        s.filmIndex = row12.w;
        s.filmThickness = row13.x;
        if (HAS_IRIDESCENCE_TEXTURES) {
            s.film *= materialTexture(material, 36, uv).r;
            s.filmThickness = mix(row13.x, row13.y, materialTexture(material, 38, uv).g);
        }
    }
    return s;
}

/** Turns of the tangent and widths of a glTF material's facets by its anisotropy. */
void turnFacets(int material, vec4 uv, inout GltfSurface s, inout mat3 frame) {
    const vec4 row12 = materialRow(material, 12);
    float strength = materialRow(material, 10).w;
    vec2 direction = row12.xy;
    if (HAS_ANISOTROPY_TEXTURES) {
        const vec3 t = materialTexture(material, 34, uv).xyz;
        const bool has = int(texelFetch(uMaterials, material * MATERIAL_TEXELS + 34).w) >= 0;
        const vec2 d = normalizeSafe(t.xy * 2.0 - 1.0, vec2(1.0, 0.0));
        if (has) {
            direction = vec2(d.x * row12.x - d.y * row12.y, d.x * row12.y + d.y * row12.x);
            strength *= t.z;
        }
    }
    const vec3 x = frame[0] * direction.x + frame[1] * direction.y;
    const vec3 y = frame[1] * direction.x - frame[0] * direction.y;
    frame = mat3(x, y, frame[2]);
    s.alpha.x = mix(s.alpha.x, 1.0, strength * strength);
}

/** Widths between a mirror's and what floats resolve. */
vec2 resolvedAlpha(vec2 alpha) {
    return max(alpha.x, alpha.y) < SMOOTH_ALPHA ? alpha : clamp(alpha, SMOOTH_ALPHA, 1.0);
}

ModelSurface modelSurface(int material, uint flags, vec3 color, bool front) {
    const vec4 row40 = materialRow(material, 40), row41 = materialRow(material, 41), row42 = materialRow(material, 42);
    ModelSurface m;
    m.model = (flags >> MATERIAL_MODEL_SHIFT) - 1u;
    m.color = min(color, vec3(1.0));
    m.n = row40.xyz;
    m.roughness = row40.w;
    m.k = row41.xyz;
    m.exponent = row41.w;
    m.eta = front ? m.n.x : 1.0 / m.n.x;
    m.inside = !front;
    m.losses = HAS_COMPENSATION ? int(texelFetch(uMaterials, material * MATERIAL_TEXELS + 42).z) : 0;
    m.facets = Microfacets(HAS_ROUGH_FACETS ? resolvedAlpha(row42.xy) : vec2(0.0), (flags & MATERIAL_BECKMANN) != 0u);
    m.schlick = (flags & MATERIAL_SCHLICK) != 0u;
    m.compensated = (flags & MATERIAL_COMPENSATED) != 0u;
    return m;
}
#endif
