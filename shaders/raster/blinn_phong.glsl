// Blinn and Phong's model (Blinn, "Models of light reflection for computer synthesized pictures", 1977), normalised:
//   L = ka La + sum over lights of V E (kd / pi + ks N(p) (n.h)^p) (n.l),   h = (v + l) / |v + l|,
// nothing where n.l <= 0. E is the irradiance across l and V the visible part of the light; ka = kd + ks.
// blinnPhongNorm() makes ks the albedo from above. Evaluated for every pixel (Phong), or once for each corner (Gouraud)
// or triangle (flat) by passes/shade/shadeCorners.comp.
#ifndef SHADERS_RASTER_BLINN_PHONG_GLSL
#define SHADERS_RASTER_BLINN_PHONG_GLSL
#include "shaders/scattering/phong.glsl"
#include "shaders/shared/exponential.glsl"

/// What a light of irradiance 1 across l brings: for kd / pi, and for ks.
struct BlinnPhongLight {
    float diffuse;
    float gloss;
};

BlinnPhongLight blinnPhongLight(vec3 normal, vec3 toLight, vec3 toEye, float exponent) {
    float cosine = dot(normal, toLight);
    vec3 h = normalizeSafe(toLight + toEye, normal);
    // Near the peak, where lobes are, cos^p by the sine: a cosine's last place is too coarse for large exponents.
    vec3 across = cross(normal, h);
    float c = dot(normal, h), sine2 = dot(across, across);
    float logarithm = sine2 < 0.5 ? 0.5 * realLog1p(-sine2) : realLog(max(c, 1e-30));
    float lobe = c > 0.0 ? realExp(max(exponent * logarithm, -87.0)) : 0.0;
    return BlinnPhongLight(max(cosine, 0.0), cosine > 0.0 ? blinnPhongNorm(exponent) * lobe * cosine : 0.0);
}

#ifdef SURFACE_MATERIALS
/// The model's factors of a material.
struct BlinnPhong {
    vec3 diffuse, specular;
    float exponent;
};

/// Of a glTF material: kd is its diffuse part from above, ks its reflectance there, and p the exponent whose lobe is as
/// wide as that of its microfacets, 2 / alpha^2 - 2 (Walter et al. 2007, section 5.2).
BlinnPhong blinnPhongOf(SurfaceBsdf bsdf, vec3 color) {
    const float MOST = 1e6;
    BlinnPhong m = BlinnPhong(color * diffuseShare(bsdf), vec3(0.0), MOST);
    if (HAS_GLTF && bsdf.model == 0u) {
        float alpha = max(max(bsdf.gltf.alpha.x, bsdf.gltf.alpha.y), 1e-3);
        m.specular = mix(bsdf.gltf.f0, bsdf.gltf.baseColor, bsdf.gltf.metallic);
        m.exponent = min(2.0 / (alpha * alpha) - 2.0, MOST);
    }
    if (HAS_MODELS && bsdf.model != 0u) m.specular = mirrorShare(bsdf);
    if (HAS_MODELS && (bsdf.model == MODEL_PHONG + 1u || bsdf.model == MODEL_BLINN_PHONG + 1u)) {
        // About the mirrored direction an angle is twice that of the half vector.
        m.specular = bsdf.other.color;
        m.exponent = min(bsdf.other.exponent * (bsdf.model == MODEL_PHONG + 1u ? 4.0 : 1.0), MOST);
    }
    if (bsdf.unlit) m.specular = vec3(0.0);
    return m;
}
#endif

#endif
