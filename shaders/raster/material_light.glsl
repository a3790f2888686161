// Direct light on surfaces that are more than diffuse: the path tracer's materials, with its normals. Punctual lights
// are exact; of area lights only the diffuse part is shaded; the surroundings'
// mean is reflected as by a smooth surface.
#ifndef SHADERS_RASTER_MATERIAL_LIGHT_GLSL
#define SHADERS_RASTER_MATERIAL_LIGHT_GLSL
#include "passes/pathtrace/material_bsdf.glsl"
#include "shaders/raster/surface.glsl"

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

/// What the material makes of a view along the unit vector -toEye. `color` is the base colour, filtered.
SurfaceBsdf rasterBsdf(Triangle source, Surface surface, vec3 shading, vec3 color) {
    SurfacePoint s = rasterPoint(source, surface, shading);
    vec3 throughput = vec3(1.0);
    SurfaceBsdf bsdf = surfaceBsdf(s, -surface.toEye, 0.5, throughput);
    bsdf.albedo = color;
    bsdf.gltf.baseColor = min(color, vec3(1.0));
    if (HAS_MODELS) bsdf.other.color = min(color, vec3(1.0));
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
    if (HAS_MODEL(MODEL_CONDUCTOR) && bsdf.model == MODEL_CONDUCTOR + 1u)
        share = bsdf.other.color * fresnelConductor(bsdf.wo.z, bsdf.other.n, bsdf.other.k);
    return bsdf.unlit ? vec3(0.0) : share;
}
#endif
