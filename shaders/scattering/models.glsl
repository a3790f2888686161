#ifndef SHADERS_SCATTERING_MODELS_GLSL
#define SHADERS_SCATTERING_MODELS_GLSL
/** @file
 * The scattering models that glTF's parameters cannot say (Scattering::Model): the one list of them on the device.
 * A model is a number, a line in modelValue and one in modelDirection; HAS_MODEL(number), which includers define, is a
 * constant, and what is false is not compiled.
 */
#include "shaders/scattering/conductor.glsl"
#include "shaders/scattering/dielectric.glsl"
#include "shaders/scattering/lambert.glsl"
#include "shaders/scattering/multiple_scattering.glsl"
#include "shaders/scattering/oren_nayar.glsl"
#include "shaders/scattering/phong.glsl"

const uint MODEL_OREN_NAYAR = 0u, MODEL_MIRROR = 1u, MODEL_DIELECTRIC = 2u, MODEL_THIN_DIELECTRIC = 3u,
           MODEL_CONDUCTOR = 4u, MODEL_PHONG = 5u, MODEL_BLINN_PHONG = 6u;

struct ModelSurface {
    uint model;
    vec3 color;
    float roughness;
    vec3 n;
    vec3 k;
    float eta;      ///< index beyond over index on wo's side
    float exponent;
    Microfacets facets;
    bool schlick;
    bool compensated;
    bool inside;  ///< wo is on the side of the index n
    int losses;   ///< first texel of the table of what facets lose, where compensated
};

ScatterValue modelValue(ModelSurface m, vec3 wo, vec3 wi) {
    ScatterValue v = noScattering();
    if (HAS_MODEL(MODEL_OREN_NAYAR) && m.model == MODEL_OREN_NAYAR) v = orenNayarValue(m.color, m.roughness, wo, wi);
    if (HAS_MODEL(MODEL_DIELECTRIC) && m.model == MODEL_DIELECTRIC) {
        v = dielectricValue(m.eta, m.facets, m.schlick, wo, wi);
        if (HAS_COMPENSATION && m.compensated) v = compensatedDielectric(v, m.losses, m.inside, m.eta, wo, wi);
    }
    if (HAS_MODEL(MODEL_CONDUCTOR) && m.model == MODEL_CONDUCTOR) {
        v = conductorValue(m.n, m.k, m.facets, wo, wi);
        if (HAS_COMPENSATION && m.compensated) v = compensatedConductor(v, m.losses, wo, wi);
        v.value *= m.color;
    }
    if (HAS_MODEL(MODEL_PHONG) && m.model == MODEL_PHONG) v = phongValue(m.color, m.exponent, wo, wi);
    if (HAS_MODEL(MODEL_BLINN_PHONG) && m.model == MODEL_BLINN_PHONG) v = blinnPhongValue(m.color, m.exponent, wo, wi);
    return v;
}

/** A direction; what it is worth, but for mirrors (density < 0), is to be judged by modelValue. */
ScatterSample modelDirection(ModelSurface m, vec3 wo, vec3 u) {
    ScatterSample s = noSample();
    if (HAS_MODEL(MODEL_OREN_NAYAR) && m.model == MODEL_OREN_NAYAR) s = unjudged(cosineHemisphere(u.xy));
    if (HAS_MODEL(MODEL_MIRROR) && m.model == MODEL_MIRROR) s = mirrorSample(m.color, wo);
    if (HAS_MODEL(MODEL_THIN_DIELECTRIC) && m.model == MODEL_THIN_DIELECTRIC) s = paneSample(m.n.x, m.color, wo, u);
    if (HAS_MODEL(MODEL_DIELECTRIC) || HAS_MODEL(MODEL_CONDUCTOR)) {
        // The first numbers of u.z draw what single scattering loses.
        float share = 0.0;
        if (HAS_COMPENSATION && m.compensated) share = compensatedShare(m.losses, m.inside, wo);
        const vec3 rest = vec3(u.xy, HAS_COMPENSATION ? (u.z - share) / max(1.0 - share, 1e-6) : u.z);
        if (HAS_MODEL(MODEL_DIELECTRIC) && m.model == MODEL_DIELECTRIC) s = dielectricDirection(m.eta, m.facets, m.schlick, wo, rest);
        if (HAS_MODEL(MODEL_CONDUCTOR) && m.model == MODEL_CONDUCTOR) {
            s = conductorDirection(m.n, m.k, m.facets, wo, rest);
            s.weight *= m.color;
        }
        if (HAS_COMPENSATION && u.z < share) s = unjudged(compensatedDirection(m.losses, m.model == MODEL_DIELECTRIC, m.inside, share, u));
    }
    if (HAS_MODEL(MODEL_PHONG) && m.model == MODEL_PHONG) s = unjudged(phongDirection(m.exponent, wo, u));
    if (HAS_MODEL(MODEL_BLINN_PHONG) && m.model == MODEL_BLINN_PHONG) s = unjudged(blinnPhongDirection(m.exponent, wo, u));
    return s;
}
#endif
