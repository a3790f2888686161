#version 460
#extension GL_GOOGLE_include_directive : require
// One level of the a-trous filter, see denoise.hpp. Every value is added as its difference from the pixel's own, so that
// what is constant stays so to the last bit.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D uIn;  // R G B, variance
layout(binding = 1, rgba32f) writeonly uniform image2D uOut;
layout(binding = 2) uniform samplerBuffer uGeometry;  // unit normal, depth; 0 for a miss
layout(binding = 3) uniform samplerBuffer uAlbedo;    // R G B, 1 for a hit

layout(push_constant) uniform Parameters {
    ivec2 size;
    int spacing;  // of the taps, pixels
} parameters;

// B3 spline.
const float KERNEL[3] = float[3](0.375, 0.25, 0.0625);
// Squared distances of colours count in units of this many variances.
const float COLOUR_VARIANCES = 2.0;
const float ALBEDO_DIFFERENCE = 0.1;  // at which the weight is exp(-1)

int indexOf(ivec2 p) {
    return p.y * parameters.size.x + p.x;
}

ivec2 inside(ivec2 p) {
    return clamp(p, ivec2(0), parameters.size - 1);
}

float depthAt(ivec2 p) {
    return texelFetch(uGeometry, indexOf(inside(p))).w;
}

// Change of depth over a pixel along one axis: the smaller one-sided difference, which does not cross an edge.
float slope(ivec2 p, ivec2 axis, float depth) {
    float before = depth - depthAt(p - axis), after = depthAt(p + axis) - depth;
    return min(abs(before), abs(after));
}

// Variance smoothed over 3 x 3 pixels: its own noise would open and close the filter at random.
float smoothVariance(ivec2 p) {
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float v = imageLoad(uIn, inside(p + ivec2(x, y))).w;
            sum += v * (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
        }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, parameters.size))) return;
    vec4 centre = imageLoad(uIn, pixel);
    vec4 geometry = texelFetch(uGeometry, indexOf(pixel)), albedo = texelFetch(uAlbedo, indexOf(pixel));
    // A bright sample of its own stands out of the smoothed variance.
    float variance = max(smoothVariance(pixel), centre.w);
    float depthX = slope(pixel, ivec2(1, 0), geometry.w), depthY = slope(pixel, ivec2(0, 1), geometry.w);
    float weights = KERNEL[0] * KERNEL[0];
    vec3 sum = vec3(0.0);
    float varianceSum = weights * weights * centre.w;
    for (int i = 0; i < 25; ++i) {
        ivec2 offset = ivec2(i % 5 - 2, i / 5 - 2);
        ivec2 q = pixel + offset * parameters.spacing;
        bool there = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, parameters.size)) && i != 12;
        q = inside(q);
        vec4 other = imageLoad(uIn, q);
        vec4 otherGeometry = texelFetch(uGeometry, indexOf(q)), otherAlbedo = texelFetch(uAlbedo, indexOf(q));
        vec3 apart = other.xyz - centre.xyz;
        float noise = variance + other.w;
        // What the two noises alone would bring is no difference.
        float colour = max(0.0, dot(apart, apart) / 3.0 - noise) / (COLOUR_VARIANCES * variance + 1e-12);
        vec3 tint = (otherAlbedo.xyz - albedo.xyz) / ALBEDO_DIFFERENCE;
        vec2 reach = abs(vec2(offset)) * float(parameters.spacing);
        float expected = depthX * reach.x + depthY * reach.y + 0.01 * abs(geometry.w) + 1e-20;
        float distance = abs(otherGeometry.w - geometry.w) / expected;
        float facing = albedo.w > 0.5 ? max(0.0, dot(geometry.xyz, otherGeometry.xyz)) : 1.0;
        float facing4 = facing * facing * facing * facing, facing16 = facing4 * facing4 * facing4 * facing4;
        float weight = KERNEL[abs(offset.x)] * KERNEL[abs(offset.y)] * facing16 * facing16 *
                       exp(-(colour + dot(tint, tint) + distance));
        bool usable = there && albedo.w == otherAlbedo.w && weight > 0.0 && weight <= 1.0 &&
                      all(lessThan(abs(other), vec4(1e30)));
        weight = usable ? weight : 0.0;
        weights += weight;
        sum += usable ? weight * apart : vec3(0.0);
        varianceSum += usable ? weight * weight * other.w : 0.0;
    }
    imageStore(uOut, pixel, vec4(centre.xyz + sum / weights, varianceSum / (weights * weights)));
}
