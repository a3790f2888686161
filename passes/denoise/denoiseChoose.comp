#version 460
#extension GL_GOOGLE_include_directive : require
// How far each pixel goes from the mean to the filtered value: see denoise.hpp.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D uMerged;
layout(binding = 1, rgba32f) readonly uniform image2D uScores;
layout(binding = 2) uniform samplerBuffer uMean;
layout(binding = 3, rgba32f) writeonly uniform image2D uPicture;  // R G B, s

layout(push_constant) uniform Parameters {
    ivec2 size;
} parameters;

const int RADIUS = 4;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, parameters.size))) return;
    vec2 sum = vec2(0.0);
    for (int y = -RADIUS; y <= RADIUS; ++y)
        for (int x = -RADIUS; x <= RADIUS; ++x) {
            ivec2 q = pixel + ivec2(x, y);
            // Without the pixel's own score: chosen by its own noise, s would pass for better than it is.
            bool there = (x != 0 || y != 0) && all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, parameters.size));
            vec2 score = imageLoad(uScores, clamp(q, ivec2(0), parameters.size - 1)).xy;
            sum += there ? score : vec2(0.0);
        }
    float s = sum.y > 0.0 ? clamp(sum.x / sum.y, 0.0, 1.0) : 0.0;
    vec3 mean = texelFetch(uMean, pixel.y * parameters.size.x + pixel.x).xyz;
    imageStore(uPicture, pixel, vec4(mean + s * (imageLoad(uMerged, pixel).xyz - mean), s));
}
