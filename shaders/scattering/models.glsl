#ifndef SHADERS_SCATTERING_MODELS_GLSL
#define SHADERS_SCATTERING_MODELS_GLSL
/** @file
 * The scattering models that glTF's parameters cannot say (Scattering::Model): the one list of them on the device.
 * A model is a number, a line in modelValue and one in modelSample; HAS_MODEL(number), which includers define, is a
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
};

ScatterValue modelValue(ModelSurface m, vec3 wo, vec3 wi) {
    ScatterValue v = noScattering();
    if (HAS_MODEL(MODEL_OREN_NAYAR) && m.model == MODEL_OREN_NAYAR) v = orenNayarValue(m.color, m.roughness, wo, wi);
    if (HAS_MODEL(MODEL_DIELECTRIC) && m.model == MODEL_DIELECTRIC) v = dielectricValue(m.eta, m.facets, m.schlick, wo, wi);
    if (HAS_MODEL(MODEL_CONDUCTOR) && m.model == MODEL_CONDUCTOR) {
        v = conductorValue(m.n, m.k, m.facets, wo, wi);
        if (HAS_COMPENSATION && m.compensated) v = compensatedValue(v, m.n, m.k, m.facets, wo, wi);
        v.value *= m.color;
    }
    if (HAS_MODEL(MODEL_PHONG) && m.model == MODEL_PHONG) v = phongValue(m.color, m.exponent, wo, wi);
    if (HAS_MODEL(MODEL_BLINN_PHONG) && m.model == MODEL_BLINN_PHONG) v = blinnPhongValue(m.color, m.exponent, wo, wi);
    return v;
}

ScatterSample modelSample(ModelSurface m, vec3 wo, vec3 u) {
    ScatterSample s = noSample();
    if (HAS_MODEL(MODEL_OREN_NAYAR) && m.model == MODEL_OREN_NAYAR) s = orenNayarSample(m.color, m.roughness, wo, u);
    if (HAS_MODEL(MODEL_MIRROR) && m.model == MODEL_MIRROR) s = mirrorSample(m.color, wo);
    if (HAS_MODEL(MODEL_DIELECTRIC) && m.model == MODEL_DIELECTRIC) s = dielectricSample(m.eta, m.facets, m.schlick, wo, u);
    if (HAS_MODEL(MODEL_THIN_DIELECTRIC) && m.model == MODEL_THIN_DIELECTRIC) s = paneSample(m.n.x, m.color, wo, u);
    if (HAS_MODEL(MODEL_CONDUCTOR) && m.model == MODEL_CONDUCTOR) {
        s = conductorSample(m.n, m.k, m.facets, wo, u);
        if (HAS_COMPENSATION && m.compensated && s.density >= 0.0 && u.z < compensatedShare(m.facets, wo)) {
            s.direction = cosineHemisphere(u.xy);
            s.density = 1.0;  // judged by modelValue
        }
        s.weight *= m.color;
    }
    if (HAS_MODEL(MODEL_PHONG) && m.model == MODEL_PHONG) s = phongSample(m.color, m.exponent, wo, u);
    if (HAS_MODEL(MODEL_BLINN_PHONG) && m.model == MODEL_BLINN_PHONG) s = blinnPhongSample(m.color, m.exponent, wo, u);
    return s;
}
#endif
