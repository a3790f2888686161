// Sheen of cloth: the "Charlie" distribution of fibres with the fitted masking of Estevez and Kulla, "Production
// friendly microfacet sheen BRDF", SIGGRAPH 2017 course, as KHR_materials_sheen takes it: alpha = roughness^2.
// The fit is not bounded by 1: below a roughness of 0.3 its albedo at grazing angles passes 1 (0.3: 1.00, 0.1:
// 2.1), which layers on top of it take as 1.
#ifndef SHADERS_SCATTERING_SHEEN_GLSL
#define SHADERS_SCATTERING_SHEEN_GLSL
#include "shaders/scattering/scatter.glsl"
#include "shaders/shared/exponential.glsl"

/// Roughnesses below are taken as this: 1/alpha is the power of a sine.
CONST Real SHEEN_LEAST_ROUGHNESS = REAL(0.07);
/// Cosines below are taken as this: the model grows like their inverse.
CONST Real SHEEN_LEAST_COSINE = REAL(1e-7);

FN Real sheenFit(Real x, Real t) {
    Real a = mix(REAL(21.5473), REAL(25.3245), t), b = mix(REAL(3.82987), REAL(3.32435), t);
    Real c = mix(REAL(0.19823), REAL(0.16801), t), d = mix(REAL(-1.97760), REAL(-1.27393), t);
    Real e = mix(REAL(-4.32054), REAL(-4.85967), t);
    return a / (1.0 + b * powPositive(max(x, SHEEN_LEAST_COSINE), c)) + d * x + e;
}
/// Lambda of the masking.
FN Real sheenMasking(Real cosine, Real alpha) {
    Real t = square(1.0 - alpha);
    Real exponent = cosine < 0.5 ? sheenFit(cosine, t) : 2.0 * sheenFit(0.5, t) - sheenFit(1.0 - cosine, t);
    return realExp(exponent);
}
/// D of a half vector, by the square of its sine.
FN Real sheenFibres(Vec3 h, Real alpha) {
    Real inverse = 1.0 / alpha;
    Real ss = min(h.x * h.x + h.y * h.y, 1.0);
    Real lobe = ss > 0.0 ? realExp(max(0.5 * inverse * realLog(ss), -87.0)) : Real(0.0);
    return (2.0 + inverse) * INV_TWO_PI * lobe;
}

/// Sheen of colour 1, sampled by the cosine.
FN ScatterValue sheenValue(Real roughness, Vec3 wo, Vec3 wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    Real alpha = square(max(roughness, SHEEN_LEAST_ROUGHNESS));
    Vec3 h = normalizeSafe(wo + wi, Vec3(0.0, 0.0, 1.0));
    Real masked = 1.0 + sheenMasking(min(wo.z, 1.0), alpha) + sheenMasking(min(wi.z, 1.0), alpha);
    Real cosines = max(wo.z, SHEEN_LEAST_COSINE) * max(wi.z, SHEEN_LEAST_COSINE);
    return ScatterValue(Vec3(sheenFibres(h, alpha) / (masked * 4.0 * cosines) * wi.z), wi.z * INV_PI);
}
FN ScatterSample sheenSample(Real roughness, Vec3 wo, Vec3 u) {
    Vec3 wi = cosineHemisphere(Vec2(u.x, u.y));
    return sampleOf(wi, sheenValue(roughness, wo, wi));
}

#endif
