#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
/** @file
 * Photons that could make caustics: each sets out from a lamp to a point of a mirror or of glass, goes on as these let it,
 * and is noted where it comes to a rough surface. An invocation has one photon, and leaves what it found of it in its own
 * texels of uState, so that nothing depends on the order in which photons are traced:
 *   (0, 0) place, flux: mean over RGB of W / sr m^2 that a photon of all stands for; 0: it came nowhere
 *   (1, 0) unit vector to where it came from, how far it came last
 *   (2, 0) unit normal that the surface turns to it, radiance of its lamp
 *   (3, 0) an estimate of the irradiance that lamps in sight would bring to that place, 0, 0, 0.
 * Flux may be off where light's and importance's transport differ (inside of glass, at shading normals): tables that guide
 * paths need not be exact.
 */
#include "passes/pathtrace/pixel_paths.glsl"
#include "shaders/shared/vector.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 44) uniform usamplerBuffer uPhotonTargets;  ///< R32UI: slots, each for an equal area
layout(constant_id = 180) const int PHOTON_TARGETS = 1;
layout(constant_id = 181) const float PHOTON_AREA = 0.0;    ///< of all targets
layout(constant_id = 182) const float PHOTON_EXTENT = 0.0;  ///< longer than any way in the scene

/** Turns of light at mirrors and glass that are followed. */
const uint PHOTON_DEPTH = 12u;
/** Chance per solid angle above which a lobe counts as a mirror's. */
const float PHOTON_NARROW = 4.0;

/** A point of what is in a slot. */
vec3 pointOf(int slot, vec2 u, out vec3 normal) {
    const Triangle t = fetchTriangle(slot);
    const vec2 s = u.x + u.y > 1.0 ? 1.0 - u : u;
    normal = normalizeSafe(cross(t.v1 - t.v0, t.v2 - t.v0), vec3(0.0, 0.0, 1.0));
    vec3 p = t.v0 + (t.v1 - t.v0) * s.x + (t.v2 - t.v0) * s.y;
#ifdef SHAPES
    if (t.shape > 0 && isFlat(t)) {
        const vec2 at = t.shape == SHAPE_DISC ? sqrt(u.x) * unitCircle(u.y) : 2.0 * u - 1.0;
        normal = flatNormal(t);
        p = t.v0 + t.v1 * at.x + t.v2 * at.y;
    }
    if (t.shape == SHAPE_SPHERE) {
        normal = uniformSphere(u);
        p = t.v0 + length(t.v1) * normal;
    }
#endif
    return p;
}

void main() {
    const uvec2 pixel = tilePixel(parameters.size);
    if (any(greaterThanEqual(pixel, parameters.size)) || parameters.sampleEnd == 0u) return;
    const uint index = pixel.y * parameters.size.x + pixel.x, count = parameters.size.x * parameters.size.y;
    const PixelSampler numbers = startSample(SAMPLER_SOBOL, 0u, index, parameters.seed, 0u);
#ifdef MOTION_KEYS
    setMotionTime(pathTime(numbers, pixel));
#endif
    const vec2 pick = sample2D(SAMPLER_SOBOL, numbers, DIMENSION_FILTER);
    const int target = int(texelFetch(uPhotonTargets, min(int(pick.x * float(PHOTON_TARGETS)), PHOTON_TARGETS - 1)).x);
    vec3 normal;
    const vec3 aim = pointOf(target, sample2D(SAMPLER_SOBOL, numbers, DIMENSION_LENS), normal);
    const LightSample light = sampleLight(aim, lightPlace(aim, vec3(0.0)), sampleBits2D(SAMPLER_SOBOL, numbers, DIMENSION_PATH).x,
                                          sampleBits2D(SAMPLER_SOBOL, numbers, DIMENSION_PATH + 1u));
    Path path;
    path.origin = light.infinite ? aim + light.direction * PHOTON_EXTENT : light.target;
    path.direction = normalizeSafe(aim - path.origin, -light.direction);
    path.throughput = light.radiance * (abs(dot(normal, light.direction)) * PHOTON_AREA / float(count));
    path.source = -1;
    const float radiance = dot(light.radiance, vec3(1.0 / 3.0)) * light.density;

    vec4 place = vec4(0.0), from = vec4(0.0), side = vec4(0.0);
    bool alive = light.density > 0.0 && largestOf(path.throughput) > 0.0;
    uint spent = 0u;
    for (uint depth = 0u; depth < PHOTON_DEPTH && alive && spent < parameters.budget; ++depth) {
        const uint dimension = DIMENSION_PATH + 2u + depth * 2u;
        path.depth = depth;
        float distance;
        int slot;
        spent += 1u + LOOP_TURNS + uint(closestSurface(path.origin, path.direction, path.source, opacityKey(numbers, pixel, path), false, distance, slot));
        // What is hidden from the lamp gets no light from it.
        alive = slot >= 0 && (depth > 0u || slot == target);
        const SurfacePoint s = surfaceAt(path.origin, path.direction, path.source, max(slot, 0));
        path.throughput *= throughMedium(s, path.direction, path.source, distance);
        const vec2 lobe = sample2D(SAMPLER_SOBOL, numbers, dimension);
        const SurfaceBsdf bsdf = surfaceBsdf(s, path.direction, lobe.y, path.throughput);
        SurfaceSample next = sampleSurface(bsdf, s, sample2D(SAMPLER_SOBOL, numbers, dimension + 1u), lobe.x);
        SurfaceValue unasked[1];
        surfaceValues(bsdf, s, vec3[1](s.face), false, 0.0, next, unasked);
        const bool narrow = next.density < 0.0 || next.density > PHOTON_NARROW;
        if (alive && depth > 0u && next.goes && !narrow && takesGuide(bsdf)) {
            place = vec4(s.position, dot(path.throughput, vec3(1.0 / 3.0)));
            from = vec4(-path.direction, distance);
            side = vec4(s.face, radiance);
        }
        alive = alive && next.goes && narrow;
        path.throughput *= next.weight;
        path.origin = leaving(s, next.direction);
        path.direction = next.direction;
        path.source = slot;
    }
    float direct = 0.0;
    if (place.w > 0.0) {
        const uint dimension = DIMENSION_PATH + 2u + PHOTON_DEPTH * 2u;
        const LightSample seen = sampleLight(place.xyz, lightPlace(place.xyz, side.xyz), sampleBits2D(SAMPLER_SOBOL, numbers, dimension).x,
                                             sampleBits2D(SAMPLER_SOBOL, numbers, dimension + 1u));
        direct = dot(seen.radiance, vec3(1.0 / 3.0)) * max(dot(side.xyz, seen.direction), 0.0);
    }
    imageStore(uState, stateTexel(pixel) + ivec2(3, 0), vec4(direct, 0.0, 0.0, 0.0));
    imageStore(uState, stateTexel(pixel), place);
    imageStore(uState, stateTexel(pixel) + ivec2(1, 0), from);
    imageStore(uState, stateTexel(pixel) + ivec2(2, 0), side);
}
