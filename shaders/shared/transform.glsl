// Affine transforms: points and directions in homogeneous coordinates, 2D and 3D building blocks, composition
// (linear part first, then translation) and decomposition, views. The engine's world is right-handed; cameras
// look along their -Z with +Y up.
#ifndef SHADERS_SHARED_TRANSFORM_GLSL
#define SHADERS_SHARED_TRANSFORM_GLSL
#include "shaders/shared/matrix.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/rotation.glsl"
#include "shaders/shared/vector.glsl"

// Homogeneous coordinates. A point has w = 1 (any w != 0 stands for the same point), a vector w = 0: point -
// point is a vector, point + vector a point, and point + point, of w = 2, their midpoint.

FN Vec4 homogeneousPoint(Vec3 p) { return Vec4(p, 1.0); }
FN Vec4 homogeneousVector(Vec3 v) { return Vec4(v, 0.0); }
/// (x, y, z, w) -> (x/w, y/w, z/w). Divides each, which rounds once.
FN Vec3 divideByW(Vec4 p) { return Vec3(p.x / p.w, p.y / p.w, p.z / p.w); }
/// The same in the plane: (x, y, w) -> (x/w, y/w).
FN Vec2 divideByW(Vec3 p) { return Vec2(p.x / p.z, p.y / p.z); }

FN Vec3 transformPoint(Mat4 affine, Vec3 p) {
    return Vec3(affine[0]) * p.x + Vec3(affine[1]) * p.y + Vec3(affine[2]) * p.z + Vec3(affine[3]);
}
FN Vec3 transformVector(Mat4 affine, Vec3 v) {
    return Vec3(affine[0]) * v.x + Vec3(affine[1]) * v.y + Vec3(affine[2]) * v.z;
}
/// Through a projective matrix, divided by w.
FN Vec3 projectPoint(Mat4 m, Vec3 p) { return divideByW(m * Vec4(p, 1.0)); }

FN Mat3 linearPart(Mat4 affine) { return Mat3(Vec3(affine[0]), Vec3(affine[1]), Vec3(affine[2])); }

/// Takes normals: the inverse transposed, so that n . t = 0 stays. Results want normalising.
FN Mat3 normalMatrix(Mat3 linear) {
    Mat3 c = cofactorMatrix(linear);
    return c * (1.0 / dotAccurate(linear[0], c[0]));
}

// The plane, as homogeneous 3x3 matrices.

FN Mat3 translation2(Vec2 t) { return Mat3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, t.x, t.y, 1.0); }
FN Mat3 scaling2(Vec2 s) { return Mat3(s.x, 0.0, 0.0, 0.0, s.y, 0.0, 0.0, 0.0, 1.0); }
/// x' = x + a.x y, y' = y + a.y x.
FN Mat3 shearing2(Vec2 a) { return Mat3(1.0, a.y, 0.0, a.x, 1.0, 0.0, 0.0, 0.0, 1.0); }
/// Counter-clockwise with y up.
FN Mat3 rotation2(Real angle) {
    Real s, c;
    realSinCos(angle, s, c);
    return Mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
}

// Space, as homogeneous 4x4 matrices.

/// x' = linear x + t: the linear part first. A pure translation has the identity there.
FN Mat4 affineMatrix(Mat3 linear, Vec3 t) {
    return Mat4(Vec4(linear[0], 0.0), Vec4(linear[1], 0.0), Vec4(linear[2], 0.0), Vec4(t, 1.0));
}
FN Mat4 translation(Vec3 t) { return affineMatrix(Mat3(1.0), t); }
FN Mat4 scaling(Vec3 s) { return affineMatrix(Mat3(s.x, 0.0, 0.0, 0.0, s.y, 0.0, 0.0, 0.0, s.z), Vec3(0.0)); }

FN Mat4 inverseAffine(Mat4 m) {
    Mat3 inverted = inverseAccurate(linearPart(m));
    return affineMatrix(inverted, -(inverted * Vec3(m[3])));
}
/// Of a rotation and a translation: [R^T | -R^T t].
FN Mat4 inverseRigid(Mat4 m) {
    Mat3 inverted = transpose(linearPart(m));
    return affineMatrix(inverted, -(inverted * Vec3(m[3])));
}

/// An affine transform in parts, applied in this order: shear, scale, rotate, translate. The shear is unit
/// upper triangular: x' = x + shear.x y + shear.y z, y' = y + shear.z z. A mirroring is a negative scale.z.
struct AffineParts {
    Vec3 translation;
    Vec4 rotation;  // unit quaternion
    Vec3 scale;
    Vec3 shear;
};

FN Mat4 composeAffine(AffineParts p) {
    Mat3 r = quaternionToMatrix(p.rotation);
    Vec3 x = r[0] * p.scale.x;
    Vec3 y = r[1] * p.scale.y;
    Vec3 z = r[2] * p.scale.z;
    return affineMatrix(Mat3(x, y + x * p.shear.x, z + y * p.shear.z + x * p.shear.y), p.translation);
}

/// The parts of an invertible affine matrix, by orthogonalising its columns in order; twice, since once
/// leaves the rounding errors of nearly parallel columns. Without shear these are translation, rotation and
/// scale as in glTF.
FN AffineParts decomposeAffine(Mat4 m) {
    Vec3 a = Vec3(m[0]);
    Vec3 b = Vec3(m[1]);
    Vec3 c = Vec3(m[2]);
    Real sx = lengthSafe(a);
    Vec3 x = normalizeSafe(a, Vec3(1.0, 0.0, 0.0));
    Vec3 by = b - x * dot(x, b);
    by = by - x * dot(x, by);
    Real sy = lengthSafe(by);
    Vec3 y = normalizeSafe(by, anyPerpendicular(x));
    Vec3 z = cross(x, y);
    Real sz = dot(z, c);
    AffineParts p;
    p.translation = Vec3(m[3]);
    p.rotation = quaternionFromMatrix(Mat3(x, y, z));
    p.scale = Vec3(sx, sy, sz);
    // b = sy y + (shear.x sx) x and c = sz z + (shear.z sy) y + (shear.y sx) x.
    p.shear = Vec3(dot(x, b) / sx, dot(x, c) / sx, dot(y, c) / sy);
    return p;
}

// Views.

/// World to camera for a camera at `eye` gazing along `gaze` (any length), with `up` (any length, not along
/// the gaze) upwards: eye to 0, gaze to -z, up into the y-z plane. The basis is re-orthonormalised: x = gaze
/// x up, y = x x gaze (the lecture takes up as given, which is right only at right angles to the gaze). An up
/// along the gaze is replaced by the axis the gaze is least along, and a zero gaze by -z.
FN Mat4 viewMatrix(Vec3 eye, Vec3 gaze, Vec3 up) {
    Vec3 g = normalizeSafe(gaze, Vec3(0.0, 0.0, -1.0));
    Vec3 t = normalizeSafe(up, Vec3(0.0));
    Vec3 side = crossAccurate(g, t);
    // Both are rounded to u: below a few u the direction of their product is noise.
    bool along = lengthSquared(side) < REAL(1e-12);
    Vec3 x = along ? anyPerpendicular(g) : normalizeSafe(side, Vec3(1.0, 0.0, 0.0));
    Vec3 y = normalizeSafe(cross(x, g), Vec3(0.0, 1.0, 0.0));
    Vec3 z = -g;
    Mat3 r = transpose(Mat3(x, y, z));
    return affineMatrix(r, -(r * eye));
}

FN Mat4 lookAt(Vec3 eye, Vec3 target, Vec3 up) { return viewMatrix(eye, target - eye, up); }

#endif
