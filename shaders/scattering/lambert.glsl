// Perfectly diffuse reflection: f = albedo / pi.
#ifndef SHADERS_SCATTERING_LAMBERT_GLSL
#define SHADERS_SCATTERING_LAMBERT_GLSL
#include "shaders/scattering/scatter.glsl"

FN ScatterValue lambertValue(Vec3 albedo, Vec3 wo, Vec3 wi) {
    Real c = wo.z > 0.0 ? max(wi.z, 0.0) * INV_PI : Real(0.0);
    return ScatterValue(albedo * c, c);
}
FN ScatterSample lambertSample(Vec3 albedo, Vec3 wo, Vec3 u) {
    Vec3 wi = cosineHemisphere(Vec2(u.x, u.y));
    return sampleOf(wi, lambertValue(albedo, wo, wi));
}

#endif
