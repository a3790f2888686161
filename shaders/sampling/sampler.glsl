// Random numbers as a function of (pixel, sample, dimension, seed): no state is carried from one number to the
// next, so paths may be cut, resumed and reordered. Valid GLSL and C++.
//
// A *dimension* names one decision of a path (place in the pixel, direction of the second scattering, ...). It
// yields one number (sample1D) or a pair (sample2D); ask only once per dimension and sample. Which dimension
// serves which decision is the caller's; the camera's are below.
//
// Two halves: even and odd samples of a pixel are two sequences with independent scrambles. Their means are
// independent and equally distributed, so that ((A - B) / 2)^2 is an unbiased estimate of the variance of the
// pixel's mean, for any sampler. Samples 0, 2, 4, ... form half A.
//
// SAMPLER_SOBOL: the first two dimensions of Sobol's sequence, Owen-scrambled, padded: each dimension is an own
// scramble of an own shuffle of the same (0, 2)-sequence, so every pair is well stratified on its own and
// dimensions are independent of each other. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020;
// scramble by Laine and Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, in the improved
// form of Vegdahl, "Building a Better LK Hash", 2021.
// SAMPLER_INDEPENDENT: independent uniform numbers from a counter-based hash (pcg3d).
//
// A kernel passes `kind` from a specialization constant, so that the other sampler is not compiled:
//   layout(constant_id = 0) const uint SAMPLER_KIND = SAMPLER_SOBOL;
#ifndef SHADERS_SAMPLING_SAMPLER_GLSL
#define SHADERS_SAMPLING_SAMPLER_GLSL
#include "shaders/sampling/hash.glsl"

CONST uint SAMPLER_SOBOL = 0u;
CONST uint SAMPLER_INDEPENDENT = 1u;

/// Dimensions of the camera ray. Scattering starts at DIMENSION_PATH.
CONST uint DIMENSION_FILTER = 0u;  // 2D: place under the pixel filter
CONST uint DIMENSION_LENS = 1u;    // 2D
CONST uint DIMENSION_TIME = 2u;    // 1D
CONST uint DIMENSION_PATH = 3u;

/// One pixel's sample, ready to yield numbers.
struct PixelSampler {
    uint key;    // hash of seed, pixel and (Sobol) half
    uint index;  // Sobol: index within the half, bit-reversed; independent: sample
};

/// Starts a sample. `pixel` is any unique number of the pixel, such as y * width + x.
FN PixelSampler startSample(uint kind, uint pixel, uint sampleIndex, uint seed) {
    uint key = hashCombine(hashCombine(seed, 0x51a2c3d4u), pixel);
    PixelSampler s;
    if (kind == SAMPLER_SOBOL) {
        s.key = hashCombine(key, sampleIndex & 1u);
        s.index = bitfieldReverse(sampleIndex >> 1u);
    } else {
        s.key = key;
        s.index = sampleIndex;
    }
    return s;
}

/// Nested uniform (Owen) scramble of a bit-reversed number: bit i of the result is bit i flipped by a hash of
/// the bits below it. Only left-propagating steps: multiplication by an even number before xor, by an odd one,
/// addition.
FN uint scrambleReversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Second dimension of Sobol's sequence as a bit-reversed number: multiplication by the Pascal matrix mod 2.
/// The first is the index itself, bit-reversed (van der Corput).
FN uint sobolSecondReversed(uint index) {
    uint x = index;
    x ^= (x >> 16u) & 0x0000ffffu;
    x ^= (x >> 8u) & 0x00ff00ffu;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 2u) & 0x33333333u;
    x ^= (x >> 1u) & 0x55555555u;
    return x;
}

/// 32 scrambled bits of the first or second coordinate, to be read as a binary fraction.
FN uvec2 sobolPairBits(PixelSampler s, uint dimension) {
    uint shuffleSeed = hashUint(s.key + dimension * 0x9e3779b9u);
    uint index = bitfieldReverse(scrambleReversed(s.index, shuffleSeed));
    // Two further seeds by a Weyl step and one round of mixing each; the scramble mixes the rest.
    uint seedX = shuffleSeed * 0x9e3779b1u + 0x7f4a7c15u;
    uint seedY = seedX * 0x9e3779b1u + 0x7f4a7c15u;
    seedX ^= seedX >> 15u;
    seedY ^= seedY >> 15u;
    return uvec2(bitfieldReverse(scrambleReversed(index, seedX)),
                 bitfieldReverse(scrambleReversed(sobolSecondReversed(index), seedY)));
}

/// A uniform pair as 32 random bits each: for choices among many, where the 24 bits of a float are too coarse.
FN uvec2 sampleBits2D(uint kind, PixelSampler s, uint dimension) {
    if (kind == SAMPLER_SOBOL) return sobolPairBits(s, dimension);
    uvec3 bits = pcg3d(uvec3(s.key, s.index, dimension));
    return uvec2(bits.x, bits.y);
}

/// A uniform pair in [0, 1)^2.
FN Vec2 sample2D(uint kind, PixelSampler s, uint dimension) {
    uvec2 bits = sampleBits2D(kind, s, dimension);
    return Vec2(unitFloat(bits.x), unitFloat(bits.y));
}

/// A uniform number in [0, 1).
FN Real sample1D(uint kind, PixelSampler s, uint dimension) {
    if (kind == SAMPLER_SOBOL) return unitFloat(sobolPairBits(s, dimension).x);
    return unitFloat(pcg3d(uvec3(s.key, s.index, dimension)).x);
}

#endif
