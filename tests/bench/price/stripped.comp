#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
/** @file
 * passes/pathtrace/trace.comp stripped by hand to what the Cornell box needs: Lambertian quadrilaterals of constant
 * colours, one parallelogram that emits from its front, a pinhole, the box filter, Sobol numbers. Same traversal,
 * buffers and arithmetic: its picture is the general kernel's to the bit. What the engine's generality costs is
 * measured against it.
 */
#define FILM_BINDING 1
#include "shaders/dispatch.glsl"
#include "shaders/film/film.glsl"
#include "shaders/scene/lights.glsl"
#include "shaders/intersection/offset.glsl"
#include "shaders/intersection/scene_hit.glsl"
#include "shaders/sampling/sampler.glsl"
#include "shaders/sampling/warp.glsl"

layout(local_size_x = 64) in;

struct CameraFrame {
    vec4 origin, right, up, forward;
};
layout(push_constant) uniform Parameters {
    CameraFrame camera;
    vec4 environment;
    uvec2 size;
    uint sampleEnd, seed, maxDepth, countCut, budget, begin;
} parameters;
layout(set = 0, binding = 0, rgba32f) uniform image2D uState;
layout(set = 0, binding = 2, std430) buffer Counters {
    uint open, unused;
    uint camera[2], bounce[2], shadow[2], cut[2], abandoned[2];
} uCounters;
#define COUNT(member, value)                                                     \
    {                                                                            \
        const uint total = subgroupAdd(value);                                   \
        if (subgroupElect() && total > 0u) {                                     \
            const uint before = atomicAdd(uCounters.member[0], total);           \
            if (before + total < before) atomicAdd(uCounters.member[1], 1u);     \
        }                                                                        \
    }

// The general kernel's, so that it can be put in its place; none is used.
layout(constant_id = 0) const uint SAMPLER_KIND = 0u;
layout(constant_id = 1) const bool NEXT_EVENT = true;
layout(constant_id = 2) const bool ORTHOGRAPHIC = false;
layout(constant_id = 3) const bool COUNT_TURNS = true;
layout(constant_id = 4) const uint FILTER_KIND = 0u;
layout(constant_id = 6) const bool WHITTED = false;
layout(constant_id = 7) const bool HEMISPHERE = false;

const float ROULETTE = 3.0;

struct Path {
    vec3 origin, direction, throughput, radiance;
    float density;
    uint depth, sampleIndex;
    int source;
};

Path startPath(PixelSampler numbers, uvec2 pixel, uint sampleIndex) {
    const vec2 u = sample2D(SAMPLER_SOBOL, numbers, DIMENSION_FILTER);
    const vec2 at = vec2(pixel) + 0.5 + 0.5 * ((2.0 * u - 1.0) + 5.9604644775390625e-08);
    const float x = at.x / float(parameters.size.x) * 2.0 - 1.0, y = 1.0 - at.y / float(parameters.size.y) * 2.0;
    const vec3 across = parameters.camera.right.xyz * x + parameters.camera.up.xyz * y;
    return Path(parameters.camera.origin.xyz, normalize(parameters.camera.forward.xyz + across), vec3(1.0), vec3(0.0), -1.0,
                0u, sampleIndex, -1);
}

bool scatter(inout Path path, PixelSampler numbers, float distance, int slot, out vec3 shadowOrigin,
             out vec3 shadowDirection, out float limit, out ivec2 target, out vec3 brought, out bool cut) {
    const bool hit = slot >= 0;
    const Triangle t = fetchTriangle(max(slot, 0));
    const vec3 b = barycentrics(shearOf(path.origin, path.direction), t.v0, t.v1, t.v2);
    const vec3 position = b.x * t.v0 + b.y * t.v1 + b.z * t.v2;
    const vec3 across = cross(t.v1 - t.v0, t.v2 - t.v0);
    const float largest = max(max(abs(across.x), abs(across.y)), abs(across.z));
    const vec3 scaled = across / (largest > 0.0 ? largest : 1.0);
    const vec3 normal = scaled / max(length(scaled), 0.5);
    const bool front = dot(normal, path.direction) < 0.0;
    const vec3 face = front ? normal : -normal;
    const float offset = offsetDistance(t.v0, t.v1, t.v2, normal);

    const uvec4 row = texelFetch(uMaterials, t.material * MATERIAL_TEXELS + 1);
    const float areaDensity = uintBitsToFloat(texelFetch(uMaterials, t.material * MATERIAL_TEXELS + 2).x);
    const float cosine = abs(dot(face, path.direction));
    const float sampled = cosine > 0.0 ? areaDensity * distance * distance / cosine : 0.0;
    const float weight = path.density < 0.0 ? 1.0 : path.density / (path.density + sampled);
    const bool emits = hit && (front || (row.w & MATERIAL_DOUBLE_SIDED) != 0u);
    path.radiance += emits ? path.throughput * uintBitsToFloat(row.xyz) * weight : vec3(0.0);

    const vec3 albedo = uintBitsToFloat(texelFetch(uMaterials, t.material * MATERIAL_TEXELS)).rgb;
    const bool goesOn = hit && max(max(albedo.x, albedo.y), albedo.z) > 0.0;
    cut = goesOn && path.depth >= parameters.maxDepth;
    bool alive = goesOn && !cut;
    const uint dimension = DIMENSION_PATH + path.depth * 3u;
    const uvec2 choice = sampleBits2D(SAMPLER_SOBOL, numbers, dimension + 2u);
    float nextCosine;
    const vec3 next = cosineDirection(face, sample2D(SAMPLER_SOBOL, numbers, dimension + 1u), nextCosine);

    const uvec2 random = sampleBits2D(SAMPLER_SOBOL, numbers, dimension);
    const vec2 u = vec2(unitFloat(random.x), unitFloat(random.y));
    const vec4 strength = uintBitsToFloat(LIGHT_ROW(0, 3)), facing = uintBitsToFloat(LIGHT_ROW(0, 4));
    const vec3 q = uintBitsToFloat(LIGHT_ROW(0, 0).xyz) + uintBitsToFloat(LIGHT_ROW(0, 1).xyz) * u.x +
                   uintBitsToFloat(LIGHT_ROW(0, 2).xyz) * u.y;
    const vec3 toLight = q - position;
    const float squared = dot(toLight, toLight), length_ = sqrt(squared);
    const vec3 direction = toLight / length_;
    const float lightCosine = -dot(facing.xyz, direction);
    const bool bothFaces = strength.w < 0.0;
    const float towards = bothFaces ? abs(lightCosine) : lightCosine;
    const bool visible = towards > 0.0 && squared > 0.0;
    const float density = visible ? abs(strength.w) * squared / towards : 0.0;
    const vec3 radiance = visible ? strength.rgb / density : vec3(0.0);
    const float scattered = dot(face, direction) > 0.0 ? dot(face, direction) * INV_PI : 0.0;
    const float lightWeight = density > 0.0 ? density / (density + scattered) : 1.0;
    shadowOrigin = position + face * offset;
    brought = path.throughput * albedo * radiance * (scattered * lightWeight);
    const int identity = int(LIGHT_ROW(0, 5).x);
    target = ivec2(identity, identity + 1);
    shadowDirection = q + facing.xyz * (lightCosine < 0.0 ? -facing.w : facing.w) - shadowOrigin;
    limit = alive && scattered > 0.0 && max(max(radiance.x, radiance.y), radiance.z) > 0.0 ? 1.0 : 0.0;

    path.direction = next;
    path.density = nextCosine * INV_PI;
    path.throughput *= albedo;
    path.origin = position + face * offset;
    path.source = slot;
    path.depth += 1u;
    const float keep = path.depth < 2u ? 1.0 : min(1.0, ROULETTE * max(max(path.throughput.x, path.throughput.y), path.throughput.z));
    alive = alive && dot(face, next) > 0.0 && unitFloat(choice.y) < keep;
    path.throughput /= keep;
    return alive;
}

void main() {
    const uint group = interleavedGroup(), lane = gl_LocalInvocationIndex, columns = (parameters.size.x + 7u) >> 3;
    const uvec2 pixel = uvec2(group % columns, group / columns) * 8u +
                        uvec2((lane & 3u) + ((lane >> 3) & 1u) * 4u, ((lane >> 2) & 1u) + (lane >> 4) * 2u);
    const bool inside = all(lessThan(pixel, parameters.size));
    const uint pixelIndex = pixel.y * parameters.size.x + pixel.x;
    const ivec2 place = ivec2(pixel) * ivec2(4, 2), filmPixel = ivec2(pixel);
    const bool begin = parameters.begin != 0u;
    const vec4 s0 = begin ? vec4(0.0) : imageLoad(uState, place), s1 = imageLoad(uState, place + ivec2(1, 0));
    const vec4 s2 = imageLoad(uState, place + ivec2(2, 0)), s3 = imageLoad(uState, place + ivec2(3, 0));
    const vec4 s4 = imageLoad(uState, place + ivec2(0, 1)), s5 = imageLoad(uState, place + ivec2(1, 1));
    const vec4 s6 = imageLoad(uState, place + ivec2(2, 1)), s7 = begin ? vec4(0.0) : imageLoad(uState, place + ivec2(3, 1));
    FilmPixel stored = loadFilm(filmPixel);
    FilmBatch batch = startFilmBatch(stored);
    uint sampleIndex = uint(s0.w);
    PixelSampler numbers = startSample(SAMPLER_SOBOL, pixelIndex, sampleIndex, parameters.seed, 0u);
    const bool resumed = s7.w > 0.0;
    Path path = startPath(numbers, pixel, sampleIndex);
    if (resumed) path = Path(s0.xyz, s1.xyz, s2.xyz, s3.xyz, s1.w, uint(s2.w), sampleIndex, int(s3.w));
    if (s7.w > 1.5) {
        const float countB = floor(s4.w * (1.0 / 4096.0));
        batch = FilmBatch(s7.xyz, s4.xyz, s5.xyz, s6.xyz, s4.w - 4096.0 * countB, countB, s6.w, true);
    }
    uint cameraRays = 0u, bounceRays = 0u, shadowRays = 0u, cutPaths = 0u;
    cameraRays += inside && !resumed && sampleIndex < parameters.sampleEnd ? 1u : 0u;
    uint spent = 0u;
    while (inside && path.sampleIndex < parameters.sampleEnd && spent < parameters.budget) {
        float distance;
        int slot;
        closestHit(path.origin, path.direction, path.source, distance, slot);
        vec3 shadowOrigin, shadowDirection, brought;
        float limit;
        ivec2 target;
        bool cut, blocked;
        const bool alive = scatter(path, numbers, distance, slot, shadowOrigin, shadowDirection, limit, target, brought, cut);
        occluded(shadowOrigin, shadowDirection, path.source, target, limit, blocked);
        path.radiance += limit > 0.0 && !blocked ? brought : vec3(0.0);
        shadowRays += limit > 0.0 ? 1u : 0u;
        bounceRays += alive ? 1u : 0u;
        cutPaths += cut ? parameters.countCut : 0u;
        if (!alive) {
            addFilmSample(batch, path.sampleIndex, path.radiance);
            const uint next = path.sampleIndex + 1u;
            numbers = startSample(SAMPLER_SOBOL, pixelIndex, next, parameters.seed, 0u);
            path = startPath(numbers, pixel, next);
            cameraRays += next < parameters.sampleEnd ? 1u : 0u;
        }
        spent += 1u;
    }
    const bool finished = path.sampleIndex >= parameters.sampleEnd;
    if (inside) {
        if (finished) {
            storeFilm(filmPixel, mergeFilmBatch(stored, batch));
            imageStore(uState, place, vec4(0.0, 0.0, 0.0, float(path.sampleIndex)));
            imageStore(uState, place + ivec2(3, 1), vec4(0.0));
        } else {
            imageStore(uState, place, vec4(path.origin, float(path.sampleIndex)));
            imageStore(uState, place + ivec2(1, 0), vec4(path.direction, path.density));
            imageStore(uState, place + ivec2(2, 0), vec4(path.throughput, float(path.depth)));
            imageStore(uState, place + ivec2(3, 0), vec4(path.radiance, float(path.source)));
            imageStore(uState, place + ivec2(0, 1), vec4(batch.sumA, batch.countA + 4096.0 * batch.countB));
            imageStore(uState, place + ivec2(1, 1), vec4(batch.sumB, 0.0));
            imageStore(uState, place + ivec2(2, 1), vec4(batch.squares, batch.rejected));
            imageStore(uState, place + ivec2(3, 1), vec4(batch.shift, batch.shifted ? 2.0 : 1.0));
        }
    }
    const uint unfinished = subgroupAdd(inside && !finished ? 1u : 0u);
    if (subgroupElect() && unfinished > 0u) atomicAdd(uCounters.open, unfinished);
    COUNT(camera, cameraRays)
    COUNT(bounce, bounceRays)
    COUNT(shadow, shadowRays)
    COUNT(cut, cutPaths)
    COUNT(abandoned, 0u)
}
