#ifndef HELIOGRAPH_PATHTRACE_METER
#define HELIOGRAPH_PATHTRACE_METER
/** @file
 * Paths that a meter starts, in place of a camera's (METER). A meter of irradiance or flux is a first scattering: cosine
 * directions over its hemisphere, and light sampling, weighted against each other; what it gathers is E / pi. One of
 * radiance or intensity sees along its axis alone. The image's pixels are strata of what is drawn, or meters of irradiance of
 * their own (METER_POINTS).
 */

#ifdef METER_POINTS
layout(set = 0, binding = 54) uniform samplerBuffer uMeterPoints;  ///< two texels a pixel: its meter's place and direction
#endif

/** Loop turns of shadow rays of meters that are not counted in the budget yet. */
uint meterTurns = 0u;

/** `parameters.camera`: the middle of the meter; right and up are half its sides, w of forward is 1 for a hemisphere. */
Path startPath(PixelSampler numbers, uvec2 pixel, uint sampleIndex) {
    CameraFrame meter = parameters.camera;
#ifdef METER_POINTS
    const int at = 2 * int(pixel.y * parameters.size.x + pixel.x);
    meter.origin = texelFetch(uMeterPoints, at);
    meter.forward = vec4(texelFetch(uMeterPoints, at + 1).xyz, 1.0);
#endif
    const vec3 normal = meter.forward.xyz;
    const bool hemisphere = meter.forward.w > 0.5;
    vec2 u = sample2D(SAMPLER_KIND, numbers, DIMENSION_FILTER);
#ifndef METER_POINTS
    u = (vec2(pixel) + u) / vec2(parameters.size);
#endif
    const vec2 across = 2.0 * (hemisphere ? sample2D(SAMPLER_KIND, numbers, DIMENSION_LENS) : u) - 1.0;
    Path path;
    path.origin = meter.origin.xyz + meter.right.xyz * across.x + meter.up.xyz * across.y;
    float cosine;
    const vec3 drawn = cosineDirection(normal, u, cosine);
    path.direction = hemisphere ? drawn : normal;
    path.throughput = vec3(1.0);
    path.radiance = vec3(0.0);
    path.density = hemisphere ? cosine * INV_PI : -1.0;
    path.depth = hemisphere ? 1u : 0u;
    path.sampleIndex = sampleIndex;
    path.source = -1;
    path.lightPlace = 0;
    if (LIGHT_COUNT > 0) {
#ifdef MOTION_KEYS
        setMotionTime(pathTime(numbers, pixel));
#endif
        path.lightPlace = lightPlace(path.origin, normal);
        const uvec2 choice = sampleBits2D(SAMPLER_KIND, numbers, DIMENSION_PATH + 2u);
        const LightSample light =
            sampleLight(path.origin, path.lightPlace, choice.x, sampleBits2D(SAMPLER_KIND, numbers, DIMENSION_PATH));
        const float received = dot(normal, light.direction) * INV_PI;
        const float weight = light.density > 0.0 ? light.density / (light.density + received) : 1.0;
        const vec3 towards = light.infinite ? light.direction : light.target - path.origin;
        const bool asks = hemisphere && received > 0.0 && largestOf(light.radiance) > 0.0;
        bool blocked;
        float passes;
        meterTurns += uint(shadowed(path.origin, towards, -1, light.triangles,
                                    asks ? (light.infinite ? INFINITE_DISTANCE : 1.0) : 0.0, blocked, passes));
        path.radiance = asks && !blocked ? light.radiance * (received * weight * passes) : vec3(0.0);
    }
    return path;
}
#endif
