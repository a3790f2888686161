#ifndef SHADERS_SCATTERING_FACET_WALK_GLSL
#define SHADERS_SCATTERING_FACET_WALK_GLSL
/** @file
 * Light between the facets of a tilted normal (tilted_facets.glsl), followed from facet to facet until it leaves.
 *
 * Includers define SurfaceBsdf, with the members `frame` (the last column is the normal of the tilted facets) and `wo`
 * (local), localValue(SurfaceBsdf, wi), localDirection(SurfaceBsdf, u) and the constant HAS_LIGHT_THROUGH.
 */
#include "shaders/sampling/hash.glsl"
#include "shaders/scattering/scatter.glsl"
#include "shaders/scattering/tilted_facets.glsl"

/** Tilted facets that light meets at most: after the last it leaves, what is sent under the surface mirrored at it. That
 * loses no light either but is not reciprocal; fewer than one in a thousand come so far, but for the steepest tilts. */
const uint FACET_TURNS = 32u;

/** Light that comes out: in the world, with the density of its direction given all that came before. */
struct FacetWalk {
    vec3 direction;
    vec3 weight;
    float density;  ///< negative: one of a finite set of directions
    vec3 lit;       ///< value of the direction to a light, each facet's weighted by the balance heuristic
};

/**
 * Walks from the first tilted facet on, that `bsdf` is seen at, where `drawn` has been drawn. `folds`: as if that
 * facet were the last. `lightDensity`: of the unit vector toLight as a light's sample, 0 or less for lights that no
 * direction drawn finds. `key`: of the random numbers.
 */
FacetWalk walkFacets(SurfaceBsdf bsdf, TiltedFacets f, bool folds, uint key, vec3 toLight, const bool asks, float lightDensity,
                     ScatterSample drawn) {
    FacetWalk walk = FacetWalk(f.surface, vec3(1.0), 0.0, vec3(0.0));
    bool between = true;
    [[dont_unroll]] for (uint turn = folds ? FACET_TURNS - 1u : 0u; between && turn < FACET_TURNS; ++turn) {
        const bool last = turn + 1u == FACET_TURNS;
        // What is drawn under the facet it is drawn on is lost.
        const bool goes = drawn.density != 0.0 && (last || drawn.direction.z > 0.0);
        const vec3 sent = normalize(bsdf.frame * drawn.direction), beyond = mirroredUpright(f, sent);
        const float height = dot(f.surface, sent), atOnce = leavesFacets(f, sent);
        key = hashUint(key + 0x9e3779b9u);
        const float u = unitFloat(key);
        const bool leaves = last || !goes || u < atOnce + (1.0 - atOnce) * leavesFacets(f, beyond);
        walk.direction = !leaves || u < atOnce ? sent : beyond;
        if (last) walk.direction = (height > 0.0) == (drawn.direction.z > 0.0) ? sent : sent - 2.0 * height * f.surface;

        ScatterValue lit = noScattering(), way = noScattering();
        [[dont_unroll]] for (int i = asks ? 0 : 2; i < 4; ++i) {
            const bool isDrawn = i >= 2, mirrors = (i & 1) == 1;
            const vec3 wi = isDrawn ? walk.direction : toLight;
            const float above = dot(f.surface, wi);
            vec3 from = wi;
            if (mirrors) from = last ? wi - 2.0 * above * f.surface : mirroredUpright(f, wi);
            const vec3 local = from * bsdf.frame;
            float share = mirrors ? leavesByUpright(f, wi) : leavesFacets(f, wi);
            if (isDrawn && !leaves) share = mirrors ? 0.0 : 1.0;
            if (last) share = (local.z > 0.0) == (above > 0.0) && (HAS_LIGHT_THROUGH || above > 0.0) ? 1.0 : 0.0;
            if (!last && !(local.z > 0.0)) share = 0.0;
            const ScatterValue v = localValue(bsdf, local);
            if (share > 0.0 && isDrawn) way = ScatterValue(way.value + share * v.value, way.density + share * v.density);
            if (share > 0.0 && !isDrawn) lit = ScatterValue(lit.value + share * v.value, lit.density + share * v.density);
        }
        if (asks) walk.lit += walk.weight * lit.value * (lightDensity > 0.0 ? lightDensity / (lightDensity + lit.density) : 1.0);
        const vec3 judged = way.density > 0.0 ? way.value / way.density : vec3(0.0);
        walk.weight *= drawn.density < 0.0 ? drawn.weight : (goes ? judged : vec3(0.0));
        walk.density = drawn.density < 0.0 ? -1.0 : way.density;
        between = !leaves && maxComponent(walk.weight) > 0.0;
        bsdf.wo = -beyond * bsdf.frame;
        bsdf.wo.z = max(bsdf.wo.z, 1e-6);
        const uvec3 bits = pcg3d(uvec3(key, turn, 0x68bc21ebu));
        if (between) drawn = localDirection(bsdf, vec3(unitFloat(bits.x), unitFloat(bits.y), unitFloat(bits.z)));
    }
    return walk;
}
#endif
