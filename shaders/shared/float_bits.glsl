// Numbers as bits: neighbours, powers of two, scaling without rounding.
#ifndef SHADERS_SHARED_FLOAT_BITS_GLSL
#define SHADERS_SHARED_FLOAT_BITS_GLSL
#include "shaders/shared/real.glsl"

#if PRECISION_BITS == 32  // the double build has them in engine/core/shared_double.inc

CONST uint SIGN_BIT = 0x80000000u;

FN Real infinity() { return uintBitsToFloat(0x7f800000u); }
FN Real quietNaN() { return uintBitsToFloat(0x7fc00000u); }

/// True for -0 and negative NaN too.
FN bool signBit(Real x) { return floatBitsToUint(x) >= SIGN_BIT; }

FN Real copySign(Real magnitude, Real signSource) {
    return uintBitsToFloat((floatBitsToUint(magnitude) & ~SIGN_BIT) | (floatBitsToUint(signSource) & SIGN_BIT));
}

/// magnitude with its sign flipped where signSource is negative: magnitude * sign(signSource) without a
/// product.
FN Real multiplySign(Real magnitude, Real signSource) {
    return uintBitsToFloat(floatBitsToUint(magnitude) ^ (floatBitsToUint(signSource) & SIGN_BIT));
}

/// The least number above x. nextUp(+inf) = +inf; NaN stays NaN; above both zeros is the least subnormal,
/// which a device may flush.
FN Real nextUp(Real x) {
    uint bits = floatBitsToUint(x);
    uint up = bits >= SIGN_BIT ? bits - 1u : bits + 1u;
    up = bits == SIGN_BIT ? 1u : up;
    bool keep = isnan(x) || bits == 0x7f800000u;
    return keep ? x : uintBitsToFloat(up);
}

/// The greatest number below x.
FN Real nextDown(Real x) { return -nextUp(-x); }

/// 2^n for n in [-126, 127].
FN Real powerOfTwo(int n) { return uintBitsToFloat(uint(n + 127) << 23); }

/// x 2^n with one rounding at most (none but into the subnormals), for n in [-252, 254].
FN Real scaleByPowerOfTwo(Real x, int n) {
    int first = n >> 1;
    precise Real y = (x * powerOfTwo(first)) * powerOfTwo(n - first);
    return y;
}

/// The greatest power of two not above |x|, for normal x; x may be scaled by its inverse without rounding.
/// Kept within [2^-126, 2^126], so that the inverse is a normal number too: 0 and subnormals give 2^-126,
/// infinities and NaN 2^126.
FN Real powerOfTwoBelow(Real x) {
    uint exponent = floatBitsToUint(x) & 0x7f800000u;
    return uintBitsToFloat(clamp(exponent, 0x00800000u, 0x7e800000u));
}

/// The 12 leading bits of x, so that a product of two such is exact. x minus it is exact too.
FN Real leadingBits(Real x) { return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u); }

#endif
#endif
