#ifndef HELIOGRAPH_PATHTRACE_MATERIAL_BSDF
#define HELIOGRAPH_PATHTRACE_MATERIAL_BSDF
/** @file
 * How surfaces of any material scatter, in the world's frame.
 *
 * A shading normal, of vertices or of a map, tilts a lobe so that part of it lies under the true surface. That part
 * is mirrored at the surface, for light going out and coming in alike: no light is lost, whatever the normal, and a
 * white surface stays white (dropping it would darken a lobe tilted by t to (1 + cos t)/2). A lobe that goes through
 * is mirrored downwards likewise. Where the viewer is under the shading normal's horizon the normal is bent until
 * it sees the viewer at LEAST_COSINE.
 *
 * Shading normals are not reciprocal (Veach, "Non-symmetric scattering in light transport algorithms", 1996), and these
 * are none either: seen over the true surface, a diffuse lobe of the normal n has the value a (n.wi + n.wi') / (pi g.wi),
 * each cosine where positive, with g the true normal and wi' mirrored at it. It depends on wi alone: f(i, o) / f(o, i) is
 * (1 + tan t tan i cos p) / (1 + tan t tan o cos q) for a tilt t and angles i, o, azimuths p, q about g, as long as both
 * directions see no more than one of the two parts: 1 from above, without bound towards the horizon.
 */
#include "passes/pathtrace/surface.glsl"
#include "shaders/sampling/sampler.glsl"
#include "shaders/scene/surface_material.glsl"

#ifdef TILTED_FACETS
#include "shaders/scattering/tilted_facets.glsl"
#endif

/** Those of lambert_bsdf.glsl, and one to choose a lobe and a wavelength. */
const uint DIMENSIONS_PER_SCATTERING = 4u;
/** Turns of loops that a scattering may take: Beckmann's slopes are found by iteration,
 * and values are summed in one. */
#ifdef SOLID_TEXTURES
const uint NOISE_TURNS = 6u;  // NOISE_OCTAVES
#else
const uint NOISE_TURNS = 0u;
#endif
#ifdef TILTED_FACETS
const uint LOOP_TURNS = 32u * (HAS_MODELS ? 80u : 12u) + NOISE_TURNS;  // FACET_TURNS
const bool WEIGHS_LIGHT = true;
#else
const uint LOOP_TURNS = (HAS_MODELS ? 40u : 5u) + NOISE_TURNS;
const bool WEIGHS_LIGHT = false;
#endif
const float LEAST_COSINE = 0.01;

struct SurfaceBsdf {
    mat3 frame;  ///< tangent, bitangent, normal, turned to the ray's side
    vec3 wo;     ///< local
    bool unlit;
    vec3 albedo;  ///< of an unlit surface: what it shows
    uint model;   ///< 0: glTF's
    GltfSurface gltf;
    ModelSurface other;
#ifdef TILTED_FACETS
    TiltedFacets facets;
    bool folds;      ///< see walkFacets()
    uint facetKey;
#endif
};
struct SurfaceValue {
    float density;
    vec3 weight;
};
struct SurfaceSample {
    vec3 direction;
    vec3 weight;
    float density;
    bool goes;
};

/** A unit normal bent towards the unit vector w until their cosine is LEAST_COSINE. */
vec3 bentTowards(vec3 normal, vec3 w) {
    const float cosine = dot(normal, w);
    return cosine >= LEAST_COSINE ? normal : normalizeSafe(normal + w * (LEAST_COSINE * 1.001 - cosine), w);
}

/** The tangent frame of a surface's front about a unit normal. */
mat3 frontFrame(SurfacePoint s, vec3 normal) {
    mat3 frame = tangentFrame(s.triangle.g, s.b, normal);
#ifdef SHAPES
    if (HAS_TANGENTS && (HAS_SPHERES || HAS_TORI) && s.triangle.shape > 0 && !isFlat(s.triangle)) {
        // Along the parallel, or round the axis, wherever that has a direction.
        const bool isTorus = s.triangle.shape == SHAPE_TORUS;
        const vec3 pole = isTorus ? cross(s.triangle.v1, s.triangle.v2) : s.triangle.v2;
        const vec3 across = cross(pole, isTorus ? s.position - s.triangle.v0 : normal);
        const float handed = dot(cross(frame[0], frame[1]), normal) < 0.0 ? -1.0 : 1.0;
        if (isTorus || dot(across, across) > 1e-10 * dot(pole, pole)) frame[0] = handed * normalize(across);
        frame[0] = normalize(frame[0] - dot(frame[0], normal) * normal);
        frame[1] = handed * cross(normal, frame[0]);
    }
#endif
    return frame;
}

/** A volume lies behind its surface's front face: the segment runs in one where it ends at a back face, or, for what
 * lies within, where it left one inwards. */
vec3 throughMedium(SurfacePoint s, vec3 direction, int source, float distance) {
    vec3 left = vec3(1.0);
    if (HAS_VOLUMES) {
        vec3 absorption = s.front ? vec3(0.0) : materialRow(s.triangle.material, 9).rgb;
        if (source >= 0) {
            const bool inwards = leftInwards(source, s.position, direction, distance);
            const vec3 entered = materialRow(fetchTriangle(source).material, 9).rgb;
            absorption = max(absorption, inwards ? entered : vec3(0.0));
        }
        left = vec3(realExp(max(-absorption.x * distance, -80.0)), realExp(max(-absorption.y * distance, -80.0)),
                    realExp(max(-absorption.z * distance, -80.0)));
    }
    return left;
}
vec2 chooseLobe(uint kind, PixelSampler numbers, uint dimension) {
    return sample2D(kind, numbers, dimension + 3u);
}
vec3 leaving(SurfacePoint s, vec3 direction) {
    const bool through = HAS_LIGHT_THROUGH && dot(s.face, direction) < 0.0;
    return s.position + s.face * (through ? -s.offset : s.offset);
}

/** The normal of the side whose lights are asked, 0 for both: light by power then. Through a volume's surface comes what
 * is outside, to who is inside too; for who is outside its inside is hidden by the volume itself. */
vec3 lightSide(SurfaceBsdf bsdf, SurfacePoint s) {
    bool through = false, thin = false;
    if (HAS_GLTF && HAS_TRANSMISSION && bsdf.model == 0u) {
        through = bsdf.gltf.transmission > 0.0;
        thin = bsdf.gltf.thin;
    }
    if (HAS_MODEL(MODEL_DIELECTRIC) && bsdf.model == MODEL_DIELECTRIC + 1u) through = true;
    const vec3 outside = through && !s.front ? -s.face : s.face;
    return through && thin ? vec3(0.0) : outside;
}

#ifdef TILTED_FACETS
/** Light neither goes through the surface nor is reflected above it, by a coat with a normal of its own. */
bool onlyReflects(int material, uint flags, uint model) {
    if (model != 0u) return model != MODEL_DIELECTRIC + 1u && model != MODEL_THIN_DIELECTRIC + 1u;
    return materialRow(material, 8).y == 0.0 && materialRow(material, 10).x == 0.0;
}
#endif

SurfaceBsdf surfaceBsdf(SurfacePoint s, vec3 direction, float choice, inout vec3 throughput) {
    const int material = s.triangle.material, g = s.triangle.g;
    const vec3 wo = -direction;
    const vec3 color = baseColor(material, g, s.b).rgb;
    vec4 uv = vec4(0.0);
    if ((MATERIAL_FEATURES & 0x0800ff00u) != 0u) uv = texcoords(g, s.b);
    SurfaceBsdf bsdf;
    const uint flags = materialFlags(material);
    bsdf.unlit = HAS_UNLIT && (flags & MATERIAL_UNLIT) != 0u;
    bsdf.albedo = color;
    bsdf.model = HAS_MODELS ? flags >> MATERIAL_MODEL_SHIFT : 0u;

    const float side = s.front ? 1.0 : -1.0;
    mat3 frame = frontFrame(s, s.shading * side);
    vec3 normal = s.shading;
    if (HAS_NORMAL_MAPS) normal = side * (frame * mappedNormal(material, 16, uv, materialRow(material, 8).w));
    if (HAS_BUMPS) {
        vec3 e1, e2;
        surfaceEdges(s, e1, e2);
        normal = side * bumpedNormal(material, g, s.b, uv, side * normal, e1, e2);
    }
    vec3 seenAlong = wo;
#ifdef TILTED_FACETS
    bsdf.folds = normal == s.shading || !onlyReflects(material, flags, bsdf.model);
    bsdf.facets = tiltedFacets(s.face, normal);
    bsdf.facetKey = hashCombine(hashCombine(floatBitsToUint(choice), floatBitsToUint(direction.x)), floatBitsToUint(direction.y));
    normal = bsdf.folds ? bentTowards(normal, wo) : bsdf.facets.tilted;
    if (!bsdf.folds) seenAlong = seenByTilted(bsdf.facets, wo, unitFloat(bsdf.facetKey));
#else
    normal = bentTowards(normal, wo);
#endif

    if (HAS_GLTF) {
        int channel = 1;
        if (HAS_DISPERSION) {
            // The first dispersing surface picks a wavelength, later ones find it in what is left of the others.
            const bool disperses = materialRow(material, 8).z > 0.0 && (flags & MATERIAL_THIN) == 0u && bsdf.model == 0u;
            const bvec3 lit = greaterThan(throughput, vec3(0.0));
            const bool picked = (lit.x ? 1 : 0) + (lit.y ? 1 : 0) + (lit.z ? 1 : 0) <= 1;
            channel = picked ? (lit.x ? 0 : (lit.y ? 1 : 2)) : min(int(choice * 3.0), 2);
            if (disperses && !picked) throughput *= vec3(channel == 0, channel == 1, channel == 2) * 3.0;
            if (!disperses) channel = 1;
        }
        bsdf.gltf = gltfSurface(material, color, uv, s.front, channel);
        if (HAS_ANISOTROPY) turnFacets(material, uv, bsdf.gltf, frame);
        bsdf.gltf.alpha = resolvedAlpha(bsdf.gltf.alpha);
    }
    if (HAS_MODELS) bsdf.other = modelSurface(material, flags, color, s.front);
    // The tangent moves with the normal.
    vec3 tangent = frame[0] - dot(frame[0], normal) * normal;
    vec3 x, y;
    orthonormalBasis(normal, x, y);
    if (HAS_TANGENTS && dot(tangent, tangent) > 1e-8) {
        x = normalize(tangent);
        y = cross(normal, x);
    }
    bsdf.frame = mat3(x, y, normal);
    bsdf.wo = seenAlong * bsdf.frame;
    bsdf.wo.z = max(bsdf.wo.z, 1e-6);
    if (HAS_GLTF && HAS_CLEARCOAT) {
        vec3 coat = s.shading;
        if (HAS_CLEARCOAT_TEXTURES) {
            const mat3 original = frontFrame(s, s.shading * side);
            coat = side * (original * mappedNormal(material, 28, uv, materialRow(material, 10).z));
        }
        bsdf.gltf.coatNormal = bentTowards(coat, wo) * bsdf.frame;
    }
    return bsdf;
}

bool scatters(SurfaceBsdf bsdf) {
    return !bsdf.unlit;
}
/** Whether much of the light is scattered so widely that directions may come from tables of caustics. */
bool takesGuide(SurfaceBsdf bsdf) {
    const float wide = 0.09;  // the alpha of a roughness of 0.3
    bool takes = false;
    if (HAS_GLTF && bsdf.model == 0u) {
        const float diffuse = (1.0 - bsdf.gltf.metallic) * (1.0 - bsdf.gltf.transmission);
        takes = !HAS_SPECULAR || diffuse > 0.1 || min(bsdf.gltf.alpha.x, bsdf.gltf.alpha.y) > wide;
    }
    if (HAS_MODEL(MODEL_OREN_NAYAR) && bsdf.model == MODEL_OREN_NAYAR + 1u) takes = true;
    if (HAS_MODEL(MODEL_PHONG) && bsdf.model == MODEL_PHONG + 1u) takes = bsdf.other.exponent < 50.0;
    if (HAS_MODEL(MODEL_BLINN_PHONG) && bsdf.model == MODEL_BLINN_PHONG + 1u) takes = bsdf.other.exponent < 200.0;
    return takes && !bsdf.unlit;
}
vec3 ownLight(SurfaceBsdf bsdf) {
    return HAS_UNLIT && bsdf.unlit ? bsdf.albedo : vec3(0.0);
}

ScatterValue localValue(SurfaceBsdf bsdf, vec3 wi) {
    ScatterValue v = noScattering();
    if (HAS_GLTF && bsdf.model == 0u) v = HAS_SPECULAR ? gltfValue(bsdf.gltf, bsdf.wo, wi) : lambertValue(bsdf.gltf.baseColor, bsdf.wo, wi);
    if (HAS_MODELS && bsdf.model != 0u) v = modelValue(bsdf.other, bsdf.wo, wi);
    return v;
}

/** A local direction drawn; what it is worth, but for mirrors, comes from localValue. */
ScatterSample localDirection(SurfaceBsdf bsdf, vec3 u) {
    ScatterSample chosen = noSample();
    if (HAS_GLTF && bsdf.model == 0u) {
        if (HAS_SPECULAR)
            chosen = gltfSample(bsdf.gltf, bsdf.wo, u);
        else
            chosen = ScatterSample(cosineHemisphere(u.xy), vec3(0.0), 1.0);
    }
    if (HAS_MODELS && bsdf.model != 0u) chosen = modelDirection(bsdf.other, bsdf.wo, u);
    return chosen;
}

#ifdef TILTED_FACETS
#include "shaders/scattering/facet_walk.glsl"

/** The first of the directions drawn, local. */
SurfaceSample sampleSurface(SurfaceBsdf bsdf, SurfacePoint s, vec2 u, float choice) {
    const ScatterSample chosen = localDirection(bsdf, vec3(u, choice));
    return SurfaceSample(chosen.direction, chosen.weight, chosen.density, !bsdf.unlit && chosen.density != 0.0);
}

void surfaceValues(SurfaceBsdf bsdf, SurfacePoint s, vec3 toLights[LIGHTS_ASKED], const bool asks, float lightDensity,
                   inout SurfaceSample next, out SurfaceValue lit[LIGHTS_ASKED]) {
    // One walk judges one light: there is but one sample.
    const FacetWalk walk = walkFacets(bsdf, bsdf.facets, bsdf.folds, bsdf.facetKey, toLights[0], asks, lightDensity,
                                      ScatterSample(next.direction, next.weight, next.density));
    const bool goes = next.goes && maxComponent(walk.weight) > 0.0;
    next = SurfaceSample(walk.direction, walk.weight, walk.density, goes);
    lit[0] = SurfaceValue(maxComponent(walk.lit) > 0.0 ? 1.0 : 0.0, walk.lit);
}
#else

/** A direction drawn; what it is worth, but for mirrors, comes from surfaceValues. */
SurfaceSample sampleSurface(SurfaceBsdf bsdf, SurfacePoint s, vec2 u, float choice) {
    const ScatterSample chosen = localDirection(bsdf, vec3(u, choice));
    SurfaceSample r;
    r.direction = bsdf.frame * chosen.direction;
    const float height = dot(s.face, r.direction);
    if ((height > 0.0) != (chosen.direction.z > 0.0)) r.direction -= 2.0 * height * s.face;
    r.direction = normalize(r.direction);
    r.density = chosen.density;
    r.weight = chosen.weight;
    r.goes = !bsdf.unlit && chosen.density != 0.0;
    return r;
}

/** Values of directions to lights, where one `asks`, and of the direction drawn: each of the lobe there, and of what
 * is mirrored to it. One loop, not unrolled: the code of all materials is in the kernel once. */
void surfaceValues(SurfaceBsdf bsdf, SurfacePoint s, vec3 toLights[LIGHTS_ASKED], const bool asks, float lightDensity,
                   inout SurfaceSample next, out SurfaceValue lit[LIGHTS_ASKED]) {
    ScatterValue drawn = noScattering();
    ScatterValue values[LIGHTS_ASKED];
    [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i) values[i] = noScattering();
    const int ways = HAS_TILTED_LOBES ? 2 : 1, last = LIGHTS_ASKED * ways;
    [[dont_unroll]] for (int i = asks ? 0 : last; i < last + ways; ++i) {
        const bool isDrawn = i >= last;
        vec3 wi = next.direction;
        [[unroll]] for (int j = 0; j < LIGHTS_ASKED; ++j) wi = i >= j * ways && i < (j + 1) * ways ? toLights[j] : wi;
        const float height = dot(s.face, wi);
        const bool above = height > 0.0, mirrors = HAS_TILTED_LOBES && (i & 1) == 1;
        const vec3 local = (wi - (mirrors ? 2.0 * height : 0.0) * s.face) * bsdf.frame;
        const bool counts = (local.z > 0.0) == above && (HAS_LIGHT_THROUGH || above);
        const ScatterValue v = localValue(bsdf, local);
        if (counts && isDrawn) drawn = ScatterValue(drawn.value + v.value, drawn.density + v.density);
        [[unroll]] for (int j = 0; j < LIGHTS_ASKED; ++j)
            if (counts && i >= j * ways && i < (j + 1) * ways)
                values[j] = ScatterValue(values[j].value + v.value, values[j].density + v.density);
    }
    if (next.density >= 0.0) {
        next.density = drawn.density;
        next.weight = drawn.density > 0.0 ? drawn.value / drawn.density : vec3(0.0);
    }
    next.goes = next.goes && max(max(next.weight.x, next.weight.y), next.weight.z) > 0.0;
    [[unroll]] for (int i = 0; i < LIGHTS_ASKED; ++i)
        lit[i] = SurfaceValue(values[i].density, values[i].density > 0.0 ? values[i].value / values[i].density : vec3(0.0));
}
#endif
#endif
