// Exposure, tone curve, sRGB encoding and rounding to 8 bits. The linear image stays as it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/color.glsl"
#include "shaders/shared/tone_curve.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer uLinear { vec4 linear[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uEncoded { uint encoded[]; };
layout(push_constant, std430) uniform Push {
    float scale;  // 2^exposure
    uint width;
    uint height;
} push;

layout(constant_id = 0) const uint TONE_CURVE = TONE_NONE;

/// 0 to 1; NaN is 0.
float clampUnit(float x) { return x > 0.0 ? min(x, 1.0) : 0.0; }

/// The nearest of 256 codes, halves up.
uint quantize(float x) { return uint(floor(x * 255.0 + 0.5)); }

void main() {
    if (gl_GlobalInvocationID.x >= push.width || gl_GlobalInvocationID.y >= push.height) return;
    uint i = gl_GlobalInvocationID.y * push.width + gl_GlobalInvocationID.x;
    vec4 value = linear[i];
    vec3 exposed = max(vec3(0.0), value.rgb * push.scale);
    vec3 bent = toneCurve(TONE_CURVE, mix(exposed, vec3(0.0), isnan(value.rgb)));
    vec3 color = vec3(clampUnit(bent.r), clampUnit(bent.g), clampUnit(bent.b));
    vec3 code = encodeSrgb(color);
    encoded[i] = quantize(code.r) | quantize(code.g) << 8 | quantize(code.b) << 16 | 0xff000000u;
}
