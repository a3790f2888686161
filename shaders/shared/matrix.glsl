// Determinants, inverses and cofactors of 3x3 and 4x4 matrices by minors computed without cancellation, so
// that the error stays within a small multiple of the condition number even where cancellation is worst
// (Hilbert matrices). Product and transpose are the languages' own operators. Matrices are m[column][row].
#ifndef SHADERS_SHARED_MATRIX_GLSL
#define SHADERS_SHARED_MATRIX_GLSL
#include "shaders/shared/error_free.glsl"
#include "shaders/shared/real.glsl"

/// The matrix of cofactors: det(m) times the inverse transposed, there for singular m too. It takes normals
/// along with the tangents that m takes, scaled by the area's growth.
FN Mat3 cofactorMatrix(Mat3 m) {
    return Mat3(crossAccurate(m[1], m[2]), crossAccurate(m[2], m[0]), crossAccurate(m[0], m[1]));
}

FN Real determinantAccurate(Mat3 m) { return dotAccurate(m[0], crossAccurate(m[1], m[2])); }

/// The inverse; a singular matrix gives infinities or NaN. Relative error below 4 u kappa(m) in the Frobenius
/// norm.
FN Mat3 inverseAccurate(Mat3 m) {
    Mat3 c = cofactorMatrix(m);
    return transpose(c) * (1.0 / dotAccurate(m[0], c[0]));
}

/// a . b for a vector a of floats and b in two parts: with minors kept in twice the precision, what cancels
/// between them is not lost.
FN Real dotTwoParts(Vec3 a, Vec3 high, Vec3 low) {
    Real e0, e1, e2, s1, s2;
    Real p = twoProduct(a.x, high.x, e0);
    p = twoSum(p, twoProduct(a.y, high.y, e1), s1);
    p = twoSum(p, twoProduct(a.z, high.z, e2), s2);
    precise Real sum = p + ((((e0 + e1) + (e2 + s1)) + s2) + (a.x * low.x + a.y * low.y + a.z * low.z));
    return sum;
}

/// The cofactors of column a's entries in a matrix of columns a, b, c, d, up to the column's sign.
FN Vec4 cofactorColumn(Vec4 b, Vec4 c, Vec4 d) {
    // 2x2 minors of c and d, named by their rows, in two parts.
    Real l01, l02, l03, l12, l13, l23;
    Real m01 = differenceOfProducts(c.x, d.y, c.y, d.x, l01);
    Real m02 = differenceOfProducts(c.x, d.z, c.z, d.x, l02);
    Real m03 = differenceOfProducts(c.x, d.w, c.w, d.x, l03);
    Real m12 = differenceOfProducts(c.y, d.z, c.z, d.y, l12);
    Real m13 = differenceOfProducts(c.y, d.w, c.w, d.y, l13);
    Real m23 = differenceOfProducts(c.z, d.w, c.w, d.z, l23);
    return Vec4(dotTwoParts(Vec3(b.y, -b.z, b.w), Vec3(m23, m13, m12), Vec3(l23, l13, l12)),
                dotTwoParts(Vec3(-b.x, b.z, -b.w), Vec3(m23, m03, m02), Vec3(l23, l03, l02)),
                dotTwoParts(Vec3(b.x, -b.y, b.w), Vec3(m13, m03, m01), Vec3(l13, l03, l01)),
                dotTwoParts(Vec3(-b.x, b.y, -b.z), Vec3(m12, m02, m01), Vec3(l12, l02, l01)));
}

FN Mat4 cofactorMatrix(Mat4 m) {
    return Mat4(cofactorColumn(m[1], m[2], m[3]), -cofactorColumn(m[0], m[2], m[3]),
                cofactorColumn(m[0], m[1], m[3]), -cofactorColumn(m[0], m[1], m[2]));
}

FN Real determinantAccurate(Mat4 m) {
    Vec4 c = cofactorColumn(m[1], m[2], m[3]);
    Real error;
    Real last = twoProduct(m[0].w, c.w, error);
    precise Real sum = dotAccurate(Vec3(m[0]), Vec3(c)) + last;
    return sum + error;
}

/// The inverse; a singular matrix gives infinities or NaN. For affine matrices inverseAffine is cheaper.
FN Mat4 inverseAccurate(Mat4 m) {
    Mat4 c = cofactorMatrix(m);
    Real error;
    Real last = twoProduct(m[0].w, c[0].w, error);
    precise Real det = (dotAccurate(Vec3(m[0]), Vec3(c[0])) + last) + error;
    return transpose(c) * (1.0 / det);
}

#endif
