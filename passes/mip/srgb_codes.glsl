// Linear light of 8-bit sRGB codes.
#ifndef PASSES_MIP_SRGB_CODES_GLSL
#define PASSES_MIP_SRGB_CODES_GLSL

/// t = (code + 14.025) / 269.025 to the power 2.4, as t P(sqrt(t)) with P fitted to the 256 codes, rounding counted:
/// relative error below 2.2e-7, its mean over the codes below 1e-11, none at 0 and 255. IEC 61966-2-1.
vec4 linearLight(uvec4 codes) {
    precise vec4 code = vec4(codes);
    precise vec4 t = code + 14.025, s = sqrt(t);
    precise vec4 p = -8.327232573466809e-15 * s + 8.246530086401804e-13;
    p = p * s - 3.710405593881916e-11;
    p = p * s + 1.0349741064175078e-09;
    p = p * s - 2.2252342191109165e-08;
    p = p * s + 9.801932492337073e-07;
    p = p * s + 1.0996689067045273e-06;
    p = p * s - 1.225845835506334e-06;
    p = p * s + 8.460539220322971e-07;
    // Codes up to 10 lie on the curve's line.
    return mix(p * t, code * (1.0 / 3294.6), lessThan(code, vec4(10.5)));
}

#endif
