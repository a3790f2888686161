#ifndef SHADERS_SCATTERING_MULTIPLE_SCATTERING_GLSL
#define SHADERS_SCATTERING_MULTIPLE_SCATTERING_GLSL
/** @file
 * Light reflected several times between GGX facets, which a single reflection's model loses: Kulla and Conty,
 * "Revisiting physically based shading at Imageworks", SIGGRAPH 2017 course. With E the albedo of facets that reflect
 * all light and E_avg its cosine-weighted mean, (1 - E(wo)) (1 - E(wi)) / (pi (1 - E_avg)) makes up all that is
 * lost; a metal of mean reflectance F colours it by F^2 E_avg / (1 - F (1 - E_avg)).
 *
 * Includers define ggxAlbedo(cosine, alpha) and ggxMeanAlbedo(alpha).
 */
#include "shaders/scattering/fresnel.glsl"
#include "shaders/scattering/microfacet.glsl"

/** One width for facets wider one way. */
float meanAlpha(Microfacets m) {
    return sqrt(m.alpha.x * m.alpha.y);
}

/** Cosine-weighted mean of a conductor's reflectance by four Gauss-Legendre nodes of c^2: within 2e-3. */
vec3 meanConductor(vec3 n, vec3 k) {
    return 0.173927423 * fresnelConductor(0.263499, n, k) + 0.326072577 * fresnelConductor(0.574464, n, k) +
           0.326072577 * fresnelConductor(0.818530, n, k) + 0.173927423 * fresnelConductor(0.964660, n, k);
}

/** Chance that a direction is drawn by its cosine instead: what the single reflection loses. */
float compensatedShare(Microfacets m, vec3 wo) {
    return clamp(1.0 - ggxAlbedo(wo.z, meanAlpha(m)), 0.0, 1.0);
}
ScatterValue compensatedValue(ScatterValue single, vec3 n, vec3 k, Microfacets m, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0 || wi.z <= 0.0 || smoothFacets(m)) return single;
    const float alpha = meanAlpha(m), mean = ggxMeanAlbedo(alpha);
    const float lost = (1.0 - ggxAlbedo(wo.z, alpha)) * (1.0 - ggxAlbedo(wi.z, alpha));
    const vec3 f = meanConductor(n, k);
    const vec3 color = f * f * mean / (vec3(1.0) - f * (1.0 - mean));
    const float share = compensatedShare(m, wo);
    return ScatterValue(single.value + color * (lost * wi.z * INV_PI / max(1.0 - mean, 1e-4)),
                        mix(single.density, wi.z * INV_PI, share));
}
#endif
