// Multisampling: the keys of all samples of a pixel, each triangle among them shaded once, at the pixel's centre, and
// weighted by its share of the samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/shading.glsl"

layout(constant_id = 123) const int SAMPLES = 4;      ///< at most 32
layout(constant_id = 124) const int SAMPLE_KEYS = 0;  ///< from one sample's keys to the next's
layout(constant_id = 125) const bool FIRST_LIGHTS = true;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, std430) buffer uColor { vec4 color[]; };  ///< RGB, covered share
layout(set = 0, binding = 5, std430) buffer uShadings { uint shadings[]; };  ///< of this pixel: what was shaded

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    int index = pixel.y * size.x + pixel.x;
    vec3 surroundings = visibleSurroundings(pixel);
    vec4 sum = vec4(0.0);
    uint count = 0u, pending = 0xffffffffu >> (32 - SAMPLES);
    while (pending != 0u) {
        int first = findLSB(pending);
        uvec2 key = visibility[index + first * SAMPLE_KEYS];
        uint same = 0u;
        for (int k = 0; k < SAMPLES; ++k) {
            uvec2 other = visibility[index + k * SAMPLE_KEYS];
            // Alike where both are the same triangle, or both none.
            bool alike = other.x == key.x && ((other.x | other.y) == 0u) == ((key.x | key.y) == 0u);
            same |= uint(alike) << k;
        }
        pending &= ~same;
        float share = float(bitCount(same)) / float(SAMPLES);
        Shaded shaded = shadePoint(pixel, key);
        vec3 radiance = reflectedLight(pixel, shaded);
        if (FIRST_LIGHTS) radiance += shaded.emission + reflectedAmbient(shaded);
        vec3 missed = FIRST_LIGHTS ? surroundings : vec3(0.0);
        sum += share * (shaded.hit ? vec4(radiance, 1.0) : vec4(missed, 0.0));
        count += uint(shaded.hit);
    }
    if (FIRST_LIGHTS) {
        color[index] = sum;
        shadings[index] = count;
    } else {
        color[index].rgb += sum.rgb;
    }
}
