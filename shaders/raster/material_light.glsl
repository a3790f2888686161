// Direct light on surfaces that are more than diffuse: the path tracer's materials, with its normals. Punctual lights
// are exact; of area lights only the diffuse part is shaded; surroundings that nothing hides are reflected by split sums:
// the lobe's albedo times the mean radiance that a lobe along its normal sees (passes/environment).
#ifndef SHADERS_RASTER_MATERIAL_LIGHT_GLSL
#define SHADERS_RASTER_MATERIAL_LIGHT_GLSL
#include "passes/pathtrace/material_bsdf.glsl"
#include "shaders/raster/surface.glsl"
#include "shaders/scene/specular_environment.glsl"

SurfacePoint rasterPoint(Triangle source, Surface surface, vec3 shading) {
    SurfacePoint s;
    s.position = surface.position;
    s.face = surface.front ? surface.faceNormal : -surface.faceNormal;
    s.shading = shading;
    s.front = surface.front;
    s.offset = 0.0;
    s.b = surface.b;
    s.triangle = source;
    return s;
}

#ifdef FOOTPRINT_NORMALS
/// Widths of facets that lie about normals whose slopes vary: a width's square is twice the variance of a slope
/// (Beckmann's exactly), and variances add.
vec2 widened(vec2 alpha, float variance) {
    return variance > 0.0 ? resolvedAlpha(min(sqrt(alpha * alpha + 2.0 * variance), 1.0)) : alpha;
}
#endif

/// What the material makes of a view along the unit vector -toEye. `color` is the base colour, filtered.
SurfaceBsdf rasterBsdf(Triangle source, Surface surface, vec3 shading, vec3 color) {
    SurfacePoint s = rasterPoint(source, surface, shading);
    vec3 throughput = vec3(1.0);
    SurfaceBsdf bsdf = surfaceBsdf(s, -surface.toEye, 0.5, throughput);
    bsdf.albedo = color;
    bsdf.gltf.baseColor = min(color, vec3(1.0));
    if (HAS_MODELS) bsdf.other.color = min(color, vec3(1.0));
#ifdef FOOTPRINT_NORMALS
    if (HAS_ROUGH_FACETS) {
        if (HAS_GLTF) bsdf.gltf.alpha = widened(bsdf.gltf.alpha, mapVariance.x);
        if (HAS_GLTF && HAS_CLEARCOAT) bsdf.gltf.coatAlpha = widened(vec2(bsdf.gltf.coatAlpha), mapVariance.y).x;
        if (HAS_MODELS) bsdf.other.facets.alpha = widened(bsdf.other.facets.alpha, mapVariance.x);
    }
#endif
    return bsdf;
}

/// f |cos| for light from the unit vector wi: of the lobe, and of what is mirrored at the surface (material_bsdf.glsl).
vec3 valueTowards(SurfaceBsdf bsdf, SurfacePoint s, vec3 wi) {
    float height = dot(s.face, wi);
    vec3 value = vec3(0.0);
    vec3 local = wi * bsdf.frame;
    if (height > 0.0 && local.z > 0.0) value += localValue(bsdf, local).value;
    if (HAS_TILTED_LOBES) {
        vec3 mirrored = (wi - 2.0 * height * s.face) * bsdf.frame;
        if (height > 0.0 && mirrored.z > 0.0) value += localValue(bsdf, mirrored).value;
    }
    return bsdf.unlit ? vec3(0.0) : value;
}

/// Share of the base colour that light from everywhere sees: what mirrors and lets through is left out.
float diffuseShare(SurfaceBsdf bsdf) {
    float share = 0.0;
    if (HAS_GLTF && bsdf.model == 0u)
        share = (1.0 - bsdf.gltf.metallic) * (1.0 - bsdf.gltf.transmission) * (1.0 - maxComponent(bsdf.gltf.f0));
    if (HAS_MODELS && bsdf.model == MODEL_OREN_NAYAR + 1u) share = 1.0;
    return bsdf.unlit ? 0.0 : share;
}

/// Reflectance of the smooth surface towards wo.
vec3 mirrorShare(SurfaceBsdf bsdf) {
    vec3 share = vec3(0.0);
    if (HAS_GLTF && bsdf.model == 0u) {
        GltfFresnel f = gltfFresnel(bsdf.gltf, bsdf.wo.z);
        share = mix(f.dielectric, f.metal, bsdf.gltf.metallic);
    }
    if (HAS_MODELS && bsdf.model == MODEL_MIRROR + 1u) share = bsdf.other.color;
    if (HAS_MODEL(MODEL_DIELECTRIC) && bsdf.model == MODEL_DIELECTRIC + 1u)
        share = vec3(fresnelDielectric(bsdf.wo.z, bsdf.other.eta));
    if (HAS_MODEL(MODEL_THIN_DIELECTRIC) && bsdf.model == MODEL_THIN_DIELECTRIC + 1u)
        share = vec3(paneReflectance(fresnelDielectric(bsdf.wo.z, bsdf.other.n.x)));
    if (HAS_MODEL(MODEL_CONDUCTOR) && bsdf.model == MODEL_CONDUCTOR + 1u)
        share = bsdf.other.color * fresnelConductor(bsdf.wo.z, bsdf.other.n, bsdf.other.k);
    return bsdf.unlit ? vec3(0.0) : share;
}

#ifdef SPECULAR_ENVIRONMENT
layout(set = 0, binding = 15) uniform samplerBuffer uSpecularEnvironment;

/// Of a lobe seen at `cosine`: parts of its albedo that f0 and f90 scale, and what the diffuse part loses of f90 - f0.
vec3 directionalAlbedo(float cosine, float roughness) {
    const int LAST = DIRECTIONAL_ALBEDO_NODES - 1;
    vec2 at = clamp(vec2(sqrt(clamp(cosine, 0.0, 1.0)), roughness), 0.0, 1.0) * float(LAST);
    ivec2 low = min(ivec2(at), LAST - 1);
    vec2 f = at - vec2(low);
    int first = low.y * DIRECTIONAL_ALBEDO_NODES + low.x, next = first + DIRECTIONAL_ALBEDO_NODES;
    return mix(mix(texelFetch(uSpecularEnvironment, first).xyz, texelFetch(uSpecularEnvironment, first + 1).xyz, f.x),
               mix(texelFetch(uSpecularEnvironment, next).xyz, texelFetch(uSpecularEnvironment, next + 1).xyz, f.x), f.y);
}

#ifdef ENVIRONMENT_IMAGE
/// At (u, v) of one level, which repeats in u.
vec3 prefilteredLevel(int level, vec2 at) {
    int width = prefilteredWidth(level), height = width >> 1, first = prefilteredFirst(level);
    vec2 p = at * vec2(width, height) - 0.5, corner = floor(p), f = p - corner;
    int x0 = int(corner.x) < 0 ? width - 1 : min(int(corner.x), width - 1), x1 = x0 + 1 == width ? 0 : x0 + 1;
    int y0 = first + width * clamp(int(corner.y), 0, height - 1),
        y1 = first + width * clamp(int(corner.y) + 1, 0, height - 1);
    return mix(mix(texelFetch(uSpecularEnvironment, y0 + x0).rgb, texelFetch(uSpecularEnvironment, y0 + x1).rgb, f.x),
               mix(texelFetch(uSpecularEnvironment, y1 + x0).rgb, texelFetch(uSpecularEnvironment, y1 + x1).rgb, f.x), f.y);
}
#endif

/// What a lobe of unit albedo reflects of the surroundings, mirrored along a unit vector. A rough lobe leans from there
/// to the normal (Lagarde and de Rousiers, "Moving Frostbite to physically based rendering", SIGGRAPH 2014 courses), by
/// the cube of the roughness: a fit to path-traced spheres, on which their own formula is too bright by a tenth.
vec3 glossyRadiance(vec3 mirrored, vec3 normal, float roughness) {
    vec3 radiance = texelFetch(uEnvironment, 0).rgb;
#ifdef ENVIRONMENT_IMAGE
    vec3 leaning = normalizeSafe(mix(mirrored, normal, min(roughness * roughness * roughness, 1.0)), normal);
    vec3 q = toEnvironment(leaning);
    vec2 at = vec2(0.5 - realAtan2(q.x, q.z) * INV_TWO_PI, realAtan2(length(q.xz), q.y) * INV_PI);
    float level = min(roughness, 1.0) * float(PREFILTERED_LEVELS);
    int fine = min(int(level), PREFILTERED_LEVELS - 1);
    vec3 sharp = fine == 0 ? environmentAt(mirrored).radiance : prefilteredLevel(max(fine, 1), at);
    radiance = mix(sharp, prefilteredLevel(fine + 1, at), level - float(fine));
#endif
    return radiance;
}

float lobeRoughness(vec2 alpha) { return sqrt(sqrt(max(alpha.x * alpha.y, 0.0))); }

/// Radiance reflected of surroundings that nothing hides; `diffuseLight` is what a white diffuse surface would reflect.
vec3 surroundingsLight(SurfaceBsdf bsdf, vec3 color, vec3 diffuseLight) {
    vec3 normal = bsdf.frame[2], mirroredWo = normalizeSafe(bsdf.frame * mirrored(bsdf.wo), normal);
    vec3 light = vec3(0.0);
    if (HAS_GLTF && bsdf.model == 0u) {
        GltfSurface s = bsdf.gltf;
        float roughness = lobeRoughness(s.alpha), f0 = maxComponent(s.f0);
        vec3 albedo = directionalAlbedo(bsdf.wo.z, roughness);
        vec3 metal = s.baseColor * albedo.x + albedo.y, dielectric = s.f0 * albedo.x + s.f90 * albedo.y;
        if (HAS_IRIDESCENCE && s.film > 0.0) {
            GltfFresnel f = gltfFresnel(s, bsdf.wo.z);
            metal = f.metal * (albedo.x + albedo.y);
            dielectric = f.dielectric * (albedo.x + albedo.y);
        }
        vec3 specular = gltfMirrored(s, GltfFresnel(dielectric, metal));
        float share = 0.0;
        if (HAS_DIELECTRIC) {
            share = (1.0 - s.metallic) * (1.0 - s.transmission);
            share *= gltfInside(s) ? 1.0 : clamp(1.0 - f0 - max(s.f90 - f0, 0.0) * albedo.z, 0.0, 1.0);
        }
        light = color * share * diffuseLight + specular * glossyRadiance(mirroredWo, normal, roughness);
        if (HAS_SHEEN) {
            float sheen = min(sheenAlbedo(bsdf.wo.z, s.sheenRoughness), 1.0);
            light = light * (1.0 - maxComponent(s.sheenColor) * sheen) + s.sheenColor * sheen * diffuseLight;
        }
        if (HAS_CLEARCOAT) {
            vec3 coatNormal = bsdf.frame * s.coatNormal, wo = bsdf.frame * bsdf.wo;
            float coat = coatReflectance(s, bsdf.wo), coatRoughness = lobeRoughness(vec2(s.coatAlpha));
            vec3 lobe = directionalAlbedo(dot(bsdf.wo, s.coatNormal), coatRoughness);
            vec3 reflected = normalizeSafe(reflectedAbout(wo, coatNormal), coatNormal);
            light = light * (1.0 - coat) + coat * (lobe.x + lobe.y) * glossyRadiance(reflected, coatNormal, coatRoughness);
        }
    } else {
        float roughness = HAS_MODELS ? lobeRoughness(bsdf.other.facets.alpha) : 0.0;
        bool facets = HAS_MODEL(MODEL_CONDUCTOR) && bsdf.model == MODEL_CONDUCTOR + 1u;
        vec3 albedo = directionalAlbedo(bsdf.wo.z, facets ? roughness : 0.0);
        light = color * diffuseShare(bsdf) * diffuseLight +
                mirrorShare(bsdf) * (albedo.x + albedo.y) * glossyRadiance(mirroredWo, normal, facets ? roughness : 0.0);
    }
    return bsdf.unlit ? vec3(0.0) : light;
}
#endif
#endif
