#ifndef HELIOGRAPH_PATHTRACE_BOUNCES
#define HELIOGRAPH_PATHTRACE_BOUNCES
/** @file
 * The terms E, K E, K^2 E, ... of the light that a pixel receives, each summed apart: a kernel compiled with BOUNCES has
 * a layer for light that scattered 0, 1, ... BOUNCES times, and one for all that scattered more often.
 *
 * Layers lie beside and below each other in uBounces, BOUNCE_COLUMNS in a row, with two texels a pixel: the sum over
 * whole batches, and what has been added since. Two levels keep rounding small, and a render that stops within a
 * batch has in the first what the film has.
 */
layout(set = 0, binding = 46, rgba32f) uniform image2D uBounces;
layout(constant_id = 8) const uint BOUNCE_COLUMNS = 1u;
const uint BOUNCE_LAYERS = BOUNCES + 2u;

/** The first of a pixel's two texels in a layer. */
ivec2 bounceTexel(uvec2 pixel, uvec2 size, uint layer) {
    const uint row = layer / BOUNCE_COLUMNS;
    return ivec2(uvec2((layer - row * BOUNCE_COLUMNS) * size.x + pixel.x, row * size.y + pixel.y) * uvec2(2u, 1u));
}

void clearBounces(uvec2 pixel, uvec2 size) {
    for (uint layer = 0u; layer < BOUNCE_LAYERS; ++layer) {
        const ivec2 texel = bounceTexel(pixel, size, layer);
        imageStore(uBounces, texel, vec4(0.0));
        imageStore(uBounces, texel + ivec2(1, 0), vec4(0.0));
    }
}

/** Adds light that scattered `depth` times. What the film would not take is left out here too, though not the other
 * light of its sample. */
void addBounce(uvec2 pixel, uvec2 size, uint depth, vec3 radiance) {
    if (radiance != vec3(0.0) && all(lessThanEqual(abs(radiance), vec3(FILM_LARGEST)))) {  // false for NaN
        const ivec2 texel = bounceTexel(pixel, size, min(depth, BOUNCE_LAYERS - 1u)) + ivec2(1, 0);
        imageStore(uBounces, texel, vec4(imageLoad(uBounces, texel).xyz + radiance, 0.0));
    }
}

/** Ends a batch. */
void mergeBounces(uvec2 pixel, uvec2 size) {
    for (uint layer = 0u; layer < BOUNCE_LAYERS; ++layer) {
        const ivec2 texel = bounceTexel(pixel, size, layer);
        const vec3 sum = imageLoad(uBounces, texel).xyz + imageLoad(uBounces, texel + ivec2(1, 0)).xyz;
        imageStore(uBounces, texel, vec4(sum, 0.0));
        imageStore(uBounces, texel + ivec2(1, 0), vec4(0.0));
    }
}
#endif
