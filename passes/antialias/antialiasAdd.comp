// Supersampling: adds an image, weighted, to the sum so far.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform samplerBuffer uColor;
layout(set = 0, binding = 1, std430) buffer uSum { vec4 sum[]; };
layout(push_constant, std430) uniform Push {
    uint first;   // pixel
    uint pixels;
    float weight;
    uint begins;  // 1 where there is no sum yet
} push;

void main() {
    uint pixel = push.first + gl_GlobalInvocationID.x;
    if (pixel >= push.pixels) return;
    vec4 color = push.weight * texelFetch(uColor, int(pixel));
    sum[pixel] = push.begins != 0u ? color : sum[pixel] + color;
}
