// Vectors: lengths and directions that neither overflow nor underflow, angles, bases, sides.
#ifndef SHADERS_SHARED_VECTOR_GLSL
#define SHADERS_SHARED_VECTOR_GLSL
#include "shaders/shared/error_free.glsl"
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/trigonometry.glsl"

FN Real maxComponent(Vec2 v) { return max(v.x, v.y); }
FN Real maxComponent(Vec3 v) { return max(max(v.x, v.y), v.z); }
FN Real maxComponent(Vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }
FN Real minComponent(Vec3 v) { return min(min(v.x, v.y), v.z); }
FN Real lengthSquared(Vec2 v) { return v.x * v.x + v.y * v.y; }
FN Real lengthSquared(Vec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

/// |v| for every finite v: the squares neither overflow nor underflow. 2 ULP.
FN Real lengthSafe(Vec2 v) {
    Real scale = powerOfTwoBelow(maxComponent(abs(v)));
    Vec2 u = v * (1.0 / scale);
    return scale * sqrt(lengthSquared(u));
}
FN Real lengthSafe(Vec3 v) {
    Real scale = powerOfTwoBelow(maxComponent(abs(v)));
    Vec3 u = v * (1.0 / scale);
    return scale * sqrt(lengthSquared(u));
}

/// sqrt(x^2 + y^2) without overflow or underflow.
FN Real hypot(Real x, Real y) { return lengthSafe(Vec2(x, y)); }

/// v / |v| for every finite v; `fallback` where v is 0. Length 1 to 2 ULP for normal numbers.
FN Vec3 normalizeSafe(Vec3 v, Vec3 fallback) {
    Vec3 u = v * (1.0 / powerOfTwoBelow(maxComponent(abs(v))));
    Real squared = lengthSquared(u);
    return squared > 0.0 ? u * (1.0 / sqrt(squared)) : fallback;
}
FN Vec2 normalizeSafe(Vec2 v, Vec2 fallback) {
    Vec2 u = v * (1.0 / powerOfTwoBelow(maxComponent(abs(v))));
    Real squared = lengthSquared(u);
    return squared > 0.0 ? u * (1.0 / sqrt(squared)) : fallback;
}

/// The angle between two vectors of any length, in [0, pi], accurate at both ends (Kahan): half of it has the
/// tangent |a/|a| - b/|b|| / |a/|a| + b/|b||.
FN Real angleBetween(Vec3 a, Vec3 b) {
    Vec3 u = normalizeSafe(a, Vec3(0.0));
    Vec3 v = normalizeSafe(b, Vec3(0.0));
    return 2.0 * realAtan2(lengthSafe(u - v), lengthSafe(u + v));
}

/// a's part along b, and the rest. b of any length; along a zero b there is nothing.
FN Vec3 projectOnto(Vec3 a, Vec3 b) {
    Vec3 direction = normalizeSafe(b, Vec3(0.0));
    return direction * dot(a, direction);
}
FN Vec3 rejectFrom(Vec3 a, Vec3 b) { return a - projectOnto(a, b); }

/// The z component of a x b: positive where b is to the left (counter-clockwise) of a, negative to the right.
/// The sign is right and the value within 2 ULP even for nearly parallel vectors.
FN Real cross2(Vec2 a, Vec2 b) { return differenceOfProducts(a.x, b.y, a.y, b.x); }

/// 1 where p is to the left of the line from a to b (y up), -1 to the right, 0 on it. Exact for coordinates
/// whose differences are exact, e.g. a grid of 2^-8 within 2^15.
FN int sideOfLine(Vec2 a, Vec2 b, Vec2 p) {
    Real area = cross2(b - a, p - a);
    return area > 0.0 ? 1 : area < 0.0 ? -1 : 0;
}

/// True where p is in the triangle or on its edge, whichever way round it is. A degenerate triangle contains
/// what lies on its line between its ends; no pixel rule is applied here (see the rasterizer's top-left
/// rule).
FN bool insideTriangle(Vec2 a, Vec2 b, Vec2 c, Vec2 p) {
    int ab = sideOfLine(a, b, p);
    int bc = sideOfLine(b, c, p);
    int ca = sideOfLine(c, a, p);
    bool oneSide = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    // On the line of a degenerate triangle every side is 0: the bounds decide.
    Vec2 low = min(min(a, b), c);
    Vec2 high = max(max(a, b), c);
    return oneSide && p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
}

/// Two unit vectors that make a right-handed orthonormal basis (tangent, bitangent, normal) with a unit
/// normal, continuous but at z = 0 (Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017).
FN void orthonormalBasis(Vec3 normal, OUT(Vec3) tangent, OUT(Vec3) bitangent) {
    Real s = normal.z < 0.0 ? -1.0 : 1.0;
    Real a = -1.0 / (s + normal.z);
    Real b = normal.x * normal.y * a;
    tangent = Vec3(1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x);
    bitangent = Vec3(b, s + normal.y * normal.y * a, -normal.y);
}

/// A unit vector at right angles to v (unit or not): v crossed with the axis it is least along.
FN Vec3 anyPerpendicular(Vec3 v) {
    Vec3 a = abs(v);
    Vec3 axis = a.x <= a.y && a.x <= a.z ? Vec3(1.0, 0.0, 0.0)
                : a.y <= a.z             ? Vec3(0.0, 1.0, 0.0)
                                         : Vec3(0.0, 0.0, 1.0);
    return normalizeSafe(cross(v, axis), Vec3(1.0, 0.0, 0.0));
}

#endif
