#ifndef HELIOGRAPH_SCENE_LIGHTS
#define HELIOGRAPH_SCENE_LIGHTS
/** @file
 * Sampling a light in proportion to power: one row of an alias table, then a point on it.
 */
#include "shaders/sampling/hash.glsl"
#include "shaders/scene/features.glsl"
#include "shaders/scene/materials.glsl"
#ifdef SURFACE_MATERIALS
#include "shaders/scene/surface_material.glsl"
#endif
#ifdef ENVIRONMENT_IMAGE
#include "shaders/scene/environment.glsl"
#endif
#ifdef SHAPES
#include "shaders/intersection/shape.glsl"
#include "shaders/scene/sphere_light.glsl"
#endif
#ifdef SOLID_ANGLES
#include "shaders/scene/solid_angle_light.glsl"
#endif
#ifdef LIGHT_TABLES
#include "shaders/scene/light_tables.glsl"
#else
/** Lights are chosen by power, whatever the place. */
int lightPlace(vec3 p, vec3 n) {
    return 0;
}
#endif

/**
 * 6 texels a light (kLightTexels):
 * 0: corner, centre or position | bits of the alias slot's threshold (passes/scene/alias_table.hpp)
 * 1: edge (sphere: axis X, as long as the radius) | bits of the row taken otherwise
 * 2: edge (sphere: axis Y; spot: scale and offset of the cone; punctual: z is the range, 0 for none) | bits of the kind
 * 3: radiance (intensity; irradiance) RGB | chance density per area, negative where both faces emit
 *    (punctual: chance to be chosen)
 * 4: unit normal (sphere: 0; spot, directional: direction of the light) | offset against rounding, along the normal
 * 5: bits of g, bits of material, chance to be chosen, 1 / area
 */
layout(set = 0, binding = 26) uniform usamplerBuffer uLights;
const int LIGHT_TEXELS = 6;
const uint LIGHT_TRIANGLE = 0u, LIGHT_PARALLELOGRAM = 1u, LIGHT_POINT = 2u, LIGHT_SPOT = 3u, LIGHT_DIRECTIONAL = 4u,
           LIGHT_ENVIRONMENT = 5u, LIGHT_QUAD = 6u, LIGHT_DISC = 7u, LIGHT_SPHERE = 8u;

#include "generated.glsl"
#ifdef UNROLLED_LIGHT
/** The only light of the scene, written out. */
const uvec4 ONLY_LIGHT[LIGHT_TEXELS] = UNROLLED_LIGHT;
#define LIGHT_ROW(first, i) ONLY_LIGHT[i]
#else
#define LIGHT_ROW(first, i) texelFetch(uLights, first + i)
#endif

/** Points of lights may pass with what is left of alpha. */
#ifdef SURFACE_MATERIALS
const bool SEEN_THROUGH = HAS_ALPHA;
#else
const bool SEEN_THROUGH = false;
#endif

#ifdef SOLID_ANGLES
bool hasSolidAngle(uint kind) {
    return kind <= LIGHT_PARALLELOGRAM || kind == LIGHT_QUAD;
}
#endif

struct LightSample {
    vec3 target;        ///< end of the shadow ray: on the light, moved off it by its error bound
    bool infinite;      ///< `target` is a direction, not a point
    vec3 direction;     ///< unit, from the receiver to the light
    vec3 radiance;      ///< estimate of the integral over the light: L / density over solid angle, or the
                        ///< irradiance across the direction for a punctual light, each over the chance
    ivec2 triangles;    ///< first and last g of the light; (1, 0) for a punctual one
    float density;      ///< over solid angle; 0 for a punctual light, which no ray finds
};

/** Samples light for a receiver at p, which is in `place` (lightPlace). `choice` picks the light, `random` the point on it: 32 random bits each. A
 * sample with zero radiance brings nothing. */
LightSample sampleLight(vec3 p, int place, uint choice, uvec2 random) {
    int row = 0;
#ifdef LIGHT_TABLES
    float chance;
    row = chooseLight(place, choice, chance);
#else
    if (LIGHT_COUNT > 1) {
        row = int(choice >> (32 - LIGHT_BITS));
        const uint fraction = choice & ((1u << (32 - LIGHT_BITS)) - 1u);
        const uint threshold = texelFetch(uLights, row * LIGHT_TEXELS).w;
        const int other = int(texelFetch(uLights, row * LIGHT_TEXELS + 1).w);
        row = fraction < threshold ? row : other;
    }
#endif
    const int first = row * LIGHT_TEXELS;
    const vec4 corner = uintBitsToFloat(LIGHT_ROW(first, 0));
    const vec4 edge1 = uintBitsToFloat(LIGHT_ROW(first, 1));
    const uvec4 edge2Bits = LIGHT_ROW(first, 2);
    const vec3 edge2 = uintBitsToFloat(edge2Bits.xyz);
    vec4 strength = uintBitsToFloat(LIGHT_ROW(first, 3));
#ifdef LIGHT_TABLES
    // The density per area under this place's chances, or the chance.
    const float perArea = uintBitsToFloat(LIGHT_ROW(first, 5).w);
    strength.w = chance * (perArea > 0.0 ? (strength.w < 0.0 ? -perArea : perArea) : 1.0);
#endif
    const vec4 facingOf = uintBitsToFloat(LIGHT_ROW(first, 4));
    const uint kind = edge2Bits.w;

    LightSample result = LightSample(vec3(0.0), false, vec3(0.0), vec3(0.0), ivec2(1, 0), 0.0);
    if (HAS_AREA_LIGHTS) {
        const vec2 u = vec2(unitFloat(random.x), unitFloat(random.y));
        // The unit square folded along its diagonal covers a triangle evenly.
        const bool fold = HAS_TRIANGLE_LIGHTS && kind == LIGHT_TRIANGLE && u.x + u.y > 1.0;
        vec2 s = fold ? 1.0 - u : u;
#ifdef SHAPES
        if (kind == LIGHT_DISC) s = 0.5 + 0.5 * sqrt(u.x) * unitCircle(u.y);
#endif
#ifdef SOLID_ANGLES
        const float solidAngle = hasSolidAngle(kind) ? sampleSolidAngle(p, kind == LIGHT_TRIANGLE, corner.xyz, edge1.xyz, edge2, u, s) : 0.0;
#endif
        vec3 q = corner.xyz + edge1.xyz * s.x + edge2 * s.y;
        vec4 facing = facingOf;
#ifdef SHAPES
        const float radius = length(edge1.xyz);
        const bool isSphere = HAS_SPHERES && kind == LIGHT_SPHERE;
        if (isSphere) {
            facing.xyz = sphereNormalTowards(p, corner.xyz, radius, u);
            facing.w *= dot(abs(facing.xyz), abs(corner.xyz) + radius);
            q = corner.xyz + radius * facing.xyz;
        }
#endif
        const vec3 toLight = q - p;
        const float squared = dot(toLight, toLight);
        const float distance = sqrt(squared);
        result.direction = toLight / distance;
        const float cosine = -dot(facing.xyz, result.direction);
        const bool bothFaces = strength.w < 0.0;
        result.target = q + facing.xyz * (cosine < 0.0 ? -facing.w : facing.w);
        const float towards = bothFaces ? abs(cosine) : cosine;
        const bool visible = towards > 0.0 && squared > 0.0;
        result.density = visible ? abs(strength.w) * squared / towards : 0.0;
#ifdef SOLID_ANGLES
        if (solidAngle > 0.0 && visible) result.density = abs(strength.w) / (uintBitsToFloat(LIGHT_ROW(first, 5).w) * solidAngle);
#endif
#ifdef SHAPES
        if (isSphere && visible) result.density = abs(strength.w) * sphereDensity(p, corner.xyz, radius, distance, towards);
#endif
        result.radiance = visible ? strength.rgb / result.density : vec3(0.0);
        const uvec4 identity = LIGHT_ROW(first, 5);
        result.triangles = ivec2(int(identity.x), int(identity.x) + (kind == LIGHT_PARALLELOGRAM ? 1 : 0));
        vec3 b = vec3(1.0 - s.x - s.y, s.x, s.y);
        bool isWhole = kind == LIGHT_TRIANGLE;
#ifdef SHAPES
        // The coordinates of passes/pathtrace/surface.glsl.
        isWhole = isWhole || kind >= LIGHT_QUAD;
        if (kind >= LIGHT_QUAD) b = vec3(3.0 - 2.0 * (s.x + s.y), 2.0 * s - 1.0);
        if (isSphere && (HAS_EMISSION_TEXTURES || SEEN_THROUGH)) {
            const vec2 uv = sphereCoordinates(facing.xyz, edge1.xyz, edge2);
            b = vec3(1.0 - uv.x - uv.y, uv);
        }
#endif
        if (HAS_EMISSION_TEXTURES) {
            const int g = int(identity.x), material = int(identity.y);
            // Only whole triangles and shapes carry textures (parallelograms are merged where emission is constant).
            if (isWhole) result.radiance *= materialTexture(material, 5, texcoords(g, b)).rgb;
        }
#ifdef SURFACE_MATERIALS
        // A ray that happens to come here passes with what is left of alpha.
        if (HAS_ALPHA) {
            const bool isSurface = isWhole || kind == LIGHT_PARALLELOGRAM;
            if (isSurface) result.radiance *= opacity(int(identity.y), int(identity.x), b);
        }
#endif
    }
    if (HAS_PUNCTUAL_LIGHTS && (!HAS_AREA_LIGHTS || (kind >= LIGHT_POINT && kind < LIGHT_ENVIRONMENT))) {
        const bool directional = kind == LIGHT_DIRECTIONAL;
        const vec3 toLight = directional ? -facingOf.xyz : corner.xyz - p;
        const float squared = dot(toLight, toLight);
        result.direction = toLight * inversesqrt(max(squared, 1e-37));
        result.target = directional ? result.direction : corner.xyz;
        result.infinite = directional;
        result.triangles = ivec2(1, 0);
        result.density = 0.0;
        float attenuation = directional ? 1.0 : 1.0 / max(squared, 1e-37);
        if (kind == LIGHT_SPOT) {
            const float cone = clamp(-dot(facingOf.xyz, result.direction) * edge2.x + edge2.y, 0.0, 1.0);
            attenuation *= cone * cone;
        }
        if (!directional && edge2.z > 0.0) {
            // KHR_lights_punctual's window, 0 beyond the range.
            const float ratio = squared / (edge2.z * edge2.z);
            attenuation *= clamp(1.0 - ratio * ratio, 0.0, 1.0);
        }
        result.radiance = squared > 0.0 ? strength.rgb * (attenuation / strength.w) : vec3(0.0);
    }
#ifdef ENVIRONMENT_IMAGE
    if (kind == LIGHT_ENVIRONMENT) {
        const EnvironmentRadiance from = sampleEnvironment(random, result.direction);
        result.target = result.direction;
        result.infinite = true;
        result.triangles = ivec2(1, 0);
        result.density = from.density * strength.w;
        result.radiance = result.density > 0.0 ? from.radiance / result.density : vec3(0.0);
    }
#endif
    return result;
}

#ifdef LIGHT_TABLES
/** Density per area with which sampleLight() takes a point of the light that triangle g belongs to. */
float lightAreaDensity(int place, int g) {
    const int row = int(texelFetch(uLightOfTriangle, g).x);
#ifdef MOTION_KEYS
    if (row < 0) return 0.0;  // it moves, and is found by rays alone
#endif
    return lightChance(place, row) * uintBitsToFloat(LIGHT_ROW(row * LIGHT_TEXELS, 5).w);
}
#endif
#ifdef SOLID_ANGLES
/** Density over solid angle with which sampleLight() for p takes the light that triangle g belongs to, where it does so by
 * solid angle; else `density`, that by area. */
float solidAngleDensity(vec3 p, int place, int g, float density) {
    int row = 0;
    float chance = 1.0;
#ifdef LIGHT_TABLES
    row = int(texelFetch(uLightOfTriangle, g).x);
    if (row < 0) return density;
    chance = lightChance(place, row);
#endif
    const int first = row * LIGHT_TEXELS;
    const uvec4 edge2 = LIGHT_ROW(first, 2);
    if (!hasSolidAngle(edge2.w)) return density;
    const float solidAngle =
        sampledSolidAngle(p, edge2.w == LIGHT_TRIANGLE, uintBitsToFloat(LIGHT_ROW(first, 0).xyz),
                          uintBitsToFloat(LIGHT_ROW(first, 1).xyz), uintBitsToFloat(edge2.xyz));
    return solidAngle > 0.0 ? chance / solidAngle : density;
}
#endif
#if defined(LIGHT_TABLES) && defined(ENVIRONMENT_IMAGE)
float environmentChance(int place) {
    const int row = floatBitsToInt(texelFetch(uEnvironmentMap, 0).y);
    return row < 0 ? 0.0 : lightChance(place, row);
}
#endif

/** What a ray that leaves the scene brings: `constant` where the environment is no image, else the image's radiance
 * weighted against sampleLight(). `density`: over solid angle, with which the direction was drawn; negative where
 * light was not sampled for it. */
vec3 environmentLight(vec3 direction, float density, int place, vec3 constant) {
#ifdef ENVIRONMENT_IMAGE
    const EnvironmentRadiance from = environmentAt(direction);
#ifdef LIGHT_TABLES
    const float sampled = from.density * environmentChance(place);
#else
    const float sampled = from.density * texelFetch(uEnvironmentMap, 0).x;
#endif
    return from.radiance * (density < 0.0 ? 1.0 : density / (density + sampled));
#else
    return constant;
#endif
}
#endif
