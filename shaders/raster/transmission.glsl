// Light through surfaces, as rasterizers of KHR_materials_transmission and KHR_materials_volume do it. A thin wall lets
// light on in line, layer by layer. A volume refracts the view at its first face; after the volume's thickness the view
// leaves by a face parallel to the first, so in its old direction, and shows what a picture without the nearest
// refracting layers (passes/shade/alpha_layers.hpp) has where it meets it. Reflections between the two faces are summed:
// smooth plates are exact. Rough ones draw directions as the path tracer does, each of which reads the mip level as wide
// as its share of the lobe (Krivanek and Colbert, "Real-time shading with filtered importance sampling", EGSR 2008).
#ifndef SHADERS_RASTER_TRANSMISSION_GLSL
#define SHADERS_RASTER_TRANSMISSION_GLSL

layout(set = 0, binding = 17) uniform samplerBuffer uBehind;       ///< the picture without the nearest refracting layers
layout(set = 0, binding = 18) uniform samplerBuffer uBehindDepth;  ///< w: its distance along the viewing axis, 0 for a miss
layout(set = 0, binding = 38) uniform samplerBuffer uInstanceScales;
#if TRANSMISSION > 1
// Of rough surfaces: levels of uBehind from 1, and where they lie (shaders/texture/mip_table.glsl).
layout(set = 0, binding = 19) uniform samplerBuffer uBehindMips;
layout(set = 0, binding = 21) uniform usamplerBuffer uBehindTable;
const int DIRECTIONS = 16;  ///< of a rough surface's lobe
#endif

/// What a surface lets through of the light behind it.
struct LightThrough {
    bool any;
    bool hidden;      // the far face of a volume, whose near face shows all that comes through
    bool deflects;    // light does not come from straight behind
    bool thin;
    vec3 tint;        // of all but reflection and absorption
    vec2 alpha;
    float eta;        // index of the volume
    float thickness;  // m
    vec3 absorption;  // 1/m
};

vec3 attenuation(vec3 absorption, float way) {
    vec3 depth = -min(absorption * way, 80.0);
    return vec3(realExp(depth.x), realExp(depth.y), realExp(depth.z));
}

LightThrough lightThrough(Shaded shaded) {
    SurfaceBsdf bsdf = shaded.bsdf;
    LightThrough t = LightThrough(false, false, false, true, vec3(0.0), vec2(0.0), 1.0, 0.0, vec3(0.0));
    int material = shaded.point.triangle.material;
    if (HAS_GLTF && HAS_TRANSMISSION && bsdf.model == 0u) {
        GltfSurface s = bsdf.gltf;
        t.tint = s.baseColor * ((1.0 - s.metallic) * s.transmission);
        if (HAS_CLEARCOAT || HAS_SHEEN) t.tint *= gltfLayers(s, bsdf.wo, -bsdf.wo);
        t.thin = s.thin;
        if (!t.thin) {
            t.tint *= s.baseColor;  // once more where the light entered
            t.eta = shaded.point.front ? s.eta : 1.0 / s.eta;
            t.thickness = materialRow(material, 13).w * texelFetch(uInstanceScales, shaded.instance).x;
            vec4 uv = texcoords(shaded.g, shaded.point.b);
            t.thickness *= materialTexture(material, 40, uv).g;
            t.absorption = materialRow(material, 9).rgb;
        }
        t.alpha = s.alpha;
    }
    if (HAS_MODEL(MODEL_THIN_DIELECTRIC) && bsdf.model == MODEL_THIN_DIELECTRIC + 1u) t.tint = bsdf.other.color;
    if (HAS_MODEL(MODEL_DIELECTRIC) && bsdf.model == MODEL_DIELECTRIC + 1u) {
        t.tint = vec3(1.0);
        t.thin = false;
        t.eta = bsdf.other.n.x;
        t.absorption = materialRow(material, 9).rgb;
        t.alpha = bsdf.other.facets.alpha;
    }
    t.any = maxComponent(t.tint) > 0.0 && !bsdf.unlit;
    t.hidden = t.any && !t.thin && !shaded.point.front;
    bool rough = max(t.alpha.x, t.alpha.y) * (t.thin ? 1.0 : abs(t.eta - 1.0)) >= (t.thin ? 1.0 : 0.25) * SMOOTH_ALPHA;
    if (!HAS_ROUGH_FACETS) rough = false;
    if (!rough) t.alpha = vec2(0.0);
    t.deflects = t.any && !t.hidden && (rough || (!t.thin && t.eta != 1.0 && t.thickness > 0.0));
    return t;
}

/// Reflectance of one face for a view that meets a facet at `cosine`.
float faceReflectance(SurfaceBsdf bsdf, float cosine) {
    float f = 0.0;
    if (HAS_GLTF && bsdf.model == 0u) f = maxComponent(gltfFresnel(bsdf.gltf, cosine).dielectric);
    if (HAS_MODEL(MODEL_DIELECTRIC) && bsdf.model == MODEL_DIELECTRIC + 1u) f = fresnelDielectric(cosine, bsdf.other.n.x);
    if (HAS_MODEL(MODEL_THIN_DIELECTRIC) && bsdf.model == MODEL_THIN_DIELECTRIC + 1u)
        f = paneReflectance(fresnelDielectric(cosine, bsdf.other.n.x));
    return min(f, 1.0);
}

/// Share of light that goes through both faces, and that comes back from the far one.
struct SlabShares {
    vec3 through, back;
};
SlabShares slabShares(SurfaceBsdf bsdf, LightThrough t, float cosine) {
    float f = faceReflectance(bsdf, cosine);
    if (t.thin) return SlabShares(t.tint * (1.0 - f), vec3(0.0));
    vec3 left = attenuation(t.absorption, t.thickness);
    vec3 through = t.tint * left * ((1.0 - f) * (1.0 - f)) / max(1.0 - f * f * left * left, 1e-6);
    return SlabShares(through, through * left * f);
}

/// Where a point, relative to the eye, is on the screen.
vec2 pixelsOf(vec3 p) {
    vec2 at = vec2(dot(vec3(push.rowX.xyz), p), dot(vec3(push.rowY.xyz), p));
    return ORTHOGRAPHIC ? at + 0.5 * vec2(imageSizePixels()) : at / max(dot(vec3(push.rowW.xyz), p), 1e-30);
}
bool onPicture(vec2 at) { return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(imageSizePixels()))); }
/// Distance of what the picture has there; of the pixel itself where that is nearer than the surface, and no background.
float distanceBehind(vec2 at, ivec2 pixel, float nearest) {
    ivec2 size = imageSizePixels(), there = clamp(ivec2(at), ivec2(0), size - 1);
    float z = texelFetch(uBehindDepth, there.y * size.x + there.x).w;
    float here = texelFetch(uBehindDepth, pixel.y * size.x + pixel.x).w;
    return z > 0.0 && z < nearest ? here : z;
}

/// Bilinear in one level of the picture, `at` in pixels of the picture.
vec3 pictureLevel(int level, vec2 at) {
    ivec2 full = imageSizePixels();
    int first = 0;
    ivec2 size = full;
#if TRANSMISSION > 1
    if (level > 0) {
        uvec3 place = texelFetch(uBehindTable, int(texelFetch(uBehindTable, 0).x) + level - 1).xyz;
        first = int(place.x);
        size = ivec2(place.yz);
    }
#endif
    vec2 p = at * vec2(size) / vec2(full) - 0.5, corner = floor(p), f = p - corner;
    ivec2 low = clamp(ivec2(corner), ivec2(0), size - 1), high = clamp(ivec2(corner) + 1, ivec2(0), size - 1);
    ivec4 index = first + ivec4(low.y * size.x + low.x, low.y * size.x + high.x, high.y * size.x + low.x, high.y * size.x + high.x);
#if TRANSMISSION > 1
    if (level > 0)
        return mix(mix(texelFetch(uBehindMips, index.x).rgb, texelFetch(uBehindMips, index.y).rgb, f.x),
                   mix(texelFetch(uBehindMips, index.z).rgb, texelFetch(uBehindMips, index.w).rgb, f.x), f.y);
#endif
    return mix(mix(texelFetch(uBehind, index.x).rgb, texelFetch(uBehind, index.y).rgb, f.x),
               mix(texelFetch(uBehind, index.z).rgb, texelFetch(uBehind, index.w).rgb, f.x), f.y);
}

/// Of the surroundings, over a lobe of so many steradians.
vec3 surroundingsAlong(vec3 direction, float solidAngle) {
    vec3 radiance = vec3(0.0);
#if defined(SPECULAR_ENVIRONMENT)
    // GGX of width alpha reflects a parallel view into 1 / (4 pi alpha^2) a steradian at most.
    radiance = glossyRadiance(direction, direction, sqrt(sqrt(solidAngle * (0.25 * INV_PI))));
#elif defined(ENVIRONMENT_IMAGE)
    radiance = environmentAt(direction).radiance;
#else
    if (HAS_ENVIRONMENT) radiance = texelFetch(uEnvironment, 0).rgb;
#endif
    return radiance;
}

/// Radiance that arrives at `from` (relative to the eye) against a unit direction, over a lobe of so many steradians
/// whose tip is `way` metres before. The ray ends where its own distance is the picture's; what the picture does not
/// show is the surroundings, or where there are none the picture's border.
vec3 radianceBehind(ivec2 pixel, float nearest, vec3 from, vec3 direction, float solidAngle, float way) {
    vec3 axis = vec3(push.rowW.xyz);
    float depth = dot(axis, from), slope = dot(axis, direction);
    vec2 at = pixelsOf(from);
    float z = 0.0, s = 0.0;
    for (int i = 0; i < 4; ++i) {
        z = distanceBehind(at, pixel, nearest);
        s = z > 0.0 && slope > 1e-6 ? max((z - depth) / slope, 0.0) : 0.0;
        at = pixelsOf(from + s * direction);
    }
    bool surroundings = z <= 0.0 || slope <= 1e-6;
    if (HAS_ENVIRONMENT) surroundings = surroundings || !onPicture(at);
    vec3 radiance = vec3(0.0);
#if TRANSMISSION > 1
    // Pixels a metre at the picture's distance, each way.
    vec3 x = vec3(push.rowX.xyz), y = vec3(push.rowY.xyz);
    float scale = length(x - dot(x, axis) * axis) * length(y - dot(y, axis) * axis);
    if (!ORTHOGRAPHIC) scale /= max(z * z, 1e-30);
    float pixels = solidAngle * (s + way) * (s + way) * scale;
    int last = int(texelFetch(uBehindTable, 0).y) - 1;
    float level = clamp(pixels > 1.0 ? 0.5 * realLog2(min(pixels, 1e30)) : 0.0, 0.0, float(last));
    int fine = int(level);
    radiance = mix(pictureLevel(fine, at), pictureLevel(min(fine + 1, last), at), level - float(fine));
#else
    radiance = pictureLevel(0, at);
#endif
    return surroundings ? surroundingsAlong(direction, solidAngle) : radiance;
}

/// Radiance that comes through, by the volume's index `eta`.
vec3 seenThrough(ivec2 pixel, Shaded shaded, LightThrough t, float eta) {
    SurfaceBsdf bsdf = shaded.bsdf;
    vec3 wo = bsdf.wo, sum = vec3(0.0);
    int count = 1;
#if TRANSMISSION > 1
    bool rough = t.alpha.x > 0.0;
    if (rough) count = DIRECTIONS;
    // Facets of both faces turn the light: variances add.
    vec2 alpha = rough ? min(t.alpha * (t.thin ? 1.0 : 1.41421356), vec2(1.0)) : vec2(1.0);
#endif
    for (int k = 0; k < count; ++k) {
        vec3 h = vec3(0.0, 0.0, 1.0);
#if TRANSMISSION > 1
        vec2 u = vec2((float(k) + 0.5) / float(DIRECTIONS), float(bitfieldReverse(uint(k)) >> 8) * exp2(-24.0) + 0.5 / float(DIRECTIONS));
        if (rough) h = ggxSampleNormal(wo, alpha, u.yx);
#endif
        float cosine = clamp(dot(wo, h), 0.0, 1.0), beyond, weight = 1.0, solidAngle = 0.0;
        vec3 inside = reflectedAbout(wo, h), leaving = vec3(inside.xy, -inside.z);
        bool goes = inside.z > 0.0;
        if (!t.thin) {
            fresnelDielectric(cosine, eta, beyond);
            inside = normalize(refractedAbout(wo, h, eta, beyond));
            vec2 across = inside.xy * eta;
            float squared = dot(across, across);
            if (squared > 0.9999) across *= sqrt(0.9999 / squared);
            leaving = vec3(across, -sqrt(1.0 - min(squared, 0.9999)));
            goes = inside.z < 0.0;
        }
#if TRANSMISSION > 1
        if (rough) {
            vec3 to = t.thin ? leaving : inside;
            weight = 2.0 * ggxShadowing(wo, to, alpha) * (wo.z + ggxStretch(wo, alpha));
            float density = t.thin ? ggxReflectedDensity(wo, h, alpha)
                                   : ggxVisibleNormals(wo, h, alpha) / max((eta - 1.0) * (eta - 1.0), 1e-12);
            solidAngle = 1.0 / (float(DIRECTIONS) * max(density, 1e-12));
        }
#endif
        vec3 from = shaded.position + (bsdf.frame * inside) * (t.thin ? 0.0 : t.thickness);
        vec3 direction = bsdf.frame * leaving;
        direction -= 2.0 * max(dot(direction, shaded.point.face), 0.0) * shaded.point.face;
        vec3 arriving = radianceBehind(pixel, shaded.depth, from, direction, solidAngle, t.thin ? 0.0 : t.thickness);
        sum += goes ? weight * slabShares(bsdf, t, cosine).through * arriving : vec3(0.0);
    }
    return sum / float(count);
}

/// The same in all colours, whose indices differ where the material disperses: KHR_materials_dispersion.
vec3 refracted(ivec2 pixel, Shaded shaded, LightThrough t) {
    if (!HAS_DISPERSION) return seenThrough(pixel, shaded, t, t.eta);
    float spread = (t.eta - 1.0) * 0.025 * materialRow(shaded.point.triangle.material, 8).z;
    vec3 light = vec3(0.0);
    for (int c = 0; c < 3; ++c)
        light += seenThrough(pixel, shaded, t, max(t.eta + spread * float(c - 1), 1.0)) * vec3(c == 0, c == 1, c == 2);
    return light;
}

/// What comes back from the far face of a volume, of surroundings that nothing hides.
vec3 reflectedWithin(Shaded shaded, LightThrough t) {
    vec3 light = vec3(0.0);
#ifdef SPECULAR_ENVIRONMENT
    SurfaceBsdf bsdf = shaded.bsdf;
    if (!t.thin) {
        vec3 normal = bsdf.frame[2], direction = normalizeSafe(bsdf.frame * mirrored(bsdf.wo), normal);
        light = slabShares(bsdf, t, bsdf.wo.z).back * glossyRadiance(direction, normal, lobeRoughness(t.alpha));
    }
#endif
    return light;
}

#endif
