#ifndef SHADERS_SCATTERING_MULTIPLE_SCATTERING_GLSL
#define SHADERS_SCATTERING_MULTIPLE_SCATTERING_GLSL
/** @file
 * Light scattered several times between facets, which a single scattering's model loses: Kulla and Conty,
 * "Revisiting physically based shading at Imageworks", SIGGRAPH 2017 course. With E the albedo of one scattering by
 * facets that absorb nothing and E_avg its cosine-weighted mean, (1 - E(wo)) (1 - E(wi)) / (pi (1 - E_avg)) makes up
 * all that is lost. A metal of mean reflectance F colours it by F^2 E_avg / (1 - F (1 - E_avg)). At an interface a
 * share x of it leaves on the side it came from and t = 1 - x on the other, where E and E_avg are that side's; with
 * n^2 the ratio of the squared indices, t (1 - E_avg) on one side is n^2 t (1 - E_avg) on the other, as reciprocity
 * asks.
 *
 * Includers define lossTexel(i): passes/scene/facet_losses.cpp makes the table. Texel 0: a metal's colour over
 * 1 - E_avg; of an interface x / (1 - E_avg) and t / (1 - E_avg of the other side) seen from outside, then from inside;
 * 1: x seen from outside, from inside; from 2: E at the ends of a cell of the square root of the cosine, from outside,
 * from inside.
 */
#include "shaders/scattering/scatter.glsl"

const int LOSS_CELLS = 47;  // kLossNodes - 1

/** 1 - E on both sides, x outside. */
vec2 facetLoss(int table, float cosine) {
    const float at = sqrt(clamp(cosine, 0.0, 1.0)) * float(LOSS_CELLS);
    const float cell = min(floor(at), float(LOSS_CELLS - 1)), f = at - cell;
    const vec4 ends = lossTexel(table + 2 + int(cell));
    return clamp(vec2(1.0) - mix(ends.xz, ends.yw, f), 0.0, 1.0);
}

/** Chance that a direction is drawn by its cosine instead: what the single scattering loses. */
float compensatedShare(int table, bool inside, vec3 wo) {
    const vec2 lost = facetLoss(table, wo.z);
    return inside ? lost.y : lost.x;
}

/** The part of reflection, of light from wi with wo above. */
ScatterValue compensatedConductor(ScatterValue single, int table, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0 || wi.z <= 0.0) return single;
    const float share = facetLoss(table, wo.z).x;
    const float lost = share * facetLoss(table, wi.z).x * wi.z * INV_PI;
    return ScatterValue(single.value + lossTexel(table).rgb * lost, mix(single.density, wi.z * INV_PI, share));
}

ScatterValue compensatedDielectric(ScatterValue single, int table, bool inside, float eta, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0) return single;
    const vec4 weights = lossTexel(table);
    const vec2 reflected = lossTexel(table + 1).xy, here = inside ? weights.zw : weights.xy;
    const float share = compensatedShare(table, inside, wo);
    const vec2 sides = facetLoss(table, abs(wi.z));
    const bool through = wi.z < 0.0;
    const float lost = share * (inside != through ? sides.y : sides.x);
    const float c = abs(wi.z) * INV_PI, x = inside ? reflected.y : reflected.x;
    const float weight = through ? here.y / (eta * eta) : here.x;
    return ScatterValue(single.value + weight * lost * c, mix(single.density, c * (through ? 1.0 - x : x), share));
}

/** A direction of the compensating part alone, where u.z is below compensatedShare (`share`). */
vec3 compensatedDirection(int table, bool isInterface, bool inside, float share, vec3 u) {
    vec3 wi = cosineHemisphere(u.xy);
    if (isInterface) {
        const vec2 reflected = lossTexel(table + 1).xy;
        if (u.z >= share * (inside ? reflected.y : reflected.x)) wi.z = -wi.z;
    }
    return wi;
}
#endif
