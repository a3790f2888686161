// Rotations in 3D: about the axes, Euler angles, axis and angle (Rodrigues), unit quaternions. Right-handed:
// a positive angle turns counter-clockwise seen against the axis. Matrices act on columns, v' = M v. Angles
// are radians.
#ifndef SHADERS_SHARED_ROTATION_GLSL
#define SHADERS_SHARED_ROTATION_GLSL
#include "shaders/shared/real.glsl"
#include "shaders/shared/trigonometry.glsl"
#include "shaders/shared/vector.glsl"

FN Mat3 rotationX(Real angle) {
    Real s, c;
    realSinCos(angle, s, c);
    return Mat3(1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c);
}
FN Mat3 rotationY(Real angle) {
    Real s, c;
    realSinCos(angle, s, c);
    return Mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c);
}
FN Mat3 rotationZ(Real angle) {
    Real s, c;
    realSinCos(angle, s, c);
    return Mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
}

/// Rx(a) Ry(b) Rz(c): z is applied first.
FN Mat3 rotationEuler(Vec3 angles) { return rotationX(angles.x) * rotationY(angles.y) * rotationZ(angles.z); }

/// Angles with rotationEuler(angles) = r, b in [-pi/2, pi/2]. In gimbal lock (b = +-pi/2), where only a +- c
/// counts, any split that gives r back: c is found after a is undone, so it takes what a left.
FN Vec3 eulerAngles(Mat3 r) {
    // Rows: (cos b cos c, -cos b sin c, sin b), (.., .., -sin a cos b), (.., .., cos a cos b).
    Real a = realAtan2(-r[2].y, r[2].z);
    Real b = realAtan2(r[2].x, hypot(r[0].x, r[1].x));
    Real s, c;
    realSinCos(a, s, c);
    // Row 1 of Rx(-a) R = Ry(b) Rz(c) is (sin c, cos c, 0).
    return Vec3(a, b, realAtan2(c * r[0].y + s * r[0].z, c * r[1].y + s * r[1].z));
}

/// The matrix N of the cross product: N v = n x v.
FN Mat3 crossMatrix(Vec3 n) { return Mat3(0.0, n.z, -n.y, -n.z, 0.0, n.x, n.y, -n.x, 0.0); }

/// A vector of length 1 +- 1e-6 made unit to the rounding of its components, by one step of Newton's
/// iteration with the length's error computed exactly.
FN Vec4 unitAccurate(Vec4 v) {
    Real e0, e1, e2, e3;
    precise Real excess = twoProduct(v.x, v.x, e0) - 1.0;
    excess = ((excess + twoProduct(v.y, v.y, e1)) + twoProduct(v.z, v.z, e2)) + twoProduct(v.w, v.w, e3);
    excess = excess + ((e0 + e1) + (e2 + e3));
    return v - v * (0.5 * excess);
}
FN Vec3 unitAccurate(Vec3 v) {
    bool zero = lengthSquared(v) == 0.0;
    Vec4 u = unitAccurate(Vec4(v, 0.0));
    return zero ? v : Vec3(u);
}

/// Rodrigues: R = cos(angle) I + (1 - cos(angle)) n n^T + sin(angle) N, n the axis normalised; the axis (0,
/// 0, 0) gives the identity. (The lecture's printed formula closes its bracket too late.)
FN Mat3 rotationAbout(Vec3 axis, Real angle) {
    Vec3 n = unitAccurate(normalizeSafe(axis, Vec3(0.0)));
    Real s, c, sHalf, cHalf;
    Real turn = lengthSquared(n) > 0.0 ? angle : 0.0;
    realSinCos(turn, s, c);
    realSinCos(0.5 * turn, sHalf, cHalf);
    Real versine = 2.0 * sHalf * sHalf;  // 1 - cos without cancellation
    // cos + versine x^2 = 1 - versine (y^2 + z^2): by whichever square is the lesser, which carries the
    // lesser error.
    Vec3 q = n * n;
    Vec3 diagonal = Vec3(q.x < 0.5 ? c + versine * q.x : 1.0 - versine * (q.y + q.z),
                         q.y < 0.5 ? c + versine * q.y : 1.0 - versine * (q.x + q.z),
                         q.z < 0.5 ? c + versine * q.z : 1.0 - versine * (q.x + q.y));
    Vec3 sym = Vec3(n.y * n.z, n.x * n.z, n.x * n.y) * versine;
    Vec3 skew = n * s;
    return Mat3(diagonal.x, sym.z + skew.z, sym.y - skew.y, sym.z - skew.z, diagonal.y, sym.x + skew.x,
                sym.y + skew.y, sym.x - skew.x, diagonal.z);
}

// Quaternions are Vec4(x, y, z, w), w the real part, as in glTF.

CONST Vec4 QUATERNION_IDENTITY = Vec4(0.0, 0.0, 0.0, 1.0);

/// a b: the rotation b followed by a.
FN Vec4 quaternionProduct(Vec4 a, Vec4 b) {
    Vec3 u = Vec3(a);
    Vec3 v = Vec3(b);
    return Vec4(a.w * v + b.w * u + cross(u, v), a.w * b.w - dot(u, v));
}

FN Vec4 quaternionConjugate(Vec4 q) { return Vec4(-q.x, -q.y, -q.z, q.w); }

/// The unit quaternion along q; the identity where q is 0.
FN Vec4 quaternionNormalize(Vec4 q) {
    Vec4 u = q * (1.0 / powerOfTwoBelow(maxComponent(abs(q))));
    Real squared = u.x * u.x + u.y * u.y + u.z * u.z + u.w * u.w;
    return squared > 0.0 ? unitAccurate(u * (1.0 / sqrt(squared))) : QUATERNION_IDENTITY;
}

/// Of the rotation about an axis of any length; the axis (0, 0, 0) gives the identity.
FN Vec4 quaternionAbout(Vec3 axis, Real angle) {
    Real s, c;
    realSinCos(0.5 * angle, s, c);
    Vec3 n = normalizeSafe(axis, Vec3(0.0));
    return quaternionNormalize(lengthSquared(n) > 0.0 ? Vec4(n * s, c) : QUATERNION_IDENTITY);
}

/// v turned by the unit quaternion q.
FN Vec3 quaternionRotate(Vec4 q, Vec3 v) {
    Vec3 u = Vec3(q);
    Vec3 t = 2.0 * cross(u, v);
    return v + q.w * t + cross(u, t);
}

/// The rotation matrix of a unit quaternion.
FN Mat3 quaternionToMatrix(Vec4 q) {
    Vec4 u = q + q;
    Real xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, ww = q.w * q.w;
    Real xy = u.x * q.y, xz = u.x * q.z, yz = u.y * q.z;
    Real xw = u.x * q.w, yw = u.y * q.w, zw = u.z * q.w;
    return Mat3((ww + xx) - (yy + zz), xy + zw, xz - yw,  //
                xy - zw, (ww + yy) - (xx + zz), yz + xw,  //
                xz + yw, yz - xw, (ww + zz) - (xx + yy));
}

/// The unit quaternion of a rotation matrix and w >= 0: by the largest of the four
/// components, so nothing cancels (Shepperd 1978).
FN Vec4 quaternionFromMatrix(Mat3 m) {
    Real xx = m[0].x, yy = m[1].y, zz = m[2].z;
    // Four times the square of each component.
    Vec4 squares = Vec4(1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz, 1.0 + xx + yy + zz);
    Vec3 sums = Vec3(m[1].z + m[2].y, m[2].x + m[0].z, m[0].y + m[1].x);
    Vec3 differences = Vec3(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
    Vec4 q = Vec4(differences, squares.w);
    Real best = squares.w;
    q = squares.z > best ? Vec4(sums.y, sums.x, squares.z, differences.z) : q;
    best = max(best, squares.z);
    q = squares.y > best ? Vec4(sums.z, squares.y, sums.x, differences.y) : q;
    best = max(best, squares.y);
    q = squares.x > best ? Vec4(squares.x, sums.z, sums.y, differences.x) : q;
    q = quaternionNormalize(q);
    return q.w < 0.0 ? -q : q;
}

/// Axis and angle of a unit quaternion, the angle in [0, pi]; the axis of no rotation is x.
FN void quaternionAxisAngle(Vec4 q, OUT(Vec3) axis, OUT(Real) angle) {
    Vec3 v = q.w < 0.0 ? -Vec3(q) : Vec3(q);
    axis = normalizeSafe(v, Vec3(1.0, 0.0, 0.0));
    angle = 2.0 * realAtan2(lengthSafe(v), abs(q.w));
}

/// Between two unit quaternions along the shorter great circle at constant speed, t in [0, 1].
FN Vec4 quaternionSlerp(Vec4 a, Vec4 b, Real t) {
    Vec4 near = dot(a, b) < 0.0 ? -b : b;
    // The angle by its half's tangent, accurate for close quaternions too.
    Vec4 d = near - a;
    Vec4 s = near + a;
    Real angle = 2.0 * realAtan2(sqrt(dot(d, d)), sqrt(dot(s, s)));
    Real sine = realSin(angle);
    bool close = angle < REAL(1e-3);
    Real wa = close ? 1.0 - t : realSin((1.0 - t) * angle) / sine;
    Real wb = close ? t : realSin(t * angle) / sine;
    return quaternionNormalize(a * wa + near * wb);
}

#endif
