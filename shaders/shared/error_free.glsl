// Sums and products with the error they make, and what is built on them: a b - c d, quadratic equations. By
// splitting (Veltkamp, Dekker 1971), not by fma, which only some devices fuse. Exact while nothing overflows
// and no product's low half falls below the normal range: factors between about 1e-15 and 1e18 are always
// safe.
#ifndef SHADERS_SHARED_ERROR_FREE_GLSL
#define SHADERS_SHARED_ERROR_FREE_GLSL
#include "shaders/shared/real.glsl"

#if PRECISION_BITS == 32
CONST Real SPLITTER = 4097.0;  // 2^12 + 1
#else
CONST Real SPLITTER = REAL(134217729.0);  // 2^27 + 1
#endif

/// a + b = sum + error exactly (Knuth).
FN Real twoSum(Real a, Real b, OUT(Real) error) {
    precise Real sum = a + b;
    precise Real kept = sum - a;
    precise Real e = (a - (sum - kept)) + (b - kept);
    error = e;
    return sum;
}

/// The same for |a| >= |b| (Dekker).
FN Real fastTwoSum(Real a, Real b, OUT(Real) error) {
    precise Real sum = a + b;
    precise Real e = b - (sum - a);
    error = e;
    return sum;
}

/// a b = product + error exactly.
FN Real twoProduct(Real a, Real b, OUT(Real) error) {
    precise Real product = a * b;
    precise Real aScaled = SPLITTER * a;
    precise Real aHigh = aScaled - (aScaled - a);
    precise Real aLow = a - aHigh;
    precise Real bScaled = SPLITTER * b;
    precise Real bHigh = bScaled - (bScaled - b);
    precise Real bLow = b - bHigh;
    precise Real e = ((aHigh * bHigh - product) + aHigh * bLow + aLow * bHigh) + aLow * bLow;
    error = e;
    return product;
}

/// a b + c d in two parts, each the rounding of what is left: as if in twice the precision.
FN Real sumOfProducts(Real a, Real b, Real c, Real d, OUT(Real) low) {
    Real abError, cdError, sumError;
    Real ab = twoProduct(a, b, abError);
    Real cd = twoProduct(c, d, cdError);
    Real sum = twoSum(ab, cd, sumError);
    precise Real rest = (abError + cdError) + sumError;
    return fastTwoSum(sum, rest, low);
}

/// a b + c d to 0.51 ULP of the exact result however much cancels.
FN Real sumOfProducts(Real a, Real b, Real c, Real d) {
    Real low;
    return sumOfProducts(a, b, c, d, low);
}

/// a b - c d likewise, in two parts and in one.
FN Real differenceOfProducts(Real a, Real b, Real c, Real d, OUT(Real) low) {
    return sumOfProducts(a, b, -c, d, low);
}
FN Real differenceOfProducts(Real a, Real b, Real c, Real d) { return sumOfProducts(a, b, -c, d); }

/// a0 b0 + a1 b1 + a2 b2 as if in twice the precision, rounded once (Ogita, Rump & Oishi 2005, Dot2).
FN Real dotAccurate(Vec3 a, Vec3 b) {
    Real e0, e1, e2, s1, s2;
    Real p = twoProduct(a.x, b.x, e0);
    p = twoSum(p, twoProduct(a.y, b.y, e1), s1);
    p = twoSum(p, twoProduct(a.z, b.z, e2), s2);
    precise Real sum = p + (((e0 + e1) + (e2 + s1)) + s2);
    return sum;
}

/// cross(a, b), each component to 0.51 ULP.
FN Vec3 crossAccurate(Vec3 a, Vec3 b) {
    return Vec3(differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
                differenceOfProducts(a.x, b.y, a.y, b.x));
}

/// Real solutions of a x^2 + b x + c = 0, low <= high, to a few ULP: the discriminant is computed without
/// cancellation, and each root by the form whose terms have one sign. Returns how many (a double root counts
/// twice); a = 0 gives the linear equation's one root in both; 0 = 0 and impossible equations give none.
/// Coefficients' magnitudes between 1e-15 and 1e18, or 0.
FN int solveQuadratic(Real a, Real b, Real c, OUT(Real) low, OUT(Real) high) {
    Real discriminant = differenceOfProducts(b, b, 4.0 * a, c);
    Real root = sqrt(max(discriminant, 0.0));
    Real q = -0.5 * (b + (b < 0.0 ? -root : root));
    // q = 0 only if b = 0 and a c = 0: then every root is 0.
    Real first = a == 0.0 ? -c / b : q / a;
    Real second = a == 0.0 ? first : q == 0.0 ? 0.0 : c / q;
    low = min(first, second);
    high = max(first, second);
    bool linear = a == 0.0;
    return linear ? (b == 0.0 ? 0 : 1) : (discriminant < 0.0 ? 0 : 2);
}

#endif
