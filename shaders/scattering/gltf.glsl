#ifndef SHADERS_SCATTERING_GLTF_GLSL
#define SHADERS_SCATTERING_GLTF_GLSL
/** @file
 * The glTF 2.0 material as appendix B of its specification mixes it, with the extensions specular, ior,
 * transmission, volume, clearcoat, sheen, anisotropy and iridescence: Lambert, GGX with height-correlated Smith and
 * Schlick's Fresnel, no compensation of multiple scattering.
 *
 * As the specification says of itself, its fresnel_mix weighs the diffuse part by 1 - F at the half vector, which
 * conserves no energy: near grazing angles, where a smooth surface mirrors nearly all light, the diffuse part is
 * there too, and a white smooth dielectric's albedo goes up to 1.95. Metals, and dielectrics without diffuse part,
 * stay below 1.
 *
 * Includers define the constants HAS_TRANSMISSION, HAS_CLEARCOAT, HAS_SHEEN, HAS_IRIDESCENCE (what is false is not
 * compiled) and sheenAlbedo(cosine, roughness).
 */
#include "shaders/scattering/fresnel.glsl"
#include "shaders/scattering/ggx.glsl"
#include "shaders/scattering/microfacet.glsl"
#include "shaders/scattering/sheen.glsl"
#include "shaders/scattering/thin_film.glsl"

/** Everything of a surface's point that its material decides. */
struct GltfSurface {
    vec3 baseColor;
    float metallic;
    vec2 alpha;       ///< along x and y
    vec3 f0;          ///< of the dielectric at normal incidence
    float f90;        ///< of the dielectric at grazing
    float eta;        ///< index beyond over index on wo's side; light goes through a volume's surface by it
    float transmission;
    bool thin;        ///< no volume behind: light goes through in line
    float coat;
    float coatAlpha;
    vec3 coatNormal;  ///< unit, local
    vec3 sheenColor;
    float sheenRoughness;
    float film;           ///< factor of iridescence
    float filmIndex;
    float filmThickness;  ///< nanometres
};

struct GltfFresnel {
    vec3 dielectric;
    vec3 metal;
};

/** Reflectances where wo and the normal of a facet meet at `cosine`; `schlick` is the cosine outside, 0 where light
 * inside a volume does not get out. */
GltfFresnel gltfFresnelAt(GltfSurface s, float cosine, float schlick) {
    const bool total = HAS_TRANSMISSION && !s.thin && s.eta < 1.0 && schlick <= 0.0;
    GltfFresnel f;
    f.dielectric = total ? vec3(1.0) : fresnelSchlick(s.f0, vec3(s.f90), schlick);
    f.metal = fresnelSchlick(s.baseColor, vec3(1.0), cosine);
    if (HAS_IRIDESCENCE && s.film > 0.0) {
        if (!total) f.dielectric = mix(f.dielectric, thinFilmReflectance(1.0, s.filmIndex, schlick, s.filmThickness, s.f0), s.film);
        f.metal = mix(f.metal, thinFilmReflectance(1.0, s.filmIndex, cosine, s.filmThickness, s.baseColor), s.film);
    }
    return f;
}

/** The same, by the cosine of wo alone. */
GltfFresnel gltfFresnel(GltfSurface s, float cosine) {
    const bool inside = HAS_TRANSMISSION && !s.thin && s.eta < 1.0;
    return gltfFresnelAt(s, cosine, inside ? schlickCosine(cosine, s.eta) : cosine);
}

/** What a clear coat reflects of the light along wo, by its own normal. */
float coatReflectance(GltfSurface s, vec3 wo) {
    return HAS_CLEARCOAT ? s.coat * fresnelSchlick(0.04, 1.0, abs(dot(wo, s.coatNormal))) : 0.0;
}

bool gltfSmooth(vec2 alpha) {
    return max(alpha.x, alpha.y) < SMOOTH_ALPHA;
}

/** Chances of the lobes, sum 1: by their albedos as far as wo tells. */
struct GltfLobes {
    float specular, diffuse, transmission, coat, sheen;
};
GltfLobes gltfLobes(GltfSurface s, vec3 wo) {
    const GltfFresnel f = gltfFresnel(s, wo.z);
    const float through = 1.0 - maxComponent(f.dielectric);
    const float base = (1.0 - s.metallic) * maxComponent(s.baseColor);
    GltfLobes lobes;
    lobes.specular = maxComponent(mix(f.dielectric, f.metal, s.metallic));
    // The diffuse part's weight is that of the half vectors, most of which see the surface steeply.
    lobes.diffuse = base * (1.0 - maxComponent(s.f0));
    lobes.transmission = 0.0;
    if (HAS_TRANSMISSION) {
        lobes.transmission = s.transmission * base * through;
        lobes.diffuse *= 1.0 - s.transmission;
    }
    lobes.sheen = HAS_SHEEN ? maxComponent(s.sheenColor) * 0.5 : 0.0;
    lobes.coat = coatReflectance(s, wo);
    const float rest = HAS_CLEARCOAT ? 1.0 - lobes.coat : 1.0;
    const float sum = lobes.specular + lobes.diffuse + lobes.transmission + lobes.sheen;
    const float scale = sum > 0.0 ? rest / sum : 0.0;
    lobes.specular *= scale;
    lobes.diffuse *= scale;
    lobes.transmission *= scale;
    lobes.sheen *= scale;
    return lobes;
}

/** wo and wi seen from another normal than z. */
mat3 frameOf(vec3 normal) {
    vec3 x, y;
    orthonormalBasis(normal, x, y);
    return mat3(x, y, normal);
}

/** What the layers above the base leave of light from wi to wo. */
float gltfLayers(GltfSurface s, vec3 wo, vec3 wi) {
    float left = 1.0 - coatReflectance(s, wo);
    if (HAS_SHEEN) {
        const float most = maxComponent(s.sheenColor);
        const float albedo = max(sheenAlbedo(wo.z, s.sheenRoughness), sheenAlbedo(abs(wi.z), s.sheenRoughness));
        left *= max(1.0 - most * albedo, 0.0);
    }
    return left;
}

/** All that is no mirror. */
ScatterValue gltfValue(GltfSurface s, vec3 wo, vec3 wi) {
    const GltfLobes lobes = gltfLobes(s, wo);
    const bool isSmooth = gltfSmooth(s.alpha);
    const vec2 alpha = isSmooth ? vec2(1.0) : s.alpha;
    const bool above = wo.z > 0.0 && wi.z > 0.0;
    vec3 h;
    const ScatterValue facets = ggxReflection(wo, wi, alpha, h);
    const GltfFresnel f = gltfFresnel(s, clamp(dot(wo, h), 0.0, 1.0));
    const float cosine = above ? wi.z * INV_PI : 0.0;
    float diffuseShare = 1.0 - s.metallic;
    if (HAS_TRANSMISSION) diffuseShare *= 1.0 - s.transmission;
    vec3 value = s.baseColor * (diffuseShare * cosine * (1.0 - maxComponent(f.dielectric)));
    float density = lobes.diffuse * cosine;
    if (!isSmooth) {
        value += mix(f.dielectric, f.metal, s.metallic) * facets.value;
        density += lobes.specular * facets.density;
    }
    if (HAS_TRANSMISSION && !isSmooth && wi.z < 0.0) {
        vec3 across = h;
        ScatterValue through = noScattering();
        if (s.thin) through = ggxReflection(wo, vec3(wi.xy, -wi.z), alpha, across);
        if (!s.thin && s.eta != 1.0) through = facetTransmission(Microfacets(alpha, false), wo, wi, s.eta, across);
        const float woH = clamp(dot(wo, across), 0.0, 1.0);
        const GltfFresnel g = gltfFresnelAt(s, woH, s.thin || s.eta >= 1.0 ? woH : clamp(-dot(wi, across), 0.0, 1.0));
        const float share = (1.0 - s.metallic) * s.transmission * (1.0 - maxComponent(g.dielectric));
        value += s.baseColor * share * through.value;
        density += lobes.transmission * through.density;
    }
    if (HAS_CLEARCOAT || HAS_SHEEN) value *= gltfLayers(s, wo, wi);
    if (HAS_SHEEN) {
        const ScatterValue sheen = sheenValue(s.sheenRoughness, wo, wi);
        value += s.sheenColor * sheen.value * (1.0 - coatReflectance(s, wo));
        density += lobes.sheen * cosine;
    }
    if (HAS_CLEARCOAT && s.coatAlpha >= SMOOTH_ALPHA) {
        const mat3 frame = frameOf(s.coatNormal);
        vec3 coatH;
        const ScatterValue coat = ggxReflection(wo * frame, wi * frame, vec2(s.coatAlpha), coatH);
        value += above ? coatReflectance(s, wo) * coat.value : vec3(0.0);
        density += above ? lobes.coat * coat.density : 0.0;
    }
    return ScatterValue(value, density);
}

/** A direction of the mixture. `density` 1: judge it by gltfValue; negative: a mirror with its weight; 0: light is
 * lost, mirrored downwards or bent upwards. u.z chooses the lobe. */
ScatterSample gltfSample(GltfSurface s, vec3 wo, vec3 u) {
    const GltfLobes lobes = gltfLobes(s, wo);
    const bool isSmooth = gltfSmooth(s.alpha);
    const bool isSpecular = u.z < lobes.specular;
    const bool isTransmission = HAS_TRANSMISSION && !isSpecular && u.z < lobes.specular + lobes.transmission;
    ScatterSample result = noSample();
    result.direction = cosineHemisphere(u.xy);
    result.density = 1.0;
    if (isSpecular || isTransmission) {
        vec3 h = vec3(0.0, 0.0, 1.0);
        if (!isSmooth) h = ggxSampleNormal(wo, s.alpha, u.xy);
        const float cosine = clamp(dot(wo, h), 0.0, 1.0);
        const GltfFresnel f = gltfFresnel(s, cosine);
        result.direction = reflectedAbout(wo, h);
        result.weight = mix(f.dielectric, f.metal, s.metallic) / lobes.specular;
        if (HAS_TRANSMISSION && isTransmission) {
            float beyond;
            fresnelDielectric(cosine, s.eta, beyond);
            float scale = 1.0;
            if (s.thin) {
                result.direction.z = -result.direction.z;
            } else {
                result.direction = normalize(refractedAbout(wo, h, s.eta, beyond));
                scale = beyond > 0.0 ? 1.0 / (s.eta * s.eta) : 0.0;
            }
            result.weight = s.baseColor * ((1.0 - s.metallic) * s.transmission * (1.0 - maxComponent(f.dielectric)) * scale / lobes.transmission);
        }
        const bool straight = HAS_TRANSMISSION && isTransmission && !s.thin && s.eta == 1.0;
        if (isSmooth || straight) {
            if (HAS_CLEARCOAT || HAS_SHEEN) result.weight *= gltfLayers(s, wo, result.direction);
            result.density = -1.0;
        }
        const bool kept = isSpecular == (result.direction.z > 0.0) && maxComponent(result.weight) > 0.0;
        result.density = kept ? result.density : 0.0;
    }
    if (HAS_CLEARCOAT) {
        const bool isCoat = u.z >= 1.0 - lobes.coat;
        if (isCoat) {
            const mat3 frame = frameOf(s.coatNormal);
            const vec3 seen = wo * frame;
            const bool mirror = s.coatAlpha < SMOOTH_ALPHA;
            vec3 h = vec3(0.0, 0.0, 1.0);
            if (!mirror) h = ggxSampleNormal(vec3(seen.xy, max(seen.z, 1e-4)), vec2(s.coatAlpha), u.xy);
            result.direction = frame * reflectedAbout(seen, h);
            result.weight = vec3(coatReflectance(s, wo) / lobes.coat);
            result.density = result.direction.z > 0.0 ? (mirror ? -1.0 : 1.0) : 0.0;
        }
    }
    return result;
}

/** The same, judged. */
ScatterSample gltfScatter(GltfSurface s, vec3 wo, vec3 u) {
    const ScatterSample chosen = gltfSample(s, wo, u);
    if (chosen.density < 0.0) return chosen;
    if (chosen.density == 0.0) return noSample();
    return sampleOf(chosen.direction, gltfValue(s, wo, chosen.direction));
}
#endif
