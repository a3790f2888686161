// First shading of a visibility buffer: base colour, two-sided Lambert under lights, and emission.
#ifndef SHADERS_RASTER_SHADING_GLSL
#define SHADERS_RASTER_SHADING_GLSL

#include "shaders/raster/footprint.glsl"
#include "shaders/raster/polygon_light.glsl"
#include "shaders/raster/shadow.glsl"
#include "shaders/raster/surface.glsl"
#include "shaders/sampling/hash.glsl"
#include "shaders/scene/lights.glsl"
#include "shaders/scene/materials.glsl"
layout(set = 0, binding = 3) uniform samplerBuffer uEnvironment;    ///< constant radiance of the surroundings; PackedScene::diffuseEnvironment
#ifdef SURFACE_MATERIALS
#include "shaders/raster/material_light.glsl"
#endif
#ifdef BLINN_PHONG
#include "shaders/raster/blinn_phong.glsl"
#endif

layout(constant_id = 121) const bool SCENE_ORDER = true;    ///< triangles lie in the order of their ids
layout(constant_id = 145) const int FEW_LIGHTS = 0;  ///< so many lights from push.first on, up to 4, without a loop, which costs some drivers more than its turns; 0: a loop
layout(constant_id = 128) const int LIGHT_SAMPLES = 0;       ///< emissive surfaces that a pixel draws; 0: push's range has them all
layout(constant_id = 129) const int AREA_LIGHTS = 0;    ///< their number, where they are drawn
layout(set = 0, binding = 0, std430) readonly buffer uVisibility { uvec2 visibility[]; };  ///< id's complement, depth; of every sample
layout(set = 0, binding = 1) uniform usamplerBuffer uSlots;         ///< place of a triangle by its id
layout(set = 0, binding = 2) uniform usamplerBuffer uInstanceFirst;  ///< first id of every instance
#ifdef DRAWN_LIGHTS
layout(set = 0, binding = 11) uniform usamplerBuffer uLightSums;     ///< powers of the lights before, LIGHT_SAMPLES strides in all
#endif

#ifdef OCCLUSION
const bool HAS_OCCLUSION = true;
#else
const bool HAS_OCCLUSION = false;
#endif

#ifdef LIGHTMAPS
const bool HAS_LIGHTMAPS = true;
#else
const bool HAS_LIGHTMAPS = false;
#endif

#ifdef CORNERS
/// Where light is found for CORNERS corners of a triangle (1: once for all of it), two texels each: that on kd / pi, and
/// that on ks.
layout(set = 0, binding = 14) uniform samplerBuffer uCornerLight;
#endif

struct Shaded {
    bool hit;
    vec3 emission;
    vec3 albedo;
    vec3 normal;    // towards the viewer
    vec3 position;  // relative to the eye
    vec3 faceNormal;
    float depth;
    int g;
    int instance;
    int triangle;   // within the instance
    vec3 diffuse;   // of light from many directions
    vec3 mirror;    // of the surroundings, as a smooth surface reflects them; Blinn and Phong's ks
#ifdef BLINN_PHONG
    vec3 toEye;
    vec3 b;         // barycentrics
    float exponent;
#endif
    float opacity;  // what it stops of the light behind
#ifdef LIGHTMAPS
    bool baked;     // all its light is a lightmap's, and in `emission`
#endif
#ifdef OCCLUSION
    float open;     // share of the light from all around that its surroundings leave
#endif
#ifdef SURFACE_MATERIALS
    SurfaceBsdf bsdf;
    SurfacePoint point;
#endif
};

/// Everything that light does not change of what a visibility key shows at a pixel's centre.
Shaded shadePoint(ivec2 pixel, uvec2 key) {
    Shaded shaded;
    shaded.hit = (key.x | key.y) != 0u;
    int g = shaded.hit ? int(~key.x) : 0;
    int slot = g;
    if (!SCENE_ORDER) slot = int(texelFetch(uSlots, g).x);
    Triangle source = fetchTriangle(slot);
    Surface surface = surfaceAt(source, pixel);

    vec4 uv = vec4(0.0), dx = vec4(0.0), dy = vec4(0.0);
    if (HAS_BASE_TEXTURES || HAS_EMISSION_TEXTURES || HAS_OCCLUSION || HAS_LIGHTMAPS || HAS_FOOTPRINT_NORMALS)
        footprint(g, surface, uv, dx, dy);
#ifdef FOOTPRINT_NORMALS
    pixelX = dx;
    pixelY = dy;
#endif
    vec4 base = uintBitsToFloat(texelFetch(uMaterials, source.material * MATERIAL_TEXELS));
    if (HAS_COLORS) base *= vertexColor(g, surface.b);
    if (HAS_BASE_TEXTURES) base *= filteredMaterialTexture(source.material, 3, uv, dx, dy);
#ifdef SOLID_TEXTURES
    base.rgb *= solidColor(source.material, g, surface.b, vec4(surface.db1, surface.db2));
#endif
    shaded.emission = vec3(0.0);
    if (HAS_EMISSION) {
        uvec4 row = texelFetch(uMaterials, source.material * MATERIAL_TEXELS + 1);
        bool emits = surface.front || (row.w & MATERIAL_DOUBLE_SIDED) != 0u;
        shaded.emission = emits ? uintBitsToFloat(row.xyz) : vec3(0.0);
        if (HAS_EMISSION_TEXTURES)
            shaded.emission *= filteredMaterialTexture(source.material, 5, uv, dx, dy).rgb;
    }
    vec3 normal = shadingNormal(g, surface.b, surface.faceNormal);
    shaded.normal = surface.front ? normal : -normal;
    shaded.albedo = base.rgb;
    shaded.diffuse = base.rgb;
    shaded.mirror = vec3(0.0);
    shaded.opacity = 1.0;
#ifdef OCCLUSION
    float strength = uintBitsToFloat(texelFetch(uMaterials, source.material * MATERIAL_TEXELS + 13).z);
    shaded.open = 1.0 + strength * (materialTexture(source.material, 47, uv).r - 1.0);
#endif
#ifdef SURFACE_MATERIALS
    if (HAS_ALPHA) shaded.opacity = opacityOf(source.material, base.a);
    shaded.point = rasterPoint(source, surface, shaded.normal);
    shaded.bsdf = rasterBsdf(source, surface, shaded.normal, base.rgb);
    shaded.diffuse = base.rgb * diffuseShare(shaded.bsdf);
    shaded.mirror = mirrorShare(shaded.bsdf);
    shaded.emission += shaded.hit ? ownLight(shaded.bsdf) : vec3(0.0);
#endif
#ifdef BLINN_PHONG
    shaded.toEye = surface.toEye;
    shaded.b = surface.b;
    shaded.exponent = 1.0;
#ifdef SURFACE_MATERIALS
    BlinnPhong model = blinnPhongOf(shaded.bsdf, base.rgb);
    shaded.diffuse = model.diffuse;
    shaded.mirror = model.specular;
    shaded.exponent = model.exponent;
    if (HAS_NORMAL_MAPS || HAS_BUMPS) shaded.normal = shaded.bsdf.frame[2];
#endif
#if defined(CORNERS) && CORNERS == 1
    shaded.normal = surface.front ? surface.faceNormal : -surface.faceNormal;
#endif
#endif
#ifdef LIGHTMAPS
    shaded.baked = false;
    uint flags = texelFetch(uMaterials, source.material * MATERIAL_TEXELS + 1).w;
    if (shaded.hit && surface.front && (flags & MATERIAL_LIGHTMAP) != 0u) {
        shaded.baked = true;
        shaded.emission += shaded.diffuse * INV_PI * materialTexture(source.material, 47, uv).rgb;
    }
#endif
    shaded.faceNormal = surface.faceNormal;
    shaded.g = g;
    shaded.position = surface.position;
    shaded.depth = surface.depth;
    shaded.instance = source.instance;
    shaded.triangle = g - int(texelFetch(uInstanceFirst, source.instance).x);
    return shaded;
}

/// Unoccluded irradiance of one light of the table on a surface: exact for a uniform polygon. Of a punctual light it is
/// that across `direction`, which is 0 for others.
vec3 lightIrradiance(int light, vec3 position, vec3 normal, out vec3 direction) {
    direction = vec3(0.0);
    int first = light * LIGHT_TEXELS;
    dvec3 eye = dvec3(push.rowX.w, push.rowY.w, push.rowW.w);
    vec3 corner = vec3(dvec3(uintBitsToFloat(texelFetch(uLights, first).xyz)) - eye) - position;
    vec3 edge1 = uintBitsToFloat(texelFetch(uLights, first + 1).xyz);
    uvec4 edge2Bits = texelFetch(uLights, first + 2);
    vec3 edge2 = uintBitsToFloat(edge2Bits.xyz);
    vec4 strength = uintBitsToFloat(texelFetch(uLights, first + 3));
    vec4 facing = uintBitsToFloat(texelFetch(uLights, first + 4));
    uint kind = edge2Bits.w;
    vec3 irradiance = vec3(0.0);
    if (HAS_AREA_LIGHTS) {
        float height = -dot(facing.xyz, corner);
        bool seen = (strength.w < 0.0 ? abs(height) : height) > facing.w;
        bool triangle = HAS_TRIANGLE_LIGHTS && kind == LIGHT_TRIANGLE;
        float factor = quadIrradiance(normal, corner, edge1, triangle ? edge1 : edge1 + edge2, edge2);
        vec3 radiance = strength.rgb;
        if (HAS_EMISSION_TEXTURES) {
            // One value for the whole light: the texture over all of the triangle.
            uvec4 identity = texelFetch(uLights, first + 5);
            int g = int(identity.x);
            vec4 uv0 = texelFetch(uTexcoords, g * 3), e1 = texelFetch(uTexcoords, g * 3 + 1) - uv0,
                 e2 = texelFetch(uTexcoords, g * 3 + 2) - uv0;
            if (triangle) radiance *= filteredMaterialTexture(int(identity.y), 5, uv0 + (e1 + e2) / 3.0, e1, e2).rgb;
        }
        irradiance = seen && kind <= LIGHT_PARALLELOGRAM ? radiance * factor : vec3(0.0);
    }
    if (HAS_PUNCTUAL_LIGHTS) {
        bool directional = kind == LIGHT_DIRECTIONAL;
        vec3 toLight = directional ? -facing.xyz : corner;
        float squared = dot(toLight, toLight);
        vec3 unit = toLight * inversesqrt(max(squared, 1e-37));
        float attenuation = directional ? 1.0 : 1.0 / max(squared, 1e-37);
        float cone = clamp(-dot(facing.xyz, unit) * edge2.x + edge2.y, 0.0, 1.0);
        attenuation *= kind == LIGHT_SPOT ? cone * cone : 1.0;
        // KHR_lights_punctual's window, 0 beyond the range.
        float ratio = squared / (edge2.z * edge2.z);
        attenuation *= !directional && edge2.z > 0.0 ? clamp(1.0 - ratio * ratio, 0.0, 1.0) : 1.0;
        bool shines = kind >= LIGHT_POINT && squared > 0.0;
        irradiance = shines ? strength.rgb * attenuation : irradiance;
        direction = shines ? unit : direction;
    }
    return irradiance;
}

/// What a pixel shows where it shows no surface.
vec3 visibleSurroundings(ivec2 pixel) {
    vec3 radiance = vec3(0.0);
#ifdef ENVIRONMENT_IMAGE
    radiance = environmentAt(pixelDirection(pixel)).radiance;
#else
    if (HAS_ENVIRONMENT) radiance = texelFetch(uEnvironment, 0).rgb;
#endif
    return radiance;
}

/// Radiance that a white Lambertian surface reflects of surroundings that nothing hides.
vec3 reflectedSurroundings(vec3 normal) {
    vec3 radiance = vec3(0.0);
#ifdef ENVIRONMENT_IMAGE
    const int WIDTH = 64, HEIGHT = 32;  // kDiffuseEnvironment...
    vec3 q = toEnvironment(normal);
    float x = (0.5 - realAtan2(q.x, q.z) * INV_TWO_PI) * float(WIDTH);
    float y = realAtan2(length(q.xz), q.y) * INV_PI * float(HEIGHT);
    int left = clamp(int(x), 0, WIDTH - 1), top = clamp(int(y), 0, HEIGHT - 1);
    int right = left + 1 == WIDTH ? 0 : left + 1, row = 1 + top * WIDTH;
    float s = x - float(left), t = y - float(top);
    radiance = mix(mix(texelFetch(uEnvironment, row + left).rgb, texelFetch(uEnvironment, row + right).rgb, s),
                   mix(texelFetch(uEnvironment, row + WIDTH + left).rgb,
                       texelFetch(uEnvironment, row + WIDTH + right).rgb, s), t);
#else
    if (HAS_ENVIRONMENT) radiance = texelFetch(uEnvironment, 0).rgb;  // over the hemisphere: irradiance pi L
#endif
    return radiance;
}

/// Estimate of the irradiance of all emissive surfaces: systematic sampling along the sums of their powers, so that every
/// light's expected weight is 1 and a pixel's lights are spread over the table. The pixel and the view decide: a picture
/// comes out the same again, and shifted views (supersampling) draw others.
vec3 drawnIrradiance(ivec2 pixel, vec3 position, vec3 normal) {
    vec3 irradiance = vec3(0.0);
#ifdef DRAWN_LIGHTS
    const uint stride = 0xffffffffu / uint(LIGHT_SAMPLES);
    uvec2 view = unpackDouble2x32(push.rowX.x + push.rowX.y + push.rowX.z + push.rowX.w + push.rowY.w + push.rowW.w);
    uint at = hashCombine(hashCombine(uint(pixel.x), uint(pixel.y)), view.x ^ view.y) % stride;
    for (int k = 0; k < LIGHT_SAMPLES; ++k) {
        // The last light whose sum is not above.
        int low = 0, high = AREA_LIGHTS;
        while (high - low > 1) {
            int middle = (low + high) >> 1;
            bool above = texelFetch(uLightSums, middle).x > at;
            low = above ? low : middle;
            high = above ? middle : high;
        }
        vec3 direction;
        float share = float(texelFetch(uLightSums, low + 1).x - texelFetch(uLightSums, low).x);
        irradiance += lightIrradiance(low, position, normal, direction) * (float(stride) / share);
        at += stride;
    }
#endif
    return irradiance;
}

#ifdef BLINN_PHONG
/// Light of the table's rows push.first to push.first + push.count - 1 on a point: `diffuse` on kd / pi, `gloss` on ks.
struct LightSums {
    vec3 diffuse, gloss;
};
void addBlinnPhong(int light, vec3 position, vec3 normal, vec3 toEye, float exponent, vec3 faceNormal, int g,
                   inout LightSums sums) {
    vec3 direction;
    vec3 arriving = lightIrradiance(light, position, normal, direction);
    if (SHADOWS != SHADOWS_NONE) arriving *= lightVisibility(light, position, faceNormal, g);
    bool punctual = HAS_PUNCTUAL_LIGHTS && direction != vec3(0.0);
    BlinnPhongLight factor = BlinnPhongLight(1.0, 0.0);
    if (punctual) factor = blinnPhongLight(normal, direction, toEye, exponent);
    sums.diffuse += arriving * factor.diffuse;
    sums.gloss += arriving * factor.gloss;
}
LightSums blinnPhongSums(ivec2 pixel, vec3 position, vec3 normal, vec3 toEye, float exponent, vec3 faceNormal, int g) {
    LightSums sums = LightSums(vec3(0.0), vec3(0.0));
    if (LIGHT_SAMPLES > 0) sums.diffuse = drawnIrradiance(pixel, position, normal);
    if (FEW_LIGHTS > 0) {
        int light = int(push.first);
        addBlinnPhong(light, position, normal, toEye, exponent, faceNormal, g, sums);
        if (FEW_LIGHTS > 1) addBlinnPhong(light + 1, position, normal, toEye, exponent, faceNormal, g, sums);
        if (FEW_LIGHTS > 2) addBlinnPhong(light + 2, position, normal, toEye, exponent, faceNormal, g, sums);
        if (FEW_LIGHTS > 3) addBlinnPhong(light + 3, position, normal, toEye, exponent, faceNormal, g, sums);
    } else if (HAS_AREA_LIGHTS || HAS_PUNCTUAL_LIGHTS)
        for (uint light = push.first; light < push.first + push.count; ++light)
            addBlinnPhong(int(light), position, normal, toEye, exponent, faceNormal, g, sums);
    return sums;
}
#endif

/// Adds a light's irradiance, or where it goes by its direction what the surface reflects of it.
void addLight(int light, Shaded shaded, inout vec3 irradiance, inout vec3 gloss) {
    vec3 direction;
    vec3 arriving = lightIrradiance(light, shaded.position, shaded.normal, direction);
    if (SHADOWS != SHADOWS_NONE) arriving *= lightVisibility(light, shaded.position, shaded.faceNormal, shaded.g);
    bool punctual = HAS_PUNCTUAL_LIGHTS && direction != vec3(0.0);
#ifdef SURFACE_MATERIALS
    if (HAS_PUNCTUAL_LIGHTS && punctual) gloss += arriving * valueTowards(shaded.bsdf, shaded.point, direction);
    irradiance += punctual ? vec3(0.0) : arriving;
#else
    irradiance += arriving * (punctual ? max(dot(shaded.normal, direction), 0.0) : 1.0);
#endif
}

/// Radiance that a surface reflects of the lights push.first to push.first + push.count - 1.
vec3 reflectedLight(ivec2 pixel, Shaded shaded) {
#ifdef LIGHTMAPS
    if (shaded.baked) return vec3(0.0);
#endif
#ifdef BLINN_PHONG
#ifdef CORNERS
    LightSums sums = LightSums(vec3(0.0), vec3(0.0));
    for (int k = 0; k < CORNERS; ++k) {
        int at = (shaded.g * CORNERS + k) * 2;
        float weight = CORNERS == 1 ? 1.0 : shaded.b[k];
        sums.diffuse += weight * texelFetch(uCornerLight, at).rgb;
        sums.gloss += weight * texelFetch(uCornerLight, at + 1).rgb;
    }
#else
    LightSums sums = blinnPhongSums(pixel, shaded.position, shaded.normal, shaded.toEye, shaded.exponent, shaded.faceNormal, shaded.g);
#endif
    return shaded.diffuse * (INV_PI * sums.diffuse) + shaded.mirror * sums.gloss;
#else
    vec3 irradiance = vec3(0.0), gloss = vec3(0.0);
    if (LIGHT_SAMPLES > 0) irradiance = drawnIrradiance(pixel, shaded.position, shaded.normal);
    if (FEW_LIGHTS > 0) {
        int light = int(push.first);
        addLight(light, shaded, irradiance, gloss);
        if (FEW_LIGHTS > 1) addLight(light + 1, shaded, irradiance, gloss);
        if (FEW_LIGHTS > 2) addLight(light + 2, shaded, irradiance, gloss);
        if (FEW_LIGHTS > 3) addLight(light + 3, shaded, irradiance, gloss);
    } else if (HAS_AREA_LIGHTS || HAS_PUNCTUAL_LIGHTS)
        for (uint light = push.first; light < push.first + push.count; ++light)
            addLight(int(light), shaded, irradiance, gloss);
    return shaded.diffuse * (INV_PI * irradiance) + gloss;
#endif
}

/// Radiance that a surface reflects of the surroundings.
vec3 reflectedAmbient(Shaded shaded) {
#ifdef LIGHTMAPS
    if (shaded.baked) return vec3(0.0);
#endif
#ifdef CORNERS
    vec3 light = vec3(0.0);  // the corners' light has it
#elif defined(SPECULAR_ENVIRONMENT) && !defined(BLINN_PHONG)
    vec3 light = surroundingsLight(shaded.bsdf, shaded.albedo, reflectedSurroundings(shaded.bsdf.frame[2]));
#else
    vec3 light = (shaded.diffuse + shaded.mirror) * reflectedSurroundings(shaded.normal);
#endif
#ifdef OCCLUSION
    light *= shaded.open;
#endif
    return light;
}

#endif
