// Perlin's improved noise (Perlin, "Improving noise", 2002) with its published permutation, sums of it over octaves, and
// the patterns made of them: smooth functions of space, from -1 to 1 (noise) or 0 to 1 (patterns).
#ifndef SHADERS_TEXTURE_NOISE_GLSL
#define SHADERS_TEXTURE_NOISE_GLSL
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/trigonometry.glsl"

#ifdef NOISE_PAIR
/// Two neighbours of the permutation, from a table of the includer's: compilers take long over arrays in code.
ivec2 noisePair(int i) { return NOISE_PAIR(i & 255); }
#else
/// Four numbers of the permutation a word, the first in its low byte.
const uint NOISE_PERMUTATION[64] = uint[64](
    0x5b89a097u, 0x0d830f5au, 0x35605fc9u, 0xe107e9c2u, 0x1e67248cu, 0x63088e45u, 0x0a15f025u, 0x9406be17u,
    0x4bea78f7u, 0x3ec51a00u, 0xcbdbfc5eu, 0x200b2375u, 0x5821b139u, 0x573895edu, 0x887d14aeu, 0xaf44a8abu,
    0x8647a54au, 0xa61b308bu, 0xe79e924du, 0x7ae56f53u, 0xe685d33cu, 0x295c69dcu, 0x28f52e37u, 0x368f66f4u,
    0xa13f1941u, 0x4950d801u, 0xbb844cd1u, 0xa91259d0u, 0x8287c4c8u, 0x569fbc74u, 0xc66d64a4u, 0x4003baadu,
    0xfae2d934u, 0xca057b7cu, 0x7e769326u, 0xd45552ffu, 0xe33bcecfu, 0x113a102fu, 0x2a1cbdb6u, 0xd5aab7dfu,
    0x0298f877u, 0x46a39a2cu, 0x9b6599ddu, 0x09ac2ba7u, 0xfd271681u, 0x6e6c6213u, 0xe8e0714fu, 0x6870b9b2u,
    0xe461f6dau, 0xc1f222fbu, 0x0c90d2eeu, 0xf1a2b3bfu, 0xeb913351u, 0x6bef0ef9u, 0x1fd6c031u, 0x9d6ac7b5u,
    0xb0cc54b8u, 0x2d327973u, 0xfe96047fu, 0x5dcdec8au, 0x1d4372deu, 0x8df34818u, 0x424ec380u, 0xb49c3dd7u);

int noisePermutation(int i) { return int(NOISE_PERMUTATION[i >> 2 & 63] >> uint(8 * (i & 3)) & 255u); }
ivec2 noisePair(int i) { return ivec2(noisePermutation(i), noisePermutation(i + 1)); }
#endif

/// Product of an offset from a corner of the lattice and the gradient there: one of the 12 edges of a cube.
float noiseGradient(int hash, vec3 d) {
    int h = hash & 15;
    float u = h < 8 ? d.x : d.y;
    float v = h < 4 ? d.y : (h == 12 || h == 14 ? d.x : d.z);
    return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}

/// 0 at whole coordinates, twice continuously differentiable; repeats after 256. Offsets are exact differences of floats:
/// coordinates beyond 2^23 are whole.
float perlinNoise(vec3 p) {
    vec3 cell = floor(p), d = p - cell;
    // Into 0..255 as floats, which any coordinate survives.
    ivec3 c = ivec3(cell - 256.0 * floor(cell * (1.0 / 256.0)));
    // 6 t^5 - 15 t^4 + 10 t^3 from the nearer end, where its terms do not cancel.
    vec3 t = min(d, 1.0 - d), f = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    f = mix(f, 1.0 - f, greaterThan(d, vec3(0.5)));
    ivec2 x = noisePair(c.x), a = noisePair(x.x + c.y), b = noisePair(x.y + c.y);
    // Of the four columns along z, at both ends.
    ivec2 h00 = noisePair(a.x + c.z), h01 = noisePair(a.y + c.z), h10 = noisePair(b.x + c.z), h11 = noisePair(b.y + c.z);
    vec3 d10 = d - vec3(1.0, 0.0, 0.0), d01 = d - vec3(0.0, 1.0, 0.0), d11 = d - vec3(1.0, 1.0, 0.0),
         up = vec3(0.0, 0.0, 1.0);
    float low = mix(mix(noiseGradient(h00.x, d), noiseGradient(h10.x, d10), f.x),
                    mix(noiseGradient(h01.x, d01), noiseGradient(h11.x, d11), f.x), f.y);
    float high = mix(mix(noiseGradient(h00.y, d - up), noiseGradient(h10.y, d10 - up), f.x),
                     mix(noiseGradient(h01.y, d01 - up), noiseGradient(h11.y, d11 - up), f.x), f.y);
    return mix(low, high, f.z);
}

// What the mean over a square of `width` units keeps of a value in its middle, in the sense of least squares, measured
// over a million points and fitted within 0.03: of the noise, of its magnitude's part above the mean, and of a wave of
// period 1 (there sin(pi w) / (pi w), up to its first zero). The rest is too fine for such samples, which would show
// other patterns in its place.
float noiseFade(float width) { return realExp(max(-0.56 * width * width, -80.0)); }
float magnitudeFade(float width) { return realExp(max(-1.25 * width * width, -80.0)); }
float waveFade(float width) { return realExp(max(-1.75 * width * width, -80.0)); }

const int NOISE_OCTAVES = 6;
/// Mean of |noise|, measured.
const float NOISE_MAGNITUDE = 0.2176;

/// Sums over octaves: octave i has 2^i features a unit and weight 2^-i.
struct NoiseSums {
    float fractal;    ///< of the noise; what is too fine for samples `width` units wide is left out
    float turbulent;  ///< of its magnitude (Perlin, "An image synthesizer", 1985); what is too fine becomes its mean
};
NoiseSums noiseSums(vec3 p, float width, int octaves) {
    NoiseSums sums = NoiseSums(0.0, 0.0);
    float scale = 1.0;
    // Not unrolled: the noise is in the kernel once.
    [[dont_unroll]] for (int i = 0; i < octaves; ++i) {
        float noise = perlinNoise(p * scale);
        sums.fractal += noiseFade(width * scale) * noise / scale;
        sums.turbulent += mix(NOISE_MAGNITUDE, abs(noise), magnitudeFade(width * scale)) / scale;
        scale *= 2.0;
    }
    return sums;
}

// SolidTexture::Pattern + 1.
const int SOLID_NOISE = 1, SOLID_CLOUDS = 2, SOLID_MARBLE = 3, SOLID_WOOD = 4;

/// A wave of period 1, from 0 to 1, faded to its mean where a sample stands for too much of it.
float patternWave(float x, float width) {
    float sine, cosine;
    sinCosTurns(x - floor(x), sine, cosine);
    return 0.5 - 0.5 * cosine * waveFade(width);
}

/// How much of the second colour a pattern shows at a point of space.
float solidPattern(int pattern, vec3 p, float width) {
    bool single = pattern == SOLID_NOISE || pattern == SOLID_WOOD;
    // Wood has a slow grain.
    float slow = pattern == SOLID_WOOD ? 0.3 : 1.0;
    NoiseSums sums = noiseSums(p * vec3(slow, pattern == SOLID_WOOD ? 0.1 : 1.0, slow), width * slow,
                               single ? 1 : NOISE_OCTAVES);
    // Veins across x, shifted by turbulence; rings about y, shifted by the grain.
    float at = pattern == SOLID_MARBLE ? p.x + 1.2 * sums.turbulent : length(p.xz) + 0.6 * sums.fractal;
    float wave = patternWave(at, width);
    return clamp(pattern == SOLID_MARBLE || pattern == SOLID_WOOD ? wave : 0.5 + 0.5 * sums.fractal, 0.0, 1.0);
}

#endif
