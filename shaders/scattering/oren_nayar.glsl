// Rough diffuse reflection: Oren and Nayar, "Generalization of Lambert's reflectance model", SIGGRAPH 1994, in the
// energy-conserving form of Fujii, "A tiny improvement of Oren-Nayar reflectance model", 2012 (the albedo of Oren and
// Nayar's own fit passes 1 by 0.75 %). roughness from 0 (Lambert) to 1; the albedo rises from
// a = 1 / (1 + (1/2 - 2/(3 pi)) roughness), seen from above, to 1 at grazing angles.
#ifndef SHADERS_SCATTERING_OREN_NAYAR_GLSL
#define SHADERS_SCATTERING_OREN_NAYAR_GLSL
#include "shaders/scattering/scatter.glsl"

FN ScatterValue orenNayarValue(Vec3 albedo, Real roughness, Vec3 wo, Vec3 wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    Real a = 1.0 / (1.0 + REAL(0.287793409) * roughness);
    // sin o sin i cos of the azimuth between, over the larger cosine where both are on one side.
    Real across = wo.x * wi.x + wo.y * wi.y;
    across = across > 0.0 ? across / max(wo.z, wi.z) : across;
    Real c = wi.z * INV_PI;
    return ScatterValue(albedo * (c * a * max(1.0 + roughness * across, 0.0)), c);
}
FN ScatterSample orenNayarSample(Vec3 albedo, Real roughness, Vec3 wo, Vec3 u) {
    Vec3 wi = cosineHemisphere(Vec2(u.x, u.y));
    return sampleOf(wi, orenNayarValue(albedo, roughness, wo, wi));
}

#endif
