#ifndef SHADERS_SCATTERING_GLTF_GLSL
#define SHADERS_SCATTERING_GLTF_GLSL
/** @file
 * The glTF 2.0 material as appendix B of its specification mixes it, with the extensions specular, ior,
 * transmission, volume, clearcoat, sheen, anisotropy and iridescence: Lambert, GGX with height-correlated Smith and
 * Schlick's Fresnel, no compensation of multiple scattering.
 *
 * As the specification says of itself, its fresnel_mix weighs the diffuse part by 1 - F at the half vector, which
 * conserves no energy: near grazing angles, where a surface mirrors nearly all light, the diffuse part would be there
 * too, and a white smooth dielectric's albedo go up to 1.95. The diffuse part is therefore also bounded by what the
 * specular lobe leaves of light from either direction, the albedo scaling that the specification takes for sheen.
 * Sheen, whose fit passes 1 at low roughness, is divided by its albedo where that does. All parts then conserve energy
 * and, but for the clear coat, which the specification weighs by the viewer's angle alone, are reciprocal.
 *
 * Seen from inside a volume a surface is the mix by `transmission` of glass and of paint that touches the volume.
 *
 * Includers define the constants HAS_DIELECTRIC, HAS_TRANSMISSION, HAS_CLEARCOAT, HAS_SHEEN, HAS_IRIDESCENCE (what is
 * false is not compiled) and sheenAlbedo(cosine, roughness).
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

/** Light inside a volume meets its surface. */
bool gltfInside(GltfSurface s) {
    return HAS_TRANSMISSION && !s.thin && s.eta < 1.0;
}

struct GltfFresnel {
    vec3 dielectric;
    vec3 metal;
};

/** Reflectances where wo and the normal of a facet meet at `cosine`; `schlick` is the cosine outside, 0 where light
 * inside a volume does not get out. */
GltfFresnel gltfFresnelAt(GltfSurface s, float cosine, float schlick) {
    const bool total = gltfInside(s) && schlick <= 0.0;
    GltfFresnel f;
    f.dielectric = vec3(0.0);
    if (HAS_DIELECTRIC) f.dielectric = total ? vec3(1.0) : fresnelSchlick(s.f0, vec3(s.f90), schlick);
    f.metal = fresnelSchlick(s.baseColor, vec3(1.0), cosine);
    if (HAS_IRIDESCENCE && s.film > 0.0) {
        if (HAS_DIELECTRIC && !total) f.dielectric = mix(f.dielectric, thinFilmReflectance(1.0, s.filmIndex, schlick, s.filmThickness, s.f0), s.film);
        f.metal = mix(f.metal, thinFilmReflectance(1.0, s.filmIndex, cosine, s.filmThickness, s.baseColor), s.film);
    }
    return f;
}

/** The same, by the cosine of wo alone. */
GltfFresnel gltfFresnel(GltfSurface s, float cosine) {
    return gltfFresnelAt(s, cosine, gltfInside(s) ? schlickCosine(cosine, s.eta) : cosine);
}

/** What a clear coat reflects of the light along wo, by its own normal. */
float coatReflectance(GltfSurface s, vec3 wo) {
    return HAS_CLEARCOAT ? s.coat * fresnelSchlick(0.04, 1.0, abs(dot(wo, s.coatNormal))) : 0.0;
}

bool gltfSmooth(vec2 alpha) {
    return max(alpha.x, alpha.y) < SMOOTH_ALPHA;
}

/** What goes through rough facets is deflected by less than a smooth surface's lobe is wide: see smoothInterface(). */
bool gltfStraight(GltfSurface s) {
    return max(s.alpha.x, s.alpha.y) * abs(s.eta - 1.0) < 0.25 * SMOOTH_ALPHA;
}

/** Weight of the facets' lobe. */
vec3 gltfMirrored(GltfSurface s, GltfFresnel f) {
    if (!HAS_DIELECTRIC) return f.metal;
    return mix(f.dielectric * (gltfInside(s) ? s.transmission : 1.0), f.metal, s.metallic);
}

/** Upper bound of the mean of (1 - cos)^5 over the facets that a viewer at `cosine` sees: the albedo of a lobe with
 * Schlick's reflectance is at most f0 + (f90 - f0) of this. MaterialX's fit of GGX albedos (mx_ggx_dir_albedo), which
 * is within 0.02 but for narrow lobes, raised by what it lacks; those have the bound of a smooth surface. */
float gltfGrazing(float cosine, float alpha) {
    const float x = clamp(cosine, 0.0, 1.0), y = clamp(alpha, 0.0, 1.0), xx = x * x, yy = y * y;
    const float above = 0.9345 - 2.323 * x + 2.229 * y - 3.748 * x * y + 1.424 * xx - 0.7684 * yy + 1.436 * xx * y + 0.2913 * x * yy + 0.6286 * xx * yy;
    const float below = 1.0 + 0.2281 * x + 15.94 * y - 55.83 * x * y + 13.08 * xx + 41.26 * yy + 54.9 * xx * y + 300.2 * x * yy - 285.1 * xx * yy;
    return clamp(max(1.035 * above / below, (1.0 - 10.0 * y) * schlickWeight(x)), 0.0, 1.0);
}

/** What the facets leave to the diffuse part: `f` is the reflectance at the half vector. */
float gltfDiffuseShare(GltfSurface s, float f, float woZ, float wiZ) {
    if (gltfInside(s)) return 1.0;
    float f0 = maxComponent(s.f0);
    if (HAS_IRIDESCENCE && s.film > 0.0) f0 = max(f0, f);
    const float bound = f0 + max(s.f90 - f0, 0.0) * gltfGrazing(min(woZ, wiZ), min(s.alpha.x, s.alpha.y));
    return clamp(1.0 - max(f, bound), 0.0, 1.0);
}

/** Chances of the lobes, sum 1: by their albedos as far as wo tells. None is 0 where the lobe is not: facets of a
 * rough surface lean, and reflect where the surface as a whole would not (black metal seen from straight above) or let
 * through what it would reflect wholly (glass from inside beyond the critical angle). */
struct GltfLobes {
    float specular, diffuse, transmission, coat, sheen;
};
GltfLobes gltfLobes(GltfSurface s, vec3 wo) {
    const float width = gltfSmooth(s.alpha) ? 0.0 : max(s.alpha.x, s.alpha.y);
    const GltfFresnel f = gltfFresnel(s, wo.z / (1.0 + width * width));
    float through = 1.0 - maxComponent(f.dielectric);
    if (HAS_TRANSMISSION && gltfInside(s)) through = mix(through, 1.0 - maxComponent(s.f0), width);
    const float base = HAS_DIELECTRIC ? (1.0 - s.metallic) * maxComponent(s.baseColor) : 0.0;
    GltfLobes lobes;
    lobes.specular = maxComponent(gltfMirrored(s, f));
    lobes.diffuse = HAS_DIELECTRIC ? base * gltfDiffuseShare(s, 0.0, wo.z, 1.0) : 0.0;
    lobes.transmission = 0.0;
    if (HAS_TRANSMISSION) {
        lobes.transmission = s.transmission * base * through;
        lobes.diffuse *= 1.0 - s.transmission;
    }
    lobes.sheen = HAS_SHEEN ? maxComponent(s.sheenColor) * 0.5 : 0.0;
    lobes.coat = coatReflectance(s, wo);
    const float rest = HAS_CLEARCOAT ? 1.0 - lobes.coat : 1.0;
    if (lobes.specular < 1e-30) lobes.specular = 0.0;  // what is drawn is divided by its chance
    if (lobes.transmission < 1e-30) lobes.transmission = 0.0;
    const float sum = lobes.specular + lobes.diffuse + lobes.transmission + lobes.sheen;
    const float scale = sum > 1e-30 ? rest / sum : 0.0;  // of denormal sums the inverse is infinite
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

/** Albedo of sheen of colour 1, of light from either direction. */
float gltfSheenAlbedo(GltfSurface s, vec3 wo, vec3 wi) {
    return max(sheenAlbedo(wo.z, s.sheenRoughness), sheenAlbedo(abs(wi.z), s.sheenRoughness));
}

/** What the layers above the base leave of light from wi to wo. */
float gltfLayers(GltfSurface s, vec3 wo, vec3 wi) {
    float left = 1.0 - coatReflectance(s, wo);
    if (HAS_SHEEN) left *= max(1.0 - maxComponent(s.sheenColor) * min(gltfSheenAlbedo(s, wo, wi), 1.0), 0.0);
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
    vec3 value = vec3(0.0);
    float density = 0.0;
    if (HAS_DIELECTRIC) {
        float diffuseShare = 1.0 - s.metallic;
        if (HAS_TRANSMISSION) diffuseShare *= 1.0 - s.transmission;
        value = s.baseColor * (diffuseShare * cosine * gltfDiffuseShare(s, maxComponent(f.dielectric), wo.z, wi.z));
        density = lobes.diffuse * cosine;
    }
    if (!isSmooth) {
        value += gltfMirrored(s, f) * facets.value;
        density += lobes.specular * facets.density;
    }
    if (HAS_TRANSMISSION && !isSmooth && wi.z < 0.0) {
        vec3 across = h;
        ScatterValue through = noScattering();
        if (s.thin) through = ggxReflection(wo, vec3(wi.xy, -wi.z), alpha, across);
        if (!s.thin && !gltfStraight(s)) through = facetTransmission(Microfacets(alpha, false), wo, wi, s.eta, across);
        const float woH = clamp(dot(wo, across), 0.0, 1.0);
        const GltfFresnel g = gltfFresnelAt(s, woH, s.thin || s.eta >= 1.0 ? woH : clamp(-dot(wi, across), 0.0, 1.0));
        const float share = (1.0 - s.metallic) * s.transmission * (1.0 - maxComponent(g.dielectric));
        value += s.baseColor * share * through.value;
        density += lobes.transmission * through.density;
    }
    if (HAS_CLEARCOAT || HAS_SHEEN) value *= gltfLayers(s, wo, wi);
    if (HAS_SHEEN) {
        const ScatterValue sheen = sheenValue(s.sheenRoughness, wo, wi);
        value += s.sheenColor * sheen.value * ((1.0 - coatReflectance(s, wo)) / max(gltfSheenAlbedo(s, wo, wi), 1.0));
        density += lobes.sheen * cosine;
    }
    if (HAS_CLEARCOAT && s.coatAlpha >= SMOOTH_ALPHA) {
        const mat3 frame = frameOf(s.coatNormal);
        vec3 coatH;
        const ScatterValue coat = ggxReflection(wo * frame, wi * frame, vec2(s.coatAlpha), coatH);
        value += above ? coatReflectance(s, wo) * coat.value : vec3(0.0);
        density += above ? lobes.coat * coat.density : 0.0;
    }
    // Over a denormal density the value would not be finite.
    return ScatterValue(value, density >= REAL_MIN_NORMAL ? density : 0.0);
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
        result.weight = gltfMirrored(s, f) / lobes.specular;
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
        const bool straight = HAS_TRANSMISSION && isTransmission && !s.thin && gltfStraight(s);
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
