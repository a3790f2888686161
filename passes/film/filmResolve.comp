#version 460
#extension GL_GOOGLE_include_directive : require
// The film's state to what is shown and judged: mean, variance of the mean, half difference.
#define FILM_BINDING 0
#define FILM_READ_ONLY
#include "shaders/film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1, rgba32f) writeonly uniform image2D uMean;        // R G B, samples
layout(binding = 2, rgba32f) writeonly uniform image2D uVariance;    // R G B, rejected samples
layout(binding = 3, rgba32f) writeonly uniform image2D uDifference;  // R G B, 1 where both halves have samples

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(uMean)))) return;
    FilmPixel p = loadFilm(pixel);
    imageStore(uMean, pixel, vec4(filmMean(p), filmCount(p)));
    imageStore(uVariance, pixel, vec4(filmVarianceOfMean(p), p.rejected));
    float both = p.countA > 0.0 && p.countB > 0.0 ? 1.0 : 0.0;
    imageStore(uDifference, pixel, vec4(filmHalfDifference(p), both));
}
