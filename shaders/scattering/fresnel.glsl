// Fresnel's equations: how much of unpolarised light a smooth interface reflects.
#ifndef SHADERS_SCATTERING_FRESNEL_GLSL
#define SHADERS_SCATTERING_FRESNEL_GLSL
#include "shaders/shared/real.glsl"

/// Reflectance of a dielectric. `eta` is the index beyond the interface over the index on the side of incidence,
/// `cosine` >= 0 of the angle of incidence. `cosineBeyond` of the refracted ray is 0 where all is reflected.
/// With g = eta cos t = sqrt((eta^2 - 1) + c^2): Rs = ((c - g)/(c + g))^2, whose numerator is -(eta^2 - 1)/(c + g),
/// and Rp's is (eta^2 - 1)(c (c + g) - 1)/(c + g): no difference of neighbours is left as eta goes to 1.
FN Real fresnelDielectric(Real cosine, Real eta, OUT(Real) cosineBeyond) {
    Real c = min(cosine, 1.0);
    Real excess = (eta - 1.0) * (eta + 1.0);
    Real squared = excess + c * c;
    Real g = sqrt(max(squared, 0.0));
    cosineBeyond = min(g / eta, 1.0);
    Real sum = max(c + g, REAL_MIN_NORMAL);
    Real s = excess / sum / sum;
    Real p = excess * (c * sum - 1.0) / sum / max(eta * eta * c + g, REAL_MIN_NORMAL);
    Real reflectance = 0.5 * (s * s + p * p);
    // Grazing at eta = 1 leaves 0 / 0 in the limit: there is no interface.
    return eta == 1.0 ? Real(0.0) : squared <= 0.0 ? Real(1.0) : min(reflectance, 1.0);
}
FN Real fresnelDielectric(Real cosine, Real eta) {
    Real ignored;
    return fresnelDielectric(cosine, eta, ignored);
}

/// What an interface lets through, from the cosines on both sides: keeps its digits where it is small.
FN Real fresnelTransmittance(Real cosine, Real cosineBeyond, Real eta) {
    Real product = 4.0 * eta * cosine * cosineBeyond;
    Real s = cosine + eta * cosineBeyond, p = eta * cosine + cosineBeyond;
    return product > 0.0 ? min(0.5 * product * (1.0 / (s * s) + 1.0 / (p * p)), 1.0) : Real(0.0);
}

/// Reflectance of a conductor of index n + i k over the index on the side of incidence. Born and Wolf, "Principles
/// of optics", 14.2. With n^2 - k^2 - sin^2 = t: a^2 = (hypot(t, 2nk) + t)/2, for t < 0 by its conjugate.
FN Real fresnelConductor(Real cosine, Real n, Real k) {
    Real c = min(cosine, 1.0), cc = c * c, ss = 1.0 - cc;
    Real t = n * n - k * k - ss;
    Real nk = 2.0 * n * k;
    Real m = sqrt(t * t + nk * nk);
    Real aa = t < 0.0 ? 0.5 * nk * nk / max(m - t, REAL_MIN_NORMAL) : 0.5 * (m + t);
    Real twoAc = 2.0 * c * sqrt(max(aa, 0.0));
    Real s = (m + cc - twoAc) / max(m + cc + twoAc, REAL_MIN_NORMAL);
    Real p = s * (m * cc + ss * ss - twoAc * ss) / max(m * cc + ss * ss + twoAc * ss, REAL_MIN_NORMAL);
    return clamp(0.5 * (s + p), 0.0, 1.0);
}
FN Vec3 fresnelConductor(Real cosine, Vec3 n, Vec3 k) {
    return Vec3(fresnelConductor(cosine, n.x, k.x), fresnelConductor(cosine, n.y, k.y),
                fresnelConductor(cosine, n.z, k.z));
}

/// (1 - c)^5 for c in [0, 1].
FN Real schlickWeight(Real cosine) {
    Real x = clamp(1.0 - cosine, 0.0, 1.0), x2 = x * x;
    return x2 * x2 * x;
}
/// Schlick, "An inexpensive BRDF model for physically-based rendering", 1994, with the reflectances at normal
/// incidence and at grazing.
FN Real fresnelSchlick(Real f0, Real f90, Real cosine) { return f0 + (f90 - f0) * schlickWeight(cosine); }
FN Vec3 fresnelSchlick(Vec3 f0, Vec3 f90, Real cosine) { return f0 + (f90 - f0) * schlickWeight(cosine); }

/// Reflectance at normal incidence of an interface.
FN Real normalReflectance(Real eta) {
    Real r = (eta - 1.0) / (eta + 1.0);
    return r * r;
}

/// Cosine of the angle on the side of the smaller index, 0 where all is reflected: Schlick's approximation is in
/// that angle, whichever side the light comes from.
FN Real schlickCosine(Real cosine, Real eta) {
    if (eta >= 1.0) return cosine;
    Real squared = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    return sqrt(max(squared, 0.0));
}
/// Schlick's approximation of fresnelDielectric: at most 0.0599, 0.0357, 0.0444 off at eta = 1.33, 1.5, 2.
FN Real fresnelSchlickDielectric(Real cosine, Real eta) {
    return fresnelSchlick(normalReflectance(eta), 1.0, schlickCosine(cosine, eta));
}

#endif
