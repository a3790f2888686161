// exp, log, pow and their kin, the same on every device that rounds +, -, * as IEEE does. Coefficients are
// minimax fits (Remez exchange, each rounded to float before the next was fitted). Errors stated are the
// worst over every normal float of the domain, in units in the last place (ULP) of the exact result:
// tests/accuracy, exhaustively.
#ifndef SHADERS_SHARED_EXPONENTIAL_GLSL
#define SHADERS_SHARED_EXPONENTIAL_GLSL
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"

#if PRECISION_BITS == 32  // the double build has the C library's, in engine/core/shared_double.inc

// ln 2 in two parts: a product of the first, which has 14 bits, with an exponent is exact.
CONST Real LN_TWO_HIGH = 0.693115234375;
CONST Real LN_TWO_LOW = REAL(3.19461833e-05);
CONST Real LOG2_E = REAL(1.44269504088896340736);

/// exp(r) - 1 - r for |r| <= 0.3469.
FN Real expTail(Real r) {
    Real q = REAL(0.00140339497);
    q = q * r + REAL(0.00837226212);
    q = q * r + REAL(0.0416655578);
    q = q * r + REAL(0.166664883);
    q = q * r + 0.5;
    return q * (r * r);
}

/// x = n ln 2 + r with |r| <= ln(2)/2.
FN Real expReduce(Real x, OUT(int) n) {
    Real k = roundEven(x * LOG2_E);
    n = int(k);
    precise Real r = (x - k * LN_TWO_HIGH) - k * LN_TWO_LOW;
    return r;
}

/// e^x. exp(-inf) = 0, exp(+inf) = inf, NaN gives NaN. 0.998 ULP.
FN Real realExp(Real x) {
    int n;
    // Beyond these ends the result is 0 or infinity anyway.
    Real r = expReduce(isnan(x) ? 0.0 : clamp(x, -104.0, 89.0), n);
    precise Real y = 1.0 + (r + expTail(r));
    y = scaleByPowerOfTwo(y, n);
    return isnan(x) ? x : y;
}

/// 2^x; exact for integers. 0.998 ULP.
FN Real realExp2(Real x) {
    Real c = isnan(x) ? 0.0 : clamp(x, -151.0, 129.0);
    Real k = roundEven(c);
    Real r = (c - k) * LN_TWO;
    precise Real y = 1.0 + (r + expTail(r));
    y = scaleByPowerOfTwo(y, int(k));
    return isnan(x) ? x : y;
}

/// e^x - 1 without cancellation near 0. expm1(-inf) = -1; the sign of zero is kept. 1.64 ULP.
FN Real realExpm1(Real x) {
    int n;
    Real r = expReduce(isnan(x) ? 0.0 : clamp(x, -104.0, 89.0), n);
    Real tail = expTail(r);
    // 2^n (1 + r + tail) - 1 = 2^n ((1 - 2^-n) + r + tail), scaled by 2^(n-1) to stay in range.
    Real one = n > 100 ? 0.0 : powerOfTwo(-max(n, -26));
    precise Real y = n == 0 ? r + tail : (1.0 - one) + (r + tail);
    y = n < -26 ? -1.0 : scaleByPowerOfTwo(y, n);
    // A tiny x is its own result; the sum above would lose the sign of -0.
    return isnan(x) || abs(x) < REAL(2e-8) ? x : y;
}

/// x = 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)), for positive finite x.
FN Real logReduce(Real x, OUT(int) k) {
    bool subnormal = x < REAL_MIN_NORMAL;
    uint bits = floatBitsToUint(subnormal ? x * 8388608.0 : x);
    int e = int(bits - 0x3f3504f3u) >> 23;
    k = subnormal ? e - 23 : e;
    return uintBitsToFloat(bits - (uint(e) << 23)) - 1.0;
}

/// log(1 + f) = f - half + s (half + R) with half = f^2/2 and s = f / (2 + f), from 2 atanh(s) =
/// log((1+s)/(1-s)): the leading f is exact, so that nothing cancels near 1. Returns all but f.
FN Real logTail(Real f) {
    precise Real s = f / (2.0 + f);
    Real z = s * s;
    Real r = z * (REAL(0.666667759) + z * (REAL(0.399775833) + z * REAL(0.298707962)));
    precise Real halfSquare = 0.5 * f * f;
    precise Real tail = s * (halfSquare + r) - halfSquare;
    return tail;
}

/// What log, log2 and log1p give where they have no finite value: x is the argument of the logarithm.
FN Real logSpecial(Real x, Real y) {
    y = x == 0.0 ? -infinity() : y;
    y = x < 0.0 ? quietNaN() : y;
    return isnan(x) || x == infinity() ? x : y;
}

/// Natural logarithm. log(0) = -inf, log of a negative number NaN. 0.91 ULP.
FN Real realLog(Real x) {
    int k;
    Real f = logReduce(x, k);
    precise Real y = Real(k) * LN_TWO_HIGH + (f + (logTail(f) + Real(k) * LN_TWO_LOW));
    return logSpecial(x, y);
}

/// log(1 + x) without cancellation near 0. log1p(-1) = -inf; the sign of zero is kept. 0.91 ULP.
FN Real realLog1p(Real x) {
    precise Real u = 1.0 + x;
    // What rounding u lost, exactly: the smaller summand minus what arrived of it.
    precise Real lost = abs(x) < 1.0 ? x - (u - 1.0) : 1.0 - (u - x);
    int k;
    Real f = logReduce(u, k);
    Real correction = k > 30 ? 0.0 : lost / u;
    precise Real y = Real(k) * LN_TWO_HIGH + (f + (logTail(f) + (Real(k) * LN_TWO_LOW + correction)));
    y = logSpecial(u, y);
    return abs(x) < REAL(2e-8) ? x : y;
}

/// Base-2 logarithm; exact for powers of two. 0.97 ULP.
FN Real realLog2(Real x) {
    int k;
    Real f = logReduce(x, k);
    Real tail = logTail(f);
    // (f + tail) / ln 2 with 1/ln 2 = 1.4423828125 + 0.000312..., the first of 12 bits as is `high`.
    precise Real high = leadingBits(f + tail);
    precise Real low = (f - high) + tail;
    precise Real y =
        Real(k) + (high * 1.4423828125 + (low * REAL(1.44269502) + high * REAL(0.000312228396)));
    return logSpecial(x, y);
}

/// log2(x) for positive finite x as the sum of a 12-bit head and a tail, to a relative error of about 2^-35.
FN Real log2InTwoParts(Real x, OUT(Real) tail) {
    int k;
    Real f = logReduce(x, k);
    // s = f / (2 + f) in two parts: a 12-bit head, and the division's remainder against 2 + f = head + tail.
    precise Real sumHead = leadingBits(2.0 + f);
    precise Real sumTail = (2.0 - sumHead) + f;
    precise Real inverse = 1.0 / (2.0 + f);
    precise Real s = f * inverse;
    precise Real sHead = leadingBits(s);
    precise Real sTail = ((f - sHead * sumHead) - sHead * sumTail) * inverse;
    // 3 atanh(s) / s = 3 + z + z^2 q(z), z = s^2, again as head and tail.
    precise Real zHead = sHead * sHead;
    precise Real zTail = sTail * (s + sHead);
    Real z = s * s;
    Real q = REAL(0.600002289) + z * (REAL(0.428206354) + z * REAL(0.351294518));
    precise Real rest = zTail + z * z * q;
    precise Real seriesHead = leadingBits((3.0 + zHead) + rest);
    precise Real seriesTail = rest - ((seriesHead - 3.0) - zHead);
    // Their product, then times 2 / (3 ln 2).
    precise Real u = sHead * seriesHead;
    precise Real v = sTail * seriesHead + seriesTail * s;
    precise Real head = leadingBits(u + v);
    precise Real rem = v - (head - u);
    precise Real logHead = head * 0.9619140625;
    precise Real logRest = head * REAL(-0.000117368574) + rem * REAL(0.961796701);
    precise Real sum = leadingBits((Real(k) + logHead) + logRest);
    tail = logRest - ((sum - Real(k)) - logHead);
    return sum;
}

/// x^y for x > 0, both finite; two thirds of the time of realPow. 1.12 ULP in 2e7 random bases and exponents
/// with normal results, bases next to 1 with exponents up to 1e8 among them.
FN Real powPositive(Real x, Real y) {
    Real tail;
    Real head = log2InTwoParts(x, tail);
    // Beyond 2^32 nothing but 0, 1 and infinity can come out.
    Real exponent = clamp(y, -4294967296.0, 4294967296.0);
    precise Real exponentHead = leadingBits(exponent);
    precise Real productHead = exponentHead * head;
    precise Real productTail = (exponent - exponentHead) * head + exponent * tail;
    // The order of the clamps does not matter: a saturated sum has no use for its tail.
    precise Real sum = productHead + productTail;
    bool saturated = abs(sum) > 160.0;
    Real k = roundEven(clamp(sum, -160.0, 160.0));
    precise Real r = saturated ? 0.0 : ((productHead - k) + productTail) * LN_TWO;
    precise Real z = 1.0 + (r + expTail(r));
    return scaleByPowerOfTwo(z, int(k));
}

/// x^y with C's special values: pow(x, 0) = pow(1, y) = 1 even for NaN; a negative x needs an integer y, else
/// NaN. Errors as powPositive.
FN Real realPow(Real x, Real y) {
    Real magnitude = abs(x);
    bool yInteger = floor(y) == y;
    bool yOdd = yInteger && abs(y) < 16777216.0 && floor(y * 0.5) * 2.0 != y;
    // Zeros, infinities and NaN are computed as 1 and replaced afterwards.
    bool xSpecial = !(magnitude > 0.0) || isinf(x);
    Real z = powPositive(xSpecial ? 1.0 : magnitude, isnan(y) ? 0.0 : y);
    // 0 and inf to a power: which of both comes out is the sign of y against the side of 1.
    Real extreme = (magnitude == 0.0) != (y < 0.0) ? 0.0 : infinity();
    z = magnitude == 0.0 || isinf(x) ? extreme : z;
    z = signBit(x) && yOdd ? -z : z;
    z = x < 0.0 && !yInteger && !isinf(x) ? quietNaN() : z;
    z = isnan(x) ? x : isnan(y) ? y : z;
    return y == 0.0 || x == 1.0 ? 1.0 : z;
}

#endif
#endif
