// Pixel filters by importance sampling: a sample is put at a distance from the pixel's centre drawn from the
// filter, so that every sample has the same weight and pixels stay independent of each other. All filters are
// separable; lengths are in pixels. Valid GLSL and C++.
//
//   FILTER_BOX              width 1: |x| <= 1/2; the pixel's area. Variance 1/12.
//   FILTER_TENT             |x| <= 1, 1 - |x|. Variance 1/6.
//   FILTER_GAUSSIAN         standard deviation 1/2; it ends where 24-bit random numbers do, at 2.71.
//   FILTER_BLACKMAN_HARRIS  |x| <= 3/2, the four-term window of Harris, "On the use of windows for harmonic
//                           analysis with the discrete Fourier transform" (1978). Variance 0.17265848.
#ifndef SHADERS_FILM_FILTER_GLSL
#define SHADERS_FILM_FILTER_GLSL
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/real.glsl"

CONST uint FILTER_BOX = 0u;
CONST uint FILTER_TENT = 1u;
CONST uint FILTER_GAUSSIAN = 2u;
CONST uint FILTER_BLACKMAN_HARRIS = 3u;

CONST Real FILTER_GAUSSIAN_DEVIATION = REAL(0.5);
CONST Real FILTER_BLACKMAN_HARRIS_RADIUS = REAL(1.5);

/// u in [0, 1) to v in (-1, 1), symmetric about 0: the middle of u's step of 2^-24.
FN Real centredUniform(Real u) { return (2.0 * u - 1.0) + REAL(5.9604644775390625e-08); }

/// -log(1 - v^2), in which inverse distribution functions with light tails are smooth (Giles, "Approximating the
/// erfinv function", 2011), scaled to [-1, 1].
FN Real tailVariable(Real v) {
    Real a = abs(v);
    return -0.125 * realLog((1.0 - a) * (1.0 + a)) - 1.0;
}

/// Standard normal deviate of quantile (1 + v) / 2. Error below 7e-7 of the distribution, 0.003 of the deviate.
FN Real normalDeviate(Real v) {
    Real t = tailVariable(v);
    Real p = REAL(0.0935220048);
    p = p * t + REAL(0.038648583);
    p = p * t - REAL(0.210162908);
    p = p * t + REAL(0.0321935229);
    p = p * t + REAL(0.0416352265);
    p = p * t - REAL(0.0305644907);
    p = p * t + REAL(0.169732988);
    p = p * t - REAL(0.460803658);
    p = p * t + REAL(1.99531937);
    p = p * t + REAL(3.76389456);
    return v * p;
}

/// Quantile (1 + v) / 2 of the Blackman-Harris window on [-1, 1]. Error below 4e-6 of the distribution.
FN Real blackmanHarrisQuantile(Real v) {
    Real t = tailVariable(v);
    Real p = REAL(-0.0427952819);
    p = p * t - REAL(0.00129309832);
    p = p * t + REAL(0.136866018);
    p = p * t + REAL(0.0251004416);
    p = p * t - REAL(0.118304595);
    p = p * t - REAL(0.0797164068);
    p = p * t + REAL(0.0477718152);
    p = p * t + REAL(0.112167209);
    p = p * t - REAL(0.24364531);
    p = p * t + REAL(0.264473617);
    p = p * t + REAL(0.899567425);
    return clamp(v * p, REAL(-1.0), REAL(1.0));
}

/// Distance from the pixel's centre along one axis for a uniform u in [0, 1).
FN Real filterOffset1D(uint kind, Real u) {
    Real v = centredUniform(u);
    if (kind == FILTER_TENT) {
        // v = sign (1 - (1 - |x|)^2)
        Real a = abs(v);
        Real x = a / (1.0 + sqrt(1.0 - a));
        return v < 0.0 ? -x : x;
    }
    if (kind == FILTER_GAUSSIAN) return FILTER_GAUSSIAN_DEVIATION * normalDeviate(v);
    if (kind == FILTER_BLACKMAN_HARRIS) return FILTER_BLACKMAN_HARRIS_RADIUS * blackmanHarrisQuantile(v);
    return 0.5 * v;
}

/// Distance from the pixel's centre for a uniform pair.
FN Vec2 filterOffset(uint kind, Vec2 u) {
    return Vec2(filterOffset1D(kind, u.x), filterOffset1D(kind, u.y));
}

#endif
