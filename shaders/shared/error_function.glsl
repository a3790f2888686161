// The error function and its inverse (quantiles of the normal distribution), and the cube root, from minimax
// fits as in exponential.glsl.
#ifndef SHADERS_SHARED_ERROR_FUNCTION_GLSL
#define SHADERS_SHARED_ERROR_FUNCTION_GLSL
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"

#if PRECISION_BITS == 32  // the double build has its own, in engine/core/shared_double.inc

/// erf(x) = 2 / sqrt(pi) times the integral of exp(-t^2) from 0 to x. 1.32 ULP.
FN Real realErf(Real x) {
    Real a = abs(x);
    Real z = min(a, 1.0) * min(a, 1.0);
    Real p = REAL(7.80690389e-05);
    p = p * z + REAL(-0.00079978531);
    p = p * z + REAL(0.0051871622);
    p = p * z + REAL(-0.0268533472);
    p = p * z + REAL(0.112835787);
    p = p * z + REAL(-0.37612626);
    p = p * z + REAL(0.128379166);
    // log(1 - erf) beyond 1; from 4 on erf rounds to 1.
    Real t = min(a, 4.0) - 1.0;
    Real q = REAL(0.000107738197);
    q = q * t + REAL(-0.00033344666);
    q = q * t + REAL(-0.000892850163);
    q = q * t + REAL(0.00910323765);
    q = q * t + REAL(-0.041178979);
    q = q * t + REAL(-0.843177199);
    q = q * t + REAL(-2.63896298);
    q = q * t + REAL(-1.84960556);
    precise Real y = a < 1.0 ? x + x * p : multiplySign(1.0 - realExp(q), x);
    return isnan(x) ? x : y;
}

/// The inverse: erf(realErfInverse(y)) = y for |y| < 1; +-1 give infinities, beyond is NaN. 2.92 ULP. As y
/// times a function of w = -log(1 - y^2), in which it is smooth up to the ends (Giles 2011, "Approximating
/// the erfinv function"). The standard normal distribution's quantile of u is sqrt(2) realErfInverse(2 u -
/// 1).
FN Real realErfInverse(Real y) {
    Real a = abs(y);
    Real w = -realLog((1.0 - min(a, REAL(0.99999994))) * (1.0 + min(a, REAL(0.99999994))));
    Real t = w - 2.5;
    Real p = REAL(3.35524108e-10);
    p = p * t + REAL(-8.77281714e-09);
    p = p * t + REAL(1.8037472e-08);
    p = p * t + REAL(4.65892015e-07);
    p = p * t + REAL(-3.43461329e-06);
    p = p * t + REAL(-4.9619116e-06);
    p = p * t + REAL(0.000218282628);
    p = p * t + REAL(-0.0012527447);
    p = p * t + REAL(-0.00417733938);
    p = p * t + REAL(0.246640295);
    // The last coefficient in two parts, since its rounding would show.
    precise Real central = 1.5 + (p * t + REAL(0.00140941));
    Real s = sqrt(max(w, 5.0)) - 3.0;
    Real q = REAL(-2.67742362e-05);
    q = q * s + REAL(0.000158982235);
    q = q * s + REAL(-0.000282310735);
    q = q * s + REAL(-0.000118035932);
    q = q * s + REAL(0.00147819857);
    q = q * s + REAL(-0.00356788095);
    q = q * s + REAL(0.00568687078);
    q = q * s + REAL(-0.00764266774);
    q = q * s + REAL(0.00944538042);
    q = q * s + REAL(1.00167525);
    precise Real tail = 2.75 + (q * s + REAL(0.08297682));
    Real x = y * (w < 5.0 ? central : tail);
    x = a == 1.0 ? multiplySign(infinity(), y) : x;
    return a > 1.0 ? quietNaN() : x;
}

/// The cube root, of negative numbers too. 0.96 ULP.
FN Real realCbrt(Real x) {
    // Small numbers times 2^30, so that the residual keeps its digits.
    bool small = abs(x) < REAL(1e-28);
    Real a = small ? abs(x) * 1073741824.0 : abs(x);
    // A third of the exponent, and of the fraction as if linear: within 4 %.
    Real t = uintBitsToFloat(floatBitsToUint(a) / 3u + 0x2a509a00u);
    // Halley's iteration, then Newton's: relative errors go 4e-2, 4e-5, 2e-9. The last is a small correction,
    // so that its rounding hardly matters.
    Real quotient = a / (t * t);
    t = t * ((t + 2.0 * quotient) / (2.0 * t + quotient));
    precise Real residual = a - t * t * t;
    precise Real y = t + residual / (3.0 * (t * t));
    y = small ? y * 0.0009765625 : y;
    y = a == 0.0 || isinf(x) || isnan(x) ? a : y;
    return multiplySign(y, x);
}

#endif
#endif
