#version 460
#extension GL_GOOGLE_include_directive : require
// The filtered halves' mean, and what it brings: see denoise.hpp.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D uA;
layout(binding = 1, rgba32f) readonly uniform image2D uB;
layout(binding = 2) uniform samplerBuffer uMean;        // R G B, samples
layout(binding = 3) uniform samplerBuffer uDifference;  // R G B, 1 where both halves have samples
layout(binding = 6) uniform samplerBuffer uWeights;     // of squares in relMSE
layout(binding = 4, rgba32f) writeonly uniform image2D uMerged;
layout(binding = 5, rgba32f) writeonly uniform image2D uScores;  // d^2 - D d, (F - M)^2, each over brightness
layout(binding = 7, rgba32f) writeonly uniform image2D uTerms;   // the same, d^2 and D^2, as parts of relMSE

layout(push_constant) uniform Parameters {
    ivec2 size;
} parameters;

const float REGULARIZER = 0.01;  // of relMSE

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, parameters.size))) return;
    int index = pixel.y * parameters.size.x + pixel.x;
    vec3 a = imageLoad(uA, pixel).xyz, b = imageLoad(uB, pixel).xyz, mean = texelFetch(uMean, index).xyz;
    vec4 difference = texelFetch(uDifference, index);
    vec3 d = difference.xyz, merged = 0.5 * (a + b);
    vec3 filteredDifference = 0.5 * (a - b), change = merged - mean;
    vec3 weight = texelFetch(uWeights, index).xyz / 3.0;
    // By what the pixel shows, its noise included: a sample that stands out is then worth no more than the
    // pixel itself. Weights that draw it towards its neighbours would have it filtered at any price.
    vec3 bounded = 1.0 / (3.0 * (max(mean * mean, merged * merged) + REGULARIZER));
    vec3 gain = d * (d - filteredDifference), square = change * change;
    vec4 scores = vec4(dot(bounded, gain), dot(bounded, square), 0.0, 0.0);
    vec4 terms = vec4(dot(weight, gain), dot(weight, square), dot(weight, d * d),
                      dot(weight, filteredDifference * filteredDifference));
    bool usable = difference.w > 0.0 && all(lessThan(abs(scores) + abs(terms), vec4(1e30))) &&
                  all(lessThan(abs(merged), vec3(1e30)));
    imageStore(uMerged, pixel, vec4(usable ? merged : mean, 0.0));
    imageStore(uScores, pixel, usable ? scores : vec4(0.0));
    imageStore(uTerms, pixel, usable ? terms : vec4(0.0));
}
