// Beckmann's distribution of microfacet normals (Gaussian slopes) with Smith's height-correlated masking; the
// functions are those of ggx.glsl. Walter et al., EGSR 2007.
#ifndef SHADERS_SCATTERING_BECKMANN_GLSL
#define SHADERS_SCATTERING_BECKMANN_GLSL
#include "shaders/scattering/scatter.glsl"
#include "shaders/shared/error_function.glsl"
#include "shaders/shared/exponential.glsl"

CONST Real INV_SQRT_PI = REAL(0.564189583547756286948);

FN Real beckmannNormals(Vec3 h, Vec2 alpha) {
    if (!(h.z > 0.0)) return 0.0;
    Real x = h.x / (alpha.x * h.z), y = h.y / (alpha.y * h.z), zz = h.z * h.z;
    Real exponent = x * x + y * y;
    // Below this, also where h.z^4 is no normal number.
    return exponent > 80.0 || zz < REAL(1e-18) ? Real(0.0) : realExp(-exponent) / (PI * alpha.x * alpha.y * zz * zz);
}

/// Smith's Lambda times |w.z|, finite at grazing: with a = |w.z| / |(alpha.x w.x, alpha.y w.y)|,
/// Lambda = (erf a - 1 + exp(-a^2) / (a sqrt pi)) / 2.
FN Real beckmannMaskingTerm(Vec3 w, Vec2 alpha) {
    Real z = abs(w.z);
    Real across = hypot(alpha.x * w.x, alpha.y * w.y);
    if (z > 6.0 * across) return 0.0;  // Lambda < 1e-17
    Real a = z / across;
    return max(0.5 * (realExp(-a * a) * across * INV_SQRT_PI - z * (1.0 - realErf(a))), 0.0);
}

/// G2 |wi.z| / (4 |wo.z| |wi.z|) = |wi.z| / (4 (|wo.z wi.z| + Lo |wi.z| + Li |wo.z|)), L the terms above.
FN Real beckmannShadowing(Vec3 wo, Vec3 wi, Vec2 alpha) {
    Real ci = abs(wi.z), co = abs(wo.z);
    Real sum = co * ci + beckmannMaskingTerm(wo, alpha) * ci + beckmannMaskingTerm(wi, alpha) * co;
    return sum > 0.0 ? 0.25 * ci / sum : Real(0.0);
}

FN Real beckmannVisibleNormals(Vec3 wo, Vec3 h, Vec2 alpha) {
    return max(dot(wo, h), 0.0) * beckmannNormals(h, alpha) / (wo.z + beckmannMaskingTerm(wo, alpha));
}
FN Real beckmannReflectedDensity(Vec3 wo, Vec3 h, Vec2 alpha) {
    return beckmannNormals(h, alpha) / (4.0 * (wo.z + beckmannMaskingTerm(wo, alpha)));
}

/// Slope along the direction of view, for unit width and tangent t > 0 of the angle of view. Its distribution
/// function, with b = erf(slope), is (1 + b + t exp(-slope^2) / sqrt pi) / norm on slopes below 1/t: inverted by
/// Newton's method kept in a bracket. Heitz and d'Eon, "Importance sampling microfacet-based BSDFs using the
/// distribution of visible normals", EGSR 2014; first guess of Jakob, "An improved visible normal sampling routine
/// for the Beckmann distribution", 2014.
FN Real beckmannVisibleSlope(Real tangent, Real cosine, Real u) {
    Real cotangent = 1.0 / tangent;
    Real low = -1.0, high = cotangent > 4.0 ? Real(1.0) : realErf(cotangent);
    Real edge = cotangent > 9.0 ? Real(0.0) : realExp(-cotangent * cotangent);
    Real norm = 1.0 + high + INV_SQRT_PI * tangent * edge;
    Real angle = realAcos(min(cosine, 1.0));
    Real fit = 1.0 + angle * (REAL(-0.876) + angle * (REAL(0.4265) - REAL(0.0594) * angle));
    Real b = high - (1.0 + high) * powPositive(1.0 - u, fit);
    Real slope = 0.0;
    for (int i = 0; i < 12; ++i) {
        b = b > low && b < high ? b : 0.5 * (low + high);
        slope = realErfInverse(clamp(b, REAL(-0.9999999), REAL(0.9999999)));
        Real miss = (1.0 + b + INV_SQRT_PI * tangent * realExp(-slope * slope)) / norm - u;
        low = miss > 0.0 ? low : b;
        high = miss > 0.0 ? b : high;
        Real derivative = (1.0 - slope * tangent) / norm;
        b -= derivative > REAL(1e-9) ? miss / derivative : Real(4.0);
    }
    return slope;
}

FN Vec3 beckmannSampleNormal(Vec3 wo, Vec2 alpha, Vec2 u) {
    Vec3 w = normalize(Vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    Real sine = sqrt(w.x * w.x + w.y * w.y);
    Real along, across;
    if (sine < REAL(1e-3) * w.z) {
        // Seen from above, slopes are the Gaussian's own.
        Real radius = sqrt(-realLog1p(-u.x));
        Real s, c;
        sinCosTurns(u.y, s, c);
        along = radius * c;
        across = radius * s;
    } else {
        along = beckmannVisibleSlope(sine / max(w.z, REAL(1e-7)), w.z, max(u.x, REAL(1e-7)));
        across = realErfInverse(clamp(2.0 * u.y - 1.0, REAL(-0.9999999), REAL(0.9999999)));
    }
    Real cosine = sine > 0.0 ? w.x / sine : Real(1.0), sinePhi = sine > 0.0 ? w.y / sine : Real(0.0);
    Real x = cosine * along - sinePhi * across, y = sinePhi * along + cosine * across;
    return normalize(Vec3(-alpha.x * x, -alpha.y * y, 1.0));
}

/// Reflection with reflectance 1, and its density under beckmannSampleNormal.
FN ScatterValue beckmannReflection(Vec3 wo, Vec3 wi, Vec2 alpha, OUT(Vec3) h) {
    h = normalizeSafe(wo + wi, Vec3(0.0, 0.0, 1.0));
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    return ScatterValue(Vec3(beckmannNormals(h, alpha) * beckmannShadowing(wo, wi, alpha)),
                        beckmannReflectedDensity(wo, h, alpha));
}

#endif
