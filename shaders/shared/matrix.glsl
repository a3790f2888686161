// Determinants, inverses and cofactors of 3x3 and 4x4 matrices by minors computed without cancellation, so that the
// error stays within a small multiple of the condition number even where cancellation is worst (Hilbert matrices).
// Product and transpose are the languages' own operators. Matrices are m[column][row].
#ifndef SHADERS_SHARED_MATRIX_GLSL
#define SHADERS_SHARED_MATRIX_GLSL
#include "shaders/shared/error_free.glsl"
#include "shaders/shared/real.glsl"

/// a0 b0 + a1 b1 + a2 b2 as if in twice the precision, rounded once (Ogita, Rump & Oishi 2005, Dot2).
FN Real dotAccurate(Vec3 a, Vec3 b) {
    Real e0, e1, e2, s1, s2;
    Real p = twoProduct(a.x, b.x, e0);
    p = twoSum(p, twoProduct(a.y, b.y, e1), s1);
    p = twoSum(p, twoProduct(a.z, b.z, e2), s2);
    precise Real sum = p + (((e0 + e1) + (e2 + s1)) + s2);
    return sum;
}

/// The matrix of cofactors: det(m) times the inverse transposed, there for singular m too. It takes normals along
/// with the tangents that m takes, scaled by the area's growth.
FN Mat3 cofactorMatrix(Mat3 m) {
    return Mat3(crossAccurate(m[1], m[2]), crossAccurate(m[2], m[0]), crossAccurate(m[0], m[1]));
}

FN Real determinantAccurate(Mat3 m) { return dotAccurate(m[0], crossAccurate(m[1], m[2])); }

/// The inverse; a singular matrix gives infinities or NaN. Relative error below 4 u kappa(m) in the Frobenius norm.
FN Mat3 inverseAccurate(Mat3 m) {
    Mat3 c = cofactorMatrix(m);
    return transpose(c) * (1.0 / dotAccurate(m[0], c[0]));
}

/// The 2x2 minors of columns 2 and 3 (i, j: rows), as the 3x3 minors below need them.
FN Real minor2(Vec4 a, Vec4 b, int i, int j) { return differenceOfProducts(a[i], b[j], a[j], b[i]); }

/// The cofactors of column `a`'s entries in a matrix whose other columns are b, c, d, up to the column's sign.
FN Vec4 cofactorColumn(Vec4 b, Vec4 c, Vec4 d) {
    Real m01 = minor2(c, d, 0, 1);
    Real m02 = minor2(c, d, 0, 2);
    Real m03 = minor2(c, d, 0, 3);
    Real m12 = minor2(c, d, 1, 2);
    Real m13 = minor2(c, d, 1, 3);
    Real m23 = minor2(c, d, 2, 3);
    return Vec4(dotAccurate(Vec3(b.y, -b.z, b.w), Vec3(m23, m13, m12)),
                -dotAccurate(Vec3(b.x, -b.z, b.w), Vec3(m23, m03, m02)),
                dotAccurate(Vec3(b.x, -b.y, b.w), Vec3(m13, m03, m01)),
                -dotAccurate(Vec3(b.x, -b.y, b.z), Vec3(m12, m02, m01)));
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
