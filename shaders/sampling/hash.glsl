// Integer hashes for random numbers. Valid GLSL and C++ (see shaders/shared/real.glsl).
#ifndef SHADERS_SAMPLING_HASH_GLSL
#define SHADERS_SAMPLING_HASH_GLSL
#include "shaders/shared/real.glsl"

/// A bijection of 32 bits in which every input bit flips every output bit with probability near 1/2.
/// Form: Mueller's two-round xorshift-multiply; constants: TheIronBorn's search (Wellons, "Prospecting for
/// hash functions", bias 0.107).
FN uint hashUint(uint x) {
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    x ^= x >> 15u;
    return x;
}

/// Folds a value into a key. Not symmetric; a change in either changes every bit.
FN uint hashCombine(uint key, uint value) { return hashUint(key ^ (hashUint(value + 0x9e3779b9u))); }

/// PCG3D: three dependent rounds of a linear congruential step, each mixing in the other two. Jarzynski and
/// Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020. All three words are good random numbers.
FN uvec3 pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> 16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

/// Uniform in [0, 1) from the leading 24 bits: a multiple of 2^-24, exact, never 1.
FN Real unitFloat(uint bits) { return Real(int(bits >> 8u)) * REAL(5.9604644775390625e-08); }

#endif
