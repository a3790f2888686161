// The film on the device: an RGBA32F storage image of twice the picture's width and three times its height,
// which holds each pixel's FilmPixel in a block of 2 x 3 texels. An image, since its size is not bound by the
// storage-buffer range. GLSL only.
//
// A kernel defines FILM_BINDING before the include, binds the image as `uFilm`, and per pixel does
//   FilmPixel stored = loadFilm(pixel);
//   FilmBatch batch = startFilmBatch(stored);
//   for each sample: addFilmSample(batch, sampleIndex, radiance);
//   storeFilm(pixel, mergeFilmBatch(stored, batch));
// A kernel that only reads or only writes it defines FILM_READ_ONLY or FILM_WRITE_ONLY.
#ifndef SHADERS_FILM_FILM_GLSL
#define SHADERS_FILM_FILM_GLSL
#include "shaders/film/accumulate.glsl"

#if defined(FILM_READ_ONLY)
layout(binding = FILM_BINDING, rgba32f) readonly uniform image2D uFilm;
#elif defined(FILM_WRITE_ONLY)
layout(binding = FILM_BINDING, rgba32f) writeonly uniform image2D uFilm;
#else
layout(binding = FILM_BINDING, rgba32f) uniform image2D uFilm;
#endif

#ifndef FILM_WRITE_ONLY
FilmPixel loadFilm(ivec2 pixel) {
    ivec2 corner = pixel * ivec2(2, 3);
    vec4 a = imageLoad(uFilm, corner);
    vec4 aLow = imageLoad(uFilm, corner + ivec2(1, 0));
    vec4 b = imageLoad(uFilm, corner + ivec2(0, 1));
    vec4 bLow = imageLoad(uFilm, corner + ivec2(1, 1));
    vec4 d = imageLoad(uFilm, corner + ivec2(0, 2));
    vec4 dLow = imageLoad(uFilm, corner + ivec2(1, 2));
    return FilmPixel(a.xyz, aLow.xyz, b.xyz, bLow.xyz, d.xyz, dLow.xyz, a.w, b.w, d.w);
}
#endif

#ifndef FILM_READ_ONLY
void storeFilm(ivec2 pixel, FilmPixel p) {
    ivec2 corner = pixel * ivec2(2, 3);
    imageStore(uFilm, corner, vec4(p.sumA, p.countA));
    imageStore(uFilm, corner + ivec2(1, 0), vec4(p.sumALow, 0.0));
    imageStore(uFilm, corner + ivec2(0, 1), vec4(p.sumB, p.countB));
    imageStore(uFilm, corner + ivec2(1, 1), vec4(p.sumBLow, 0.0));
    imageStore(uFilm, corner + ivec2(0, 2), vec4(p.deviation, p.rejected));
    imageStore(uFilm, corner + ivec2(1, 2), vec4(p.deviationLow, 0.0));
}
#endif

#endif
