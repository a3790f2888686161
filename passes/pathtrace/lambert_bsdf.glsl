#ifndef HELIOGRAPH_PATHTRACE_LAMBERT_BSDF
#define HELIOGRAPH_PATHTRACE_LAMBERT_BSDF
/** @file How surfaces scatter where all are Lambertian: see material_bsdf.glsl for the general case. */
#include "passes/pathtrace/surface.glsl"
#include "shaders/sampling/sampler.glsl"
#include "shaders/sampling/warp.glsl"

/** Dimensions of the sampler that one scattering takes: point on a light, direction, (light, roulette). */
const uint DIMENSIONS_PER_SCATTERING = 3u;
/** Turns of loops that a scattering may take. */
#ifdef SOLID_TEXTURES
const uint LOOP_TURNS = 6u;  // NOISE_OCTAVES
#else
const uint LOOP_TURNS = 0u;
#endif

/** surfaceValues() weighs light found by sampling lights against light found by its own directions. */
const bool WEIGHS_LIGHT = false;

struct SurfaceBsdf {
    vec3 albedo;
};

/** Chance per solid angle of a sampled direction, and what of light from it is scattered, f |cos| over that chance. */
struct SurfaceValue {
    float density;
    vec3 weight;
};

struct SurfaceSample {
    vec3 direction;
    vec3 weight;    ///< f |cos| / density
    float density;  ///< negative: one of a finite set
    bool goes;      ///< the path goes on
};

/** What is left of light after the segment that ends at s. */
vec3 throughMedium(SurfacePoint s, vec3 direction, int source, float distance) {
    return vec3(1.0);
}
/** Numbers that choose a lobe and a wavelength. */
vec2 chooseLobe(uint kind, PixelSampler numbers, uint dimension) {
    return vec2(0.0);
}
/** Where a ray leaves the surface. */
vec3 leaving(SurfacePoint s, vec3 direction) {
    return s.position + s.face * s.offset;
}
/** The normal of the side whose lights are asked. */
vec3 lightSide(SurfaceBsdf bsdf, SurfacePoint s) {
    return s.face;
}
/** What the surface makes of a ray along `direction`; may pick a wavelength, which changes the throughput. */
SurfaceBsdf surfaceBsdf(SurfacePoint s, vec3 direction, float choice, inout vec3 throughput) {
    return SurfaceBsdf(baseColor(s.triangle.material, s.triangle.g, s.b).rgb);
}
bool scatters(SurfaceBsdf bsdf) {
    return max(max(bsdf.albedo.x, bsdf.albedo.y), bsdf.albedo.z) > 0.0;
}
bool takesGuide(SurfaceBsdf bsdf) {
    return true;
}
/** Light that a surface shows of itself beyond emission. */
vec3 ownLight(SurfaceBsdf bsdf) {
    return vec3(0.0);
}
/** A direction drawn; what it is worth comes from surfaceValues. */
SurfaceSample sampleSurface(SurfaceBsdf bsdf, SurfacePoint s, vec2 u, float choice) {
    SurfaceSample r;
    float cosine;
    r.direction = cosineDirection(s.shading, u, cosine);
    r.density = cosine * INV_PI;
    r.weight = bsdf.albedo;
    r.goes = dot(s.face, r.direction) > 0.0;
    return r;
}
/** Values of directions to lights, where one `asks`, and of the direction drawn. */
void surfaceValues(SurfaceBsdf bsdf, SurfacePoint s, vec3 toLights[LIGHTS_ASKED], const bool asks, float lightDensity,
                   inout SurfaceSample next, out SurfaceValue lit[LIGHTS_ASKED]) {
    [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i) {
        const float cosine = dot(s.shading, toLights[i]);
        lit[i] = SurfaceValue(dot(s.face, toLights[i]) > 0.0 ? cosine * INV_PI : 0.0, bsdf.albedo);
    }
}
#endif
