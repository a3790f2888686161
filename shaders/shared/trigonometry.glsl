// Sine, cosine, tangent and their inverses, the same on every device that rounds +, -, *, / and sqrt as IEEE
// does. Coefficients are minimax fits (Remez exchange, each rounded to float before the next was fitted).
// Errors stated are the worst over every normal float of the domain, in ULP of the exact result:
// tests/accuracy, exhaustively.
#ifndef SHADERS_SHARED_TRIGONOMETRY_GLSL
#define SHADERS_SHARED_TRIGONOMETRY_GLSL
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"

#if PRECISION_BITS == 32  // the double build has the C library's, in engine/core/shared_double.inc

/// sin and cos of r + low, for |r| <= pi/4 and low a rounding error of r.
FN Real sinKernel(Real r, Real low) {
    Real z = r * r;
    Real p = REAL(-0.166666552) + z * (REAL(0.00833219104) + z * REAL(-0.000195186047));
    precise Real y = r + (r * (z * p) + low);
    return y;
}
FN Real cosKernel(Real r, Real low) {
    Real z = r * r;
    Real p = REAL(0.0416666456) + z * (REAL(-0.00138873013) + z * REAL(2.44306702e-05));
    precise Real y = 1.0 - (0.5 * z - (z * z * p - r * low));
    return y;
}

/// x = quadrant pi/2 + r + low with |r| <= pi/4. pi/2 in parts of 8 bits, whose products with the quadrant
/// are exact, so that r keeps its last bits next to multiples of pi/2 up to |x| = 1e5. Larger angles lose
/// accuracy bit by bit, and have none beyond 2^22; infinities and NaN give NaN.
FN Real reduceQuadrant(Real x, OUT(Real) low, OUT(int) quadrant) {
    precise Real k = roundEven(clamp(x, -4194304.0, 4194304.0) * REAL(0.636619772367581343076));
    // Multiples of 2^-24 below 1: these three are exact.
    precise Real near = ((x - k * 1.5703125) - k * 0.0004825592041015625) - k * REAL(1.2516975402832031e-06);
    // From here on each difference is exact where it is small, and its rounding error is kept where it is
    // not.
    precise Real part = k * REAL(1.5832483768463135e-08);
    precise Real nearer = near - part;
    precise Real part2 = k * REAL(6.0481397667899728e-11);
    precise Real r = nearer - part2;
    precise Real rest = (((near - nearer) - part) + ((nearer - r) - part2)) - k * REAL(2.8960739513993194e-13);
    precise Real sum = r + rest;
    low = rest - (sum - r);
    quadrant = int(isnan(x) ? 0.0 : k);
    return isinf(x) ? quietNaN() : abs(sum) > 1.0 ? 0.0 : sum;
}

/// sin x and cos x at once. 1.02 ULP up to |x| = 1e5.
FN void realSinCos(Real x, OUT(Real) sine, OUT(Real) cosine) {
    int quadrant;
    Real low;
    Real r = reduceQuadrant(x, low, quadrant);
    Real s = sinKernel(r, low);
    Real c = cosKernel(r, low);
    bool swap = (quadrant & 1) != 0;
    Real s1 = swap ? c : s;
    Real c1 = swap ? s : c;
    // A tiny x is its own sine; the reduction would lose the sign of -0.
    sine = abs(x) < REAL(2e-4) ? x : (quadrant & 2) != 0 ? -s1 : s1;
    cosine = ((quadrant + 1) & 2) != 0 ? -c1 : c1;
}

/// 1.02 ULP up to |x| = 1e5.
FN Real realSin(Real x) {
    Real sine, cosine;
    realSinCos(x, sine, cosine);
    return sine;
}

/// 1.02 ULP up to |x| = 1e5.
FN Real realCos(Real x) {
    Real sine, cosine;
    realSinCos(x, sine, cosine);
    return cosine;
}

/// 2.8 ULP up to |x| = 1e5.
FN Real realTan(Real x) {
    int quadrant;
    Real low;
    Real r = reduceQuadrant(x, low, quadrant);
    Real s = sinKernel(r, low);
    Real c = cosKernel(r, low);
    Real y = (quadrant & 1) != 0 ? -c / s : s / c;
    return abs(x) < REAL(2e-4) ? x : y;
}

/// sin(2 pi u) and cos(2 pi u): cheaper than realSinCos, and exact in its reduction for every u. What
/// azimuths of samples want. Multiples of a quarter turn give exactly 0 and +-1. 1.67 ULP.
FN void sinCosTurns(Real u, OUT(Real) sine, OUT(Real) cosine) {
    Real t = u - roundEven(u);
    Real k = roundEven(t * 4.0);
    Real r = t - k * 0.25;
    Real z = r * r;
    Real p = REAL(-41.3416748) + z * (REAL(81.5942307) + z * REAL(-75.465744));
    // 2 pi = 6.28125 + 0.00193530717...: the first has 8 bits.
    precise Real s = r * 6.28125 + r * (REAL(0.00193530717958647693) + z * p);
    Real q = REAL(64.9391403) + z * (REAL(-85.4231186) + z * REAL(58.5611649));
    precise Real c = 1.0 - z * (REAL(19.7392082) - z * q);
    int quadrant = int(isnan(k) ? 0.0 : k);
    bool swap = (quadrant & 1) != 0;
    Real s1 = swap ? c : s;
    Real c1 = swap ? s : c;
    sine = (quadrant & 2) != 0 ? -s1 : s1;
    cosine = ((quadrant + 1) & 2) != 0 ? -c1 : c1;
}

/// asin(x) - x for |x| <= 1/2.
FN Real asinTail(Real x, Real z) {
    Real p = REAL(0.0422118045);
    p = p * z + REAL(0.0241520908);
    p = p * z + REAL(0.0454760417);
    p = p * z + REAL(0.0749525204);
    p = p * z + REAL(0.166667536);
    return x * (z * p);
}

/// Inverse sine in [-pi/2, pi/2]; NaN for |x| > 1. 1.32 ULP.
FN Real realAsin(Real x) {
    Real a = abs(x);
    bool outer = a > 0.5;
    // asin x = pi/2 - 2 asin(sqrt((1 - x) / 2))
    Real z = outer ? 0.5 * (1.0 - a) : a * a;
    Real t = outer ? sqrt(max(z, 0.0)) : a;
    Real tail = asinTail(t, z);
    // Half of pi/2 first: its difference from 2t is exact where it is small.
    precise Real turned = QUARTER_PI + ((QUARTER_PI - 2.0 * t) - (2.0 * tail + REAL(4.37113883e-08)));
    precise Real y = outer ? turned : t + tail;
    y = a > 1.0 ? quietNaN() : y;
    return isnan(x) ? x : multiplySign(y, x);
}

/// Inverse cosine in [0, pi]; NaN for |x| > 1. 1.16 ULP. Clamp a dot product of unit vectors first, or
/// better, use angleBetween of shaders/shared/vector.glsl.
FN Real realAcos(Real x) {
    Real a = abs(x);
    bool outer = a > 0.5;
    Real z = outer ? 0.5 * (1.0 - a) : x * x;
    Real t = outer ? sqrt(max(z, 0.0)) : x;
    Real tail = asinTail(t, z);
    // x > 1/2: 2 asin(sqrt((1-x)/2)); x < -1/2: pi minus that of -x; else pi/2 - asin x. pi/2 in two parts.
    precise Real near = 2.0 * (t + tail);
    precise Real far = PI - (near + REAL(8.74227766e-08));
    precise Real middle = HALF_PI - (t + (tail + REAL(4.37113883e-08)));
    Real y = outer ? (x > 0.0 ? near : far) : middle;
    y = a > 1.0 ? quietNaN() : y;
    return isnan(x) ? x : y;
}

/// atan(t) for 0 <= t <= 1.
FN Real atanKernel(Real t) {
    Real z = t * t;
    Real p = REAL(-0.00181335513);
    p = p * z + REAL(0.0109833414);
    p = p * z + REAL(-0.0312661119);
    p = p * z + REAL(0.0580040775);
    p = p * z + REAL(-0.0840374157);
    p = p * z + REAL(0.109515756);
    p = p * z + REAL(-0.142640442);
    p = p * z + REAL(0.199985296);
    p = p * z + REAL(-0.333332986);
    precise Real y = t + t * (z * p);
    return y;
}

/// Inverse tangent in [-pi/2, pi/2]. 1.53 ULP.
FN Real realAtan(Real x) {
    Real a = abs(x);
    bool outer = a > 1.0;
    Real y = atanKernel(outer ? 1.0 / a : a);
    precise Real turned = HALF_PI - (y + REAL(4.37113883e-08));
    y = outer ? turned : y;
    return isnan(x) ? x : multiplySign(y, x);
}

/// The angle of (x, y) from the x axis, in [-pi, pi], for every quadrant, zeros and infinities as in C: the
/// signs of zeros count, atan2(0, -0) = pi. 1.56 ULP in 2e7 random pairs.
FN Real realAtan2(Real y, Real x) {
    Real ax = abs(x);
    Real ay = abs(y);
    Real low = min(ax, ay);
    Real high = max(ax, ay);
    // Vulkan leaves quotients open where the divisor's inverse would be subnormal.
    Real scale = high > REAL(4e37) ? 0.25 : 1.0;
    Real t = isinf(low) ? 1.0 : high == 0.0 ? 0.0 : (low * scale) / (high * scale);
    Real a = atanKernel(t);
    precise Real steep = HALF_PI - (a + REAL(4.37113883e-08));
    a = ay > ax ? steep : a;
    precise Real left = PI - (a + REAL(8.74227766e-08));
    a = signBit(x) ? left : a;
    a = isnan(x) ? x : isnan(y) ? y : multiplySign(a, y);
    return a;
}

#endif
#endif
