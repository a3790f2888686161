// Reflectance of an interface under a thin film: Belcour and Barla, "A practical extension to microfacet theory
// for the modeling of varying iridescence", SIGGRAPH 2017, as KHR_materials_iridescence takes it: Schlick's
// reflectances at both interfaces, phases of 0 or pi, two orders of interference, integrated over the spectrum by
// Gaussians fitted to the colour matching functions.
#ifndef SHADERS_SCATTERING_THIN_FILM_GLSL
#define SHADERS_SCATTERING_THIN_FILM_GLSL
#include "shaders/scattering/fresnel.glsl"
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/trigonometry.glsl"

/// Linear Rec.709 response to a cosine over frequency: `path` in metres, `shift` of each channel in radians.
FN Vec3 spectralResponse(Real path, Vec3 shift) {
    Real phase = TWO_PI * path;
    Real squared = phase * phase;
    // sqrt(2 pi variance) amplitude of the Gaussians of X, Y, Z and of X's second, over the sum of Y.
    Real x = REAL(0.846590) * realCos(REAL(1.6810e6) * phase + shift.x) * realExp(max(REAL(-4.3278e9) * squared, -87.0)) +
             REAL(0.153868) * realCos(REAL(2.2399e6) * phase + shift.x) * realExp(max(REAL(-4.5282e9) * squared, -87.0));
    Real y = REAL(1.000222) * realCos(REAL(1.7953e6) * phase + shift.y) * realExp(max(REAL(-9.3046e9) * squared, -87.0));
    Real z = REAL(1.001122) * realCos(REAL(2.2084e6) * phase + shift.z) * realExp(max(REAL(-6.6121e9) * squared, -87.0));
    return Vec3(REAL(3.2404542) * x - REAL(1.5371385) * y - REAL(0.4985314) * z,
                REAL(-0.9692660) * x + REAL(1.8760108) * y + REAL(0.0415560) * z,
                REAL(0.0556434) * x - REAL(0.2040259) * y + REAL(1.0572252) * z);
}

/// Index over air of a base that reflects f0 at normal incidence.
FN Real indexOf(Real f0) {
    Real root = sqrt(clamp(f0, 0.0, REAL(0.9999)));
    return (1.0 + root) / (1.0 - root);
}

/// Reflectance at a cosine of incidence; `outside`: index above the film, `thickness` in nanometres, f0 of the base
/// under air. As the film's thickness goes to 0 its index goes to that outside.
FN Vec3 thinFilmReflectance(Real outside, Real filmIndex, Real cosine, Real thickness, Vec3 f0) {
    Real index = mix(outside, filmIndex, smoothstep(Real(0.0), REAL(0.03), thickness));
    Real ratio = outside / index;
    Real squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if (squared < 0.0) return Vec3(1.0);
    Real cosine2 = sqrt(squared);
    Real r12 = fresnelSchlick(normalReflectance(index / outside), 1.0, cosine);
    Real t121 = 1.0 - r12;
    Real phi21 = index < outside ? Real(0.0) : PI;
    Vec3 base = Vec3(indexOf(f0.x), indexOf(f0.y), indexOf(f0.z));
    Vec3 at0 = Vec3(normalReflectance(base.x / index), normalReflectance(base.y / index),
                    normalReflectance(base.z / index));
    Vec3 r23 = fresnelSchlick(at0, Vec3(1.0), cosine2);
    Vec3 shift = Vec3(phi21 + (base.x < index ? PI : Real(0.0)), phi21 + (base.y < index ? PI : Real(0.0)),
                      phi21 + (base.z < index ? PI : Real(0.0)));
    Real path = 2.0 * index * thickness * REAL(1e-9) * cosine2;
    Vec3 r123 = clamp(r12 * r23, REAL(1e-5), REAL(0.9999));
    Vec3 root = sqrt(r123);
    Vec3 rs = t121 * t121 * r23 / (Vec3(1.0) - r123);
    Vec3 result = Vec3(r12) + rs;
    Vec3 amplitude = rs - Vec3(t121);
    amplitude = amplitude * root;
    result = result + 2.0 * amplitude * spectralResponse(path, shift);
    amplitude = amplitude * root;
    result = result + 2.0 * amplitude * spectralResponse(2.0 * path, 2.0 * shift);
    return clamp(result, 0.0, 1.0);
}

#endif
