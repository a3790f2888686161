// A choice of microfacet distribution.
#ifndef SHADERS_SCATTERING_MICROFACET_GLSL
#define SHADERS_SCATTERING_MICROFACET_GLSL
#include "shaders/scattering/beckmann.glsl"
#include "shaders/scattering/ggx.glsl"

struct Microfacets {
    Vec2 alpha;     // widths along x and y; SMOOTH_ALPHA and less: a mirror
    bool beckmann;  // else GGX
};

FN bool smoothFacets(Microfacets m) { return max(m.alpha.x, m.alpha.y) < SMOOTH_ALPHA; }

FN Real facetNormals(Microfacets m, Vec3 h) {
    return m.beckmann ? beckmannNormals(h, m.alpha) : ggxNormals(h, m.alpha);
}
FN Real facetShadowing(Microfacets m, Vec3 wo, Vec3 wi) {
    return m.beckmann ? beckmannShadowing(wo, wi, m.alpha) : ggxShadowing(wo, wi, m.alpha);
}
FN Real facetVisibleNormals(Microfacets m, Vec3 wo, Vec3 h) {
    return m.beckmann ? beckmannVisibleNormals(wo, h, m.alpha) : ggxVisibleNormals(wo, h, m.alpha);
}
FN Vec3 facetSampleNormal(Microfacets m, Vec3 wo, Vec2 u) {
    if (m.beckmann) return beckmannSampleNormal(wo, m.alpha, u);
    return ggxSampleNormal(wo, m.alpha, u);
}
FN ScatterValue facetReflection(Microfacets m, Vec3 wo, Vec3 wi, OUT(Vec3) h) {
    if (m.beckmann) return beckmannReflection(wo, wi, m.alpha, h);
    return ggxReflection(wo, wi, m.alpha, h);
}

/// Reflection with reflectance 1 alone.
FN ScatterValue facetValue(Microfacets m, Vec3 wo, Vec3 wi) {
    Vec3 h;
    if (smoothFacets(m)) return noScattering();
    return facetReflection(m, wo, wi, h);
}
FN ScatterSample facetSample(Microfacets m, Vec3 wo, Vec3 u) {
    if (smoothFacets(m)) return ScatterSample(mirrored(wo), Vec3(1.0), -1.0);
    Vec3 wi = reflectedAbout(wo, facetSampleNormal(m, wo, Vec2(u.x, u.y)));
    return sampleOf(wi, facetValue(m, wo, wi));
}

/// Chance density of a wi refracted at the normal h, of index ratio eta, per density of h: the solid angle of h
/// that gives wi's. Walter et al., EGSR 2007, eq. 17.
FN Real refractionJacobian(Real wiH, Real woH, Real eta) {
    Real root = wiH + woH / eta;
    return abs(wiH) / max(root * root, REAL_MIN_NORMAL);
}
/// Half vector of refraction on the upper side.
FN Vec3 refractionNormal(Vec3 wo, Vec3 wi, Real eta) {
    Vec3 h = normalizeSafe(wo + eta * wi, Vec3(0.0, 0.0, 1.0));
    return h.z < 0.0 ? -h : h;
}
/// wi refracted at h; cosineBeyond is that of fresnelDielectric.
FN Vec3 refractedAbout(Vec3 wo, Vec3 h, Real eta, Real cosineBeyond) {
    return (dot(wo, h) / eta - cosineBeyond) * h - wo / eta;
}
/// Transmission with transmittance 1, and its density under facetSampleNormal. For radiance: over eta^2.
FN ScatterValue facetTransmission(Microfacets m, Vec3 wo, Vec3 wi, Real eta, OUT(Vec3) h) {
    h = refractionNormal(wo, wi, eta);
    Real woH = dot(wo, h), wiH = dot(wi, h);
    if (!(wo.z > 0.0) || !(wi.z < 0.0) || !(woH > 0.0) || !(wiH < 0.0)) return noScattering();
    Real jacobian = refractionJacobian(wiH, woH, eta);
    // G2 woH / wo.z = 4 woH facetShadowing, which holds |wi.z| / |wi.z|.
    Real value = 4.0 * woH * facetNormals(m, h) * facetShadowing(m, wo, wi) * jacobian / (eta * eta);
    return ScatterValue(Vec3(value), facetVisibleNormals(m, wo, h) * jacobian);
}

#endif
