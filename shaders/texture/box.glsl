// The 2:1 box in one dimension that keeps the mean whatever the size.
#ifndef SHADERS_TEXTURE_BOX_GLSL
#define SHADERS_TEXTURE_BOX_GLSL

/// Texels `first`, first + 1 and first + 2 of the finer level, with their weights.
struct BoxTaps {
    int first;
    vec3 weight;
};

/// Texel i of max(1, floor(n / 2)). An even n halves; an odd n = 2m + 1 makes m texels, each the mean over a stretch
/// of n/m texels, so that every finer texel counts m/n in all ("polyphase": the weights shift along the row).
BoxTaps boxTaps(int i, int n) {
    if (n == 1) return BoxTaps(0, vec3(1.0, 0.0, 0.0));
    if ((n & 1) == 0) return BoxTaps(2 * i, vec3(0.5, 0.5, 0.0));
    int m = n >> 1;
    return BoxTaps(2 * i, vec3(float(m - i), float(m), float(i + 1)) / float(n));
}

#endif
