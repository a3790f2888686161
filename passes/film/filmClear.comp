#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the film.
#define FILM_BINDING 0
#define FILM_WRITE_ONLY
#include "shaders/film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel * ivec2(2, 3), imageSize(uFilm)))) storeFilm(pixel, emptyFilmPixel());
}
