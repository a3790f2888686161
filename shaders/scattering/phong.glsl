// Phong's and Blinn's lobes, normalised. Lafortune and Willems, "Using the modified Phong reflectance model for
// physically based rendering", 1994. Both are reciprocal; the albedo at normal incidence is `reflectance`
// (Blinn) or at most that (Phong), nowhere more.
#ifndef SHADERS_SCATTERING_PHONG_GLSL
#define SHADERS_SCATTERING_PHONG_GLSL
#include "shaders/scattering/scatter.glsl"
#include "shaders/shared/exponential.glsl"

/// c^n for c in (0, 1], n >= 0; nothing behind.
FN Real lobePower(Real c, Real n) {
    if (c <= 0.0) return 0.0;
    Real exponent = n * realLog(c);
    return exponent < -87.0 ? Real(0.0) : realExp(exponent);
}
/// A cosine whose density is (n + 1) c^n.
FN Real samplePower(Real u, Real n) { return realExp(realLog(max(1.0 - u, REAL(1e-8))) / (n + 1.0)); }

/// f = reflectance (n + 2)/(2 pi) cos^n of the angle to the mirror direction: albedo is `reflectance` from above.
FN ScatterValue phongValue(Vec3 reflectance, Real n, Vec3 wo, Vec3 wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    Real lobe = lobePower(clamp(dot(mirrored(wo), wi), 0.0, 1.0), n) * INV_TWO_PI;
    return ScatterValue(reflectance * ((n + 2.0) * lobe * wi.z), (n + 1.0) * lobe);
}
FN Vec3 phongDirection(Real n, Vec3 wo, Vec3 u) {
    Real c = samplePower(u.x, n), s = sqrt(max(1.0 - c * c, 0.0));
    Real sine, cosine;
    sinCosTurns(u.y, sine, cosine);
    Vec3 axis = mirrored(wo), x, y;
    orthonormalBasis(axis, x, y);
    return x * (s * cosine) + y * (s * sine) + axis * c;
}
FN ScatterSample phongSample(Vec3 reflectance, Real n, Vec3 wo, Vec3 u) {
    Vec3 wi = phongDirection(n, wo, u);
    return sampleOf(wi, phongValue(reflectance, n, wo, wi));
}

/// What makes the albedo of cos^n of the half vector 1 from above: (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)).
FN Real blinnPhongNorm(Real n) {
    Real tail = n > 250.0 ? Real(0.0) : realExp2(-0.5 * n);
    return (n + 2.0) / (tail + n) * (n + 4.0) * (0.125 * INV_PI);
}
FN ScatterValue blinnPhongValue(Vec3 reflectance, Real n, Vec3 wo, Vec3 wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    Vec3 h = normalizeSafe(wo + wi, Vec3(0.0, 0.0, 1.0));
    Real lobe = lobePower(min(h.z, 1.0), n);
    return ScatterValue(reflectance * (blinnPhongNorm(n) * lobe * wi.z),
                        (n + 1.0) * INV_TWO_PI * lobe / (4.0 * max(dot(wo, h), REAL(1e-6))));
}
FN Vec3 blinnPhongDirection(Real n, Vec3 wo, Vec3 u) {
    Real c = samplePower(u.x, n), s = sqrt(max(1.0 - c * c, 0.0));
    Real sine, cosine;
    sinCosTurns(u.y, sine, cosine);
    return reflectedAbout(wo, Vec3(s * cosine, s * sine, c));
}
FN ScatterSample blinnPhongSample(Vec3 reflectance, Real n, Vec3 wo, Vec3 u) {
    Vec3 wi = blinnPhongDirection(n, wo, u);
    return sampleOf(wi, blinnPhongValue(reflectance, n, wo, wi));
}

#endif
