#ifndef HELIOGRAPH_PATHTRACE_PATH
#define HELIOGRAPH_PATHTRACE_PATH
/** @file
 * One step of a light path: what is added where a ray arrives, and how the path goes on. Knows nothing of how
 * paths are scheduled. Veach, "Robust Monte Carlo methods for light transport simulation", 1997.
 *
 * Surfaces scatter on both faces, by lambert_bsdf.glsl where all are Lambertian, else by material_bsdf.glsl. Light is found in two ways, by sampling the light table and by rays
 * that happen to arrive at it, each weighted by the balance heuristic; NEXT_EVENT false leaves the second only.
 */
#ifdef SURFACE_MATERIALS
#include "passes/pathtrace/material_bsdf.glsl"
#else
#include "passes/pathtrace/lambert_bsdf.glsl"
#endif
#ifdef GUIDED
#include "passes/pathtrace/guide.glsl"
#endif
#ifdef RADIOSITY
#include "passes/radiosity/patch_radiance.glsl"
#endif
#include "shaders/sampling/sampler.glsl"
#include "shaders/sampling/warp.glsl"
#include "shaders/scene/lights.glsl"

layout(constant_id = 0) const uint SAMPLER_KIND = SAMPLER_SOBOL;
layout(constant_id = 1) const bool NEXT_EVENT = true;
layout(constant_id = 5) const uint SAMPLER_STRATA = 0u;  ///< see startSample()
layout(constant_id = 6) const bool WHITTED = false;     ///< only mirrors and smooth refraction go on (Whitted 1980)
layout(constant_id = 7) const bool HEMISPHERE = false;  ///< directions are uniform over the hemisphere

/** Roulette keeps a path with chance min(1, ROULETTE * throughput): chances near the throughput itself end
 * paths that would still have carried light cheaply. The first scattering is spared: dark surfaces would show
 * black pixels under a sky, at 2.3 times the cost for the same error (FlightHelmet in a white furnace). */
layout(constant_id = 9) const float ROULETTE = 3.0;
layout(constant_id = 17) const float SURVIVAL = 0.0;  ///< above 0: the chance itself, whatever the throughput

/** Scatterings after which mirrors and total reflection lose one path in a hundred, which the others stand for: near its
 * critical angle a sphere of glass holds light for 10^5 turns without a loss that roulette could go by. */
const uint LOSSLESS_DEPTH = 64u;
const float LOSSLESS_SURVIVAL = 0.99;

/** With what chance a path of this throughput goes on after `depth` scatterings, the last of them one into a finite set
 * of directions or not. */
float rouletteChance(float throughput, uint depth, bool finiteSet) {
    const float lossless = finiteSet && depth > LOSSLESS_DEPTH ? LOSSLESS_SURVIVAL : 1.0;
    const float chance = SURVIVAL > 0.0 ? (throughput > 0.0 ? SURVIVAL : 0.0) : min(1.0, ROULETTE * throughput) * lossless;
    return depth < 2u ? 1.0 : chance;
}

struct Path {
    vec3 origin;
    vec3 direction;    ///< unit
    vec3 throughput;
    vec3 radiance;     ///< gathered so far
    float density;     ///< of the direction over solid angle; negative where no light sampling finds it (camera, mirrors)
    uint depth;        ///< scatterings so far
    uint sampleIndex;
    int source;        ///< slot of the triangle the ray leaves, -1 for the camera
    int lightPlace;    ///< of the surface that the ray leaves, for the chances of lights there
#ifdef GUIDED
    float reach;       ///< what its largest throughput would be had the last rough surface not guided it: roulette goes by it
#endif
};

/** A question to the scene: is the way to a light free, and what does it then bring? */
struct ShadowRay {
    vec3 origin;
    vec3 direction;  ///< not unit: the light is at distance 1 (or infinite)
    float limit;     ///< 0 where there is nothing to ask
    ivec2 target;    ///< range of g that the ray goes to
    vec3 radiance;
};

float largestOf(vec3 v) {
    return max(max(v.x, v.y), v.z);
}

/**
 * Takes the path through the surface that its ray met: adds emission, gives shadow rays to be asked (the
 * radiance of each to be added if its way is free), and the next ray. Returns whether the path goes on; `cut` is set
 * where it ends only because of maxDepth. Where nothing was met (`slot` < 0), nothing is added or asked.
 */
bool scatter(inout Path path, PixelSampler numbers, float distance, int slot, uint maxDepth,
             out ShadowRay shadows[LIGHTS_ASKED], out bool cut) {
    const bool hit = slot >= 0;
    const SurfacePoint s = surfaceAt(path.origin, path.direction, path.source, max(slot, 0));
    if (hit) path.throughput *= throughMedium(s, path.direction, path.source, distance);
    if (HAS_EMISSION) {
        const Emission e = emission(s.triangle.material, s.triangle.g, s.b);
        const bool emits = hit && (s.front || e.doubleSided);
        float weight = 1.0;
        if (NEXT_EVENT && HAS_AREA_LIGHTS) {
            const float cosine = abs(dot(s.face, path.direction));
#ifdef LIGHT_TABLES
            const float areaDensity = lightAreaDensity(path.lightPlace, s.triangle.g);
#else
            const float areaDensity = e.areaDensity;
#endif
            float sampled = cosine > 0.0 ? areaDensity * distance * distance / cosine : 0.0;
#ifdef SHAPES
            // Light sampling finds neither what has no end nor tori.
            if (s.triangle.shape == SHAPE_PLANE || s.triangle.shape == SHAPE_TORUS) sampled = 0.0;
            if (HAS_SPHERES && s.triangle.shape == SHAPE_SPHERE)
                sampled = areaDensity * sphereDensity(path.origin, s.triangle.v0, length(s.triangle.v1), distance, cosine);
#endif
#ifdef SOLID_ANGLES
            if (emits && sampled > 0.0) sampled = solidAngleDensity(path.origin, path.lightPlace, s.triangle.g, sampled);
#endif
            weight = path.density < 0.0 ? 1.0 : path.density / (path.density + sampled);
        }
        path.radiance += emits ? path.throughput * e.radiance * weight : vec3(0.0);
    }

#ifdef RADIOSITY
    path.radiance += hit ? path.throughput * patchRadiance(slot, s.b, s.front) : vec3(0.0);
#endif

    const uint dimension = DIMENSION_PATH + path.depth * DIMENSIONS_PER_SCATTERING;
    vec2 lobe = chooseLobe(SAMPLER_KIND, numbers, dimension);
    const SurfaceBsdf bsdf = surfaceBsdf(s, path.direction, lobe.y, path.throughput);
    if (hit) path.radiance += path.throughput * ownLight(bsdf);
    const bool goesOn = hit && scatters(bsdf);
    cut = goesOn && path.depth >= maxDepth;
    bool alive = goesOn && !cut;
    const uvec2 choice = sampleBits2D(SAMPLER_KIND, numbers, dimension + 2u);

    const vec2 turn = sample2D(SAMPLER_KIND, numbers, dimension + 1u);
#ifdef GUIDED
    const bool wide = takesGuide(bsdf);
    const Guide guide = guideAt(s.position, s.face, hit && wide);
    const bool guided = lobe.x < guide.share;
    lobe.x = min(guided ? lobe.x / guide.share : (lobe.x - guide.share) / (1.0 - guide.share), 0.99999994);
#endif
    SurfaceSample next = sampleSurface(bsdf, s, turn, lobe.x);
#ifdef GUIDED
    const float fromTable = guideDirection(guide, guided, lobe.x, turn, next.direction);
    if (guided) {
        next.density = 1.0;  // by which its worth is found
        next.goes = true;
    }
#endif
    if (HEMISPHERE) {
        next.direction = uniformDirection(s.shading, turn);
        next.density = turn.x * INV_PI;  // by which its worth is found
        next.goes = dot(s.face, next.direction) > 0.0;
    }
    LightSample lights[LIGHTS_ASKED];
    vec3 toLights[LIGHTS_ASKED];
    SurfaceValue scattered[LIGHTS_ASKED];
    const bool asksSeveral = LIGHTS_ASKED > 1 && path.depth == 0u;
    if (LIGHT_COUNT > 0) {
        path.lightPlace = lightPlace(s.position, lightSide(bsdf, s));
#if LIGHTS_ASKED == 1
        lights[0] = sampleLight(s.position, path.lightPlace, choice.x, sampleBits2D(SAMPLER_KIND, numbers, dimension));
#else
        [[dont_unroll]] for (uint i = 0u; i < (asksSeveral ? uint(LIGHTS_ASKED) : 1u); ++i) {
            PixelSampler of = numbers;
            if (asksSeveral) of = splitSample(SAMPLER_KIND, numbers, LIGHTS_ASKED, i);
            [[unroll]] for (int j = LIGHTS_ASKED - 1; j > 0; --j) lights[j] = lights[j - 1];
            lights[0] = sampleLight(s.position, path.lightPlace, sampleBits2D(SAMPLER_KIND, of, dimension + 2u).x,
                                    sampleBits2D(SAMPLER_KIND, of, dimension));
        }
#endif
    }
    [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i) toLights[i] = LIGHT_COUNT > 0 ? lights[i].direction : s.face;
    surfaceValues(bsdf, s, toLights, LIGHT_COUNT > 0, WHITTED || LIGHT_COUNT == 0 ? 0.0 : lights[0].density, next, scattered);
#ifdef GUIDED
    // What is drawn from both is worth its value over both densities. Against light sampling it is weighed by the
    // surface's own density alone: weights that sum to 1 need not be those of the densities drawn by.
    const float unguided = largestOf(next.weight), before = largestOf(path.throughput);
    if (next.density < 0.0) next.weight /= 1.0 - guide.share;
    if (next.density > 0.0) next.weight *= next.density / mix(next.density, fromTable, guide.share);
#endif

    const float several = asksSeveral ? float(LIGHTS_ASKED) : 1.0;
    [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i) {
        shadows[i] = ShadowRay(s.position, vec3(0.0, 0.0, 1.0), 0.0, ivec2(1, 0), vec3(0.0));
        if (LIGHT_COUNT > 0) {
            const LightSample light = lights[i];
            // Without rays that could meet the light there is nothing to weigh against.
            const bool weighs = light.density > 0.0 && !WHITTED && !WEIGHS_LIGHT;
            const float weight = weighs ? light.density / (several * light.density + scattered[i].density) : 1.0 / several;
            shadows[i].origin = leaving(s, light.direction);
            shadows[i].radiance = path.throughput * scattered[i].weight * light.radiance * (scattered[i].density * weight);
            shadows[i].target = light.triangles;
            shadows[i].direction = light.infinite ? light.direction : light.target - shadows[i].origin;
            const bool asks = alive && scattered[i].density > 0.0 && largestOf(light.radiance) > 0.0;
            shadows[i].limit = asks && (i == 0 || asksSeveral) ? (light.infinite ? INFINITE_DISTANCE : 1.0) : 0.0;
        }
    }

    if (HEMISPHERE) {
        next.weight *= next.density * TWO_PI;
        next.density = INV_TWO_PI;
    }
    if (WHITTED) next.goes = next.goes && next.density < 0.0;
    path.direction = next.direction;
    path.density = next.density / several;  // to be weighed against one of the samples
    path.throughput *= next.weight;
    path.origin = leaving(s, next.direction);
    path.source = slot;
    path.depth += 1u;
#ifdef GUIDED
    // Guided paths have small throughputs where much light is to come: roulette by these would end just them. What
    // comes to a rough surface again found no caustic.
    path.reach = (wide ? before : path.reach) * unguided;
    const float keep = rouletteChance(max(path.reach, largestOf(path.throughput)), path.depth, next.density < 0.0);
    path.reach /= keep;
#else
    const float keep = rouletteChance(largestOf(path.throughput), path.depth, next.density < 0.0);
#endif
    alive = alive && next.goes && unitFloat(choice.y) < keep;
    path.throughput /= keep;
    return alive;
}
#endif
