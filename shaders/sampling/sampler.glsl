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
// SAMPLER_HALTON: each dimension a pair of own primes of Halton's sequence, digits scrambled at random (Kocis and
// Whiten 1997; the digits of base 2 by Owen's way), 16 dimensions; later ones are independent.
// SAMPLER_STRATIFIED: a jittered grid of 2^strata cells over a half's samples, taken in an order of its own in each
// dimension; the next 2^strata samples are another grid.
// SAMPLER_SOBOL_BLUE: the Sobol sampler with one sequence for all pixels, which take 2^strata samples of each half in
// turn along a Morton curve: neighbours have what the others lack, so that error is blue noise over the screen. Ahmed
// and Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels",
// SIGGRAPH Asia 2020; Owen's scramble of the index is the hierarchical shuffle. `pixel` is the Morton code.
//
// A kernel passes `kind` from a specialization constant, so that the other sampler is not compiled:
//   layout(constant_id = 0) const uint SAMPLER_KIND = SAMPLER_SOBOL;
#ifndef SHADERS_SAMPLING_SAMPLER_GLSL
#define SHADERS_SAMPLING_SAMPLER_GLSL
#include "shaders/sampling/hash.glsl"

CONST uint SAMPLER_SOBOL = 0u;
CONST uint SAMPLER_INDEPENDENT = 1u;
CONST uint SAMPLER_HALTON = 2u;
CONST uint SAMPLER_STRATIFIED = 3u;
CONST uint SAMPLER_SOBOL_BLUE = 4u;

/// Dimensions of the camera ray. Scattering starts at DIMENSION_PATH.
CONST uint DIMENSION_FILTER = 0u;  // 2D: place under the pixel filter
CONST uint DIMENSION_LENS = 1u;    // 2D
CONST uint DIMENSION_TIME = 2u;    // 1D
CONST uint DIMENSION_PATH = 3u;

/// One pixel's sample, ready to yield numbers.
struct PixelSampler {
    uint key;     // hash of seed, pixel and half (independent: no half; blue: no pixel)
    uint index;   // within the half (Sobol: bit-reversed); independent: sample
    uint strata;  // see startSample
};

/// The bits of x and y interleaved: the place of a pixel along a Morton curve. Coordinates below 2^16.
FN uint mortonCode(uint x, uint y) {
    x = (x | (x << 8u)) & 0x00ff00ffu;
    y = (y | (y << 8u)) & 0x00ff00ffu;
    x = (x | (x << 4u)) & 0x0f0f0f0fu;
    y = (y | (y << 4u)) & 0x0f0f0f0fu;
    x = (x | (x << 2u)) & 0x33333333u;
    y = (y | (y << 2u)) & 0x33333333u;
    x = (x | (x << 1u)) & 0x55555555u;
    y = (y | (y << 1u)) & 0x55555555u;
    return x | (y << 1u);
}

/// Starts a sample. `pixel` is any unique number of the pixel, such as y * width + x, but for SAMPLER_SOBOL_BLUE its
/// mortonCode(). 2^strata is at least the number of samples of a half: stratified and blue go by it.
FN PixelSampler startSample(uint kind, uint pixel, uint sampleIndex, uint seed, uint strata) {
    uint key = hashCombine(seed, 0x51a2c3d4u);
    if (kind != SAMPLER_SOBOL_BLUE) key = hashCombine(key, pixel);
    PixelSampler s;
    s.strata = strata;
    if (kind == SAMPLER_INDEPENDENT) {
        s.key = key;
        s.index = sampleIndex;
        return s;
    }
    s.key = hashCombine(key, sampleIndex & 1u);
    s.index = sampleIndex >> 1u;
    if (kind == SAMPLER_SOBOL_BLUE) s.index = (pixel << strata) + s.index;
    if (kind == SAMPLER_SOBOL || kind == SAMPLER_SOBOL_BLUE) s.index = bitfieldReverse(s.index);
    return s;
}
FN PixelSampler startSample(uint kind, uint pixel, uint sampleIndex, uint seed) {
    return startSample(kind, pixel, sampleIndex, seed, 0u);
}

/// The i-th of n samples that one sample is split into. A dimension is to be asked of all of them, or of the sample itself.
FN PixelSampler splitSample(uint kind, PixelSampler s, uint n, uint i) {
    const bool reversed = kind == SAMPLER_SOBOL || kind == SAMPLER_SOBOL_BLUE;
    const uint index = (reversed ? bitfieldReverse(s.index) : s.index) * n + i;
    s.index = reversed ? bitfieldReverse(index) : index;
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

/// The i-th prime, i < 32.
FN uint smallPrime(uint i) {
    uint p = i < 1u ? 2u : i < 2u ? 3u : i < 3u ? 5u : i < 4u ? 7u : i < 5u ? 11u : i < 6u ? 13u : i < 7u ? 17u : 19u;
    uint q = i < 9u ? 23u : i < 10u ? 29u : i < 11u ? 31u : i < 12u ? 37u : i < 13u ? 41u : i < 14u ? 43u
             : i < 15u ? 47u : 53u;
    uint r = i < 17u ? 59u : i < 18u ? 61u : i < 19u ? 67u : i < 20u ? 71u : i < 21u ? 73u : i < 22u ? 79u
             : i < 23u ? 83u : 89u;
    uint s = i < 25u ? 97u : i < 26u ? 101u : i < 27u ? 103u : i < 28u ? 107u : i < 29u ? 109u : i < 30u ? 113u
             : i < 31u ? 127u : 131u;
    return i < 8u ? p : i < 16u ? q : i < 24u ? r : s;
}

/// One digit of the scrambled radical inverse: d to a d + c modulo the base, a and c at random for each place.
FN void haltonDigit(uint base, INOUT(uint) index, INOUT(uint) random, INOUT(Real) scale, INOUT(Real) sum) {
    random = hashUint(random + 0x9e3779b9u);
    uint next = index / base;
    uint digit = index - next * base;
    uint factor = 1u + (random & 0xffffu) % (base - 1u), shift = (random >> 16u) % base;
    index = next;
    scale = scale / Real(int(base));
    sum += Real(int((digit * factor + shift) % base)) * scale;
}

/// 32 bits of the scrambled radical inverse of `index`. The digits that are not told apart are uniform.
FN uint haltonBits(uint base, uint index, uint seed) {
    if (base == 2u) return bitfieldReverse(scrambleReversed(index, seed));
    Real scale = REAL(1.0);
    Real sum = REAL(0.0);
    uint random = seed;
    // Written out: some drivers count the turns of all loops together.
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    haltonDigit(base, index, random, scale, sum);
    uint rest = hashUint(hashCombine(random, index));
    sum += unitFloat(rest) * scale;
    uint leading = uint(int(min(sum, REAL(0.99999994)) * REAL(16777216.0)));
    return (leading << 8u) | (hashUint(rest) >> 24u);
}

/// A permutation of the numbers of `bits` bits, by a seed.
FN uint permuteBits(uint x, uint bits, uint seed) {
    uint mask = (1u << bits) - 1u;
    uint half_ = (bits >> 1u) + 1u;
    x = (x ^ seed) & mask;
    x = (x * 0x9e3779b1u) & mask;
    x ^= x >> half_;
    x = (x * ((seed >> 8u) | 1u)) & mask;
    x ^= x >> half_;
    x = (x * 0xd35a2d97u + (seed >> 16u)) & mask;
    x ^= x >> half_;
    x = (x * 0x21f0aaadu) & mask;
    return x;
}

/// The upper `bits` bits from a cell, the others at random.
FN uint inCell(uint cell, uint bits, uint random) {
    return bits == 0u ? random : (cell << (32u - bits)) | (random >> bits);
}

/// The cell of a stratified sample, of 2^strata.
FN uint stratum(PixelSampler s, uint dimension) {
    uint grid = hashCombine(s.key + dimension * 0x9e3779b9u, s.index >> s.strata);
    return permuteBits(s.index & ((1u << s.strata) - 1u), s.strata, grid);
}

/// A uniform pair as 32 random bits each: for choices among many, where the 24 bits of a float are too coarse.
FN uvec2 sampleBits2D(uint kind, PixelSampler s, uint dimension) {
    if (kind == SAMPLER_SOBOL || kind == SAMPLER_SOBOL_BLUE) return sobolPairBits(s, dimension);
    if (kind == SAMPLER_HALTON && dimension < 16u) {
        uint seed = hashUint(s.key + dimension * 0x9e3779b9u);
        return uvec2(haltonBits(smallPrime(2u * dimension), s.index, seed),
                     haltonBits(smallPrime(2u * dimension + 1u), s.index, hashUint(seed)));
    }
    uvec3 bits = pcg3d(uvec3(s.key, s.index, dimension));
    if (kind == SAMPLER_STRATIFIED) {
        uint cell = stratum(s, dimension);
        uint columns = (s.strata + 1u) >> 1u;
        return uvec2(inCell(cell & ((1u << columns) - 1u), columns, bits.x),
                     inCell(cell >> columns, s.strata - columns, bits.y));
    }
    return uvec2(bits.x, bits.y);
}

/// A uniform pair in [0, 1)^2.
FN Vec2 sample2D(uint kind, PixelSampler s, uint dimension) {
    uvec2 bits = sampleBits2D(kind, s, dimension);
    return Vec2(unitFloat(bits.x), unitFloat(bits.y));
}

/// A uniform number in [0, 1).
FN Real sample1D(uint kind, PixelSampler s, uint dimension) {
    if (kind == SAMPLER_STRATIFIED)
        return unitFloat(inCell(stratum(s, dimension), s.strata, pcg3d(uvec3(s.key, s.index, dimension)).x));
    return unitFloat(sampleBits2D(kind, s, dimension).x);
}

#endif
