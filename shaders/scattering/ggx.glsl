// The GGX (Trowbridge-Reitz) distribution of microfacet normals with Smith's height-correlated masking. Walter et
// al., "Microfacet models for refraction through rough surfaces", EGSR 2007; Heitz, "Understanding the
// masking-shadowing function in microfacet-based BRDFs", JCGT 3(2), 2014. alpha: width along x and y, above 0.
#ifndef SHADERS_SCATTERING_GGX_GLSL
#define SHADERS_SCATTERING_GGX_GLSL
#include "shaders/scattering/scatter.glsl"

/// Density of normals D per projected area, 1/sr: the integral of D cos is 1. Squares of h.x and h.y instead of
/// 1 - h.z^2, which would lose a narrow lobe's digits.
FN Real ggxNormals(Vec3 h, Vec2 alpha) {
    Real x = h.x / alpha.x, y = h.y / alpha.y;
    Real s = x * x + y * y + h.z * h.z;
    return h.z > 0.0 ? 1.0 / (PI * alpha.x * alpha.y * s * s) : Real(0.0);
}

/// |(alpha.x w.x, alpha.y w.y, w.z)|: Smith's masking is G1 = 2 |w.z| / (|w.z| + this).
FN Real ggxStretch(Vec3 w, Vec2 alpha) {
    return sqrt(square(alpha.x * w.x) + square(alpha.y * w.y) + w.z * w.z);
}

/// G2 |wi.z| / (4 |wo.z| |wi.z|), masking and shadowing correlated by height: finite at grazing angles.
FN Real ggxShadowing(Vec3 wo, Vec3 wi, Vec2 alpha) {
    Real ci = abs(wi.z), co = abs(wo.z);
    Real sum = ci * ggxStretch(wo, alpha) + co * ggxStretch(wi, alpha);
    return sum > 0.0 ? 0.5 * ci / sum : Real(0.0);
}
/// The same without correlation: G1(wo) G1(wi) / (4 |wo.z|).
FN Real ggxShadowingSeparable(Vec3 wo, Vec3 wi, Vec2 alpha) {
    Real ci = abs(wi.z), co = abs(wo.z);
    Real product = (co + ggxStretch(wo, alpha)) * (ci + ggxStretch(wi, alpha));
    return product > 0.0 ? ci / product : Real(0.0);
}

/// Density of the normals that wo sees, over solid angle of h.
FN Real ggxVisibleNormals(Vec3 wo, Vec3 h, Vec2 alpha) {
    return 2.0 * max(dot(wo, h), 0.0) * ggxNormals(h, alpha) / (wo.z + ggxStretch(wo, alpha));
}
/// Density of directions mirrored at such normals: the above over 4 wo.h.
FN Real ggxReflectedDensity(Vec3 wo, Vec3 h, Vec2 alpha) {
    return ggxNormals(h, alpha) / (2.0 * (wo.z + ggxStretch(wo, alpha)));
}

/// A normal of that density. Dupuy and Benyoub, "Sampling visible GGX normals with spherical caps", HPG 2023: the
/// normal of the stretched hemisphere is halfway between wo and a point of a spherical cap. Its height above the
/// plane is (1 - u)(1 + wo.z), free of cancellation and above 0.
FN Vec3 ggxSampleNormal(Vec3 wo, Vec2 alpha, Vec2 u) {
    Vec3 w = normalize(Vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    Real height = (1.0 - u.y) * (1.0 + w.z);
    Real z = height - w.z;
    Real radius = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
    Real s, c;
    sinCosTurns(u.x, s, c);
    return normalize(Vec3(alpha.x * (radius * c + w.x), alpha.y * (radius * s + w.y), height));
}

/// Reflection with reflectance 1, and its density under ggxSampleNormal.
FN ScatterValue ggxReflection(Vec3 wo, Vec3 wi, Vec2 alpha, OUT(Vec3) h) {
    h = normalizeSafe(wo + wi, Vec3(0.0, 0.0, 1.0));
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return noScattering();
    return ScatterValue(Vec3(ggxNormals(h, alpha) * ggxShadowing(wo, wi, alpha)), ggxReflectedDensity(wo, h, alpha));
}

#endif
