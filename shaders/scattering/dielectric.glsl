// Glass, water: an interface between two dielectrics, smooth or rough, and a thin pane of two such interfaces.
// eta: index beyond the interface over the index on wo's side.
#ifndef SHADERS_SCATTERING_DIELECTRIC_GLSL
#define SHADERS_SCATTERING_DIELECTRIC_GLSL
#include "shaders/scattering/fresnel.glsl"
#include "shaders/scattering/microfacet.glsl"

/// Exact, or Schlick's approximation of it.
FN Real dielectricReflectance(Real cosine, Real eta, bool schlick, OUT(Real) cosineBeyond) {
    Real exact = fresnelDielectric(cosine, eta, cosineBeyond);
    return schlick && eta != 1.0 ? fresnelSchlickDielectric(cosine, eta) : exact;
}

/// Facets deflect what goes through by about alpha (eta - 1): as narrow as a smooth surface's lobe, it counts as one.
FN bool smoothInterface(Microfacets m, Real eta) {
    return smoothFacets(m) || max(m.alpha.x, m.alpha.y) * abs(eta - 1.0) < 0.25 * SMOOTH_ALPHA;
}

FN ScatterValue dielectricValue(Real eta, Microfacets m, bool schlick, Vec3 wo, Vec3 wi) {
    if (smoothInterface(m, eta)) return noScattering();
    Vec3 h;
    Real beyond;
    ScatterValue reflected = facetReflection(m, wo, wi, h);
    Real r = dielectricReflectance(clamp(dot(wo, h), 0.0, 1.0), eta, schlick, beyond);
    ScatterValue through = facetTransmission(m, wo, wi, eta, h);
    Real cosine = clamp(dot(wo, h), 0.0, 1.0), across = clamp(-dot(wi, h), 0.0, 1.0);
    Real t = schlick ? 1.0 - fresnelSchlick(normalReflectance(eta), 1.0, min(cosine, across))
                     : fresnelTransmittance(cosine, across, eta);
    return ScatterValue(r * reflected.value + t * through.value, r * reflected.density + t * through.density);
}
/// A mirrored or refracted direction, or one to be judged by dielectricValue, or none.
FN ScatterSample dielectricDirection(Real eta, Microfacets m, bool schlick, Vec3 wo, Vec3 u) {
    bool isSmooth = smoothInterface(m, eta);
    Vec3 h = Vec3(0.0, 0.0, 1.0);
    if (!isSmooth) h = facetSampleNormal(m, wo, Vec2(u.x, u.y));
    Real beyond;
    Real r = dielectricReflectance(clamp(dot(wo, h), 0.0, 1.0), eta, schlick, beyond);
    bool reflects = u.z < r;
    Vec3 wi = reflects ? reflectedAbout(wo, h) : normalize(refractedAbout(wo, h, eta, beyond));
    if (isSmooth) return ScatterSample(wi, Vec3(reflects ? Real(1.0) : 1.0 / (eta * eta)), -1.0);
    // Mirrored downwards or bent upwards: what a second facet would take, which this model does not follow.
    if (reflects != (wi.z > 0.0)) return noSample();
    return unjudged(wi);
}
FN ScatterSample dielectricSample(Real eta, Microfacets m, bool schlick, Vec3 wo, Vec3 u) {
    ScatterSample s = dielectricDirection(eta, m, schlick, wo, u);
    if (s.density <= 0.0) return s;
    return sampleOf(s.direction, dielectricValue(eta, m, schlick, wo, s.direction));
}

/// Reflectance of a pane of both interfaces with all reflections between them and no absorption.
FN Real paneReflectance(Real r) { return 2.0 * r / (1.0 + r); }

/// A pane so thin that light goes on in line: reflects paneReflectance, lets the rest through.
FN ScatterSample paneSample(Real eta, Vec3 tint, Vec3 wo, Vec3 u) {
    Real r = paneReflectance(fresnelDielectric(wo.z, eta));
    bool reflects = u.z < r;
    return ScatterSample(reflects ? mirrored(wo) : -wo, reflects ? Vec3(1.0) : tint, -1.0);
}

#endif
