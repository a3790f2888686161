// Mirrors and metals: reflection at a smooth or rough interface of index n + i k.
#ifndef SHADERS_SCATTERING_CONDUCTOR_GLSL
#define SHADERS_SCATTERING_CONDUCTOR_GLSL
#include "shaders/scattering/fresnel.glsl"
#include "shaders/scattering/microfacet.glsl"

/// An ideal mirror of a given reflectance.
FN ScatterSample mirrorSample(Vec3 reflectance, Vec3 wo) { return ScatterSample(mirrored(wo), reflectance, -1.0); }

FN ScatterValue conductorValue(Vec3 n, Vec3 k, Microfacets m, Vec3 wo, Vec3 wi) {
    if (smoothFacets(m)) return noScattering();
    Vec3 h;
    ScatterValue v = facetReflection(m, wo, wi, h);
    return ScatterValue(v.value * fresnelConductor(clamp(dot(wo, h), 0.0, 1.0), n, k), v.density);
}
/// A mirror, or a direction to be judged by conductorValue.
FN ScatterSample conductorDirection(Vec3 n, Vec3 k, Microfacets m, Vec3 wo, Vec3 u) {
    if (smoothFacets(m)) return mirrorSample(fresnelConductor(wo.z, n, k), wo);
    return unjudged(reflectedAbout(wo, facetSampleNormal(m, wo, Vec2(u.x, u.y))));
}
FN ScatterSample conductorSample(Vec3 n, Vec3 k, Microfacets m, Vec3 wo, Vec3 u) {
    ScatterSample s = conductorDirection(n, k, m, wo, u);
    if (s.density < 0.0) return s;
    return sampleOf(s.direction, conductorValue(n, k, m, wo, s.direction));
}

#endif
