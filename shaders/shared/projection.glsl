// Projections. Two families:
//   The lecture's (cube...): camera space to the cube [-1, 1]^3, y up, near plane to z = +1 and far to -1, with n and
//   f the planes' z coordinates, 0 > n > f. They are built as the lecture builds them and serve teaching and tests.
//   The engine's: Vulkan clip space, x right, y DOWN, z in [0, 1], w > 0 in front. Cameras look along -z; near and far
//   are distances, 0 < near < far. Depth is REVERSED by default: 1 at the near plane, 0 at infinity, which spends a
//   float's precision evenly over distance; depth tests keep the greater.
#ifndef SHADERS_SHARED_PROJECTION_GLSL
#define SHADERS_SHARED_PROJECTION_GLSL
#include "shaders/shared/real.glsl"
#include "shaders/shared/trigonometry.glsl"

/// [l, r] x [b, t] x [f, n] to [-1, 1]^3: centre to 0, then scale. (The lecture's printed translation repeats
/// a row.)
FN Mat4 cubeOrthographic(Real l, Real r, Real b, Real t, Real n, Real f) {
    return Mat4(2.0 / (r - l), 0.0, 0.0, 0.0,  //
                0.0, 2.0 / (t - b), 0.0, 0.0,  //
                0.0, 0.0, 2.0 / (n - f), 0.0,  //
                -((r + l) / (r - l)), -((t + b) / (t - b)), -((n + f) / (n - f)), 1.0);
}

/// Squeezes the frustum into the box of its near plane: (x, y, z) -> (n x / z, n y / z, n + f - n f / z).
/// Planes n and f stay, what lies between moves towards f. w = z, which is negative in front.
FN Mat4 cubeSquish(Real n, Real f) {
    return Mat4(n, 0.0, 0.0, 0.0,  //
                0.0, n, 0.0, 0.0,  //
                0.0, 0.0, n + f, 1.0,  //
                0.0, 0.0, -n * f, 0.0);
}

/// M_persp = M_ortho M_squish written out, with 2n/(r-l) where the lecture prints 2n/(l+r). w = z as above.
FN Mat4 cubePerspective(Real l, Real r, Real b, Real t, Real n, Real f) {
    return Mat4(2.0 * n / (r - l), 0.0, 0.0, 0.0,  //
                0.0, 2.0 * n / (t - b), 0.0, 0.0,  //
                (l + r) / (l - r), (b + t) / (b - t), (n + f) / (n - f), 1.0,  //
                0.0, 0.0, -2.0 * n * f / (n - f), 0.0);
}

/// The near plane's half extents from the vertical field of view, width over height, and the distance:
/// tan(fovY / 2) = top / near, aspect = right / top.
FN Vec2 frustumExtents(Real fovY, Real aspect, Real near) {
    Real top = near * realTan(0.5 * fovY);
    return Vec2(aspect * top, top);
}
/// The angle that an extent (a sensor's height, say) subtends centred at a distance (the focal length).
FN Real fieldOfView(Real extent, Real atDistance) { return 2.0 * realAtan2(0.5 * extent, atDistance); }

/// Orthographic to Vulkan clip space, near to depth 1 and far to 0.
FN Mat4 orthographic(Real l, Real r, Real b, Real t, Real near, Real far) {
    return Mat4(2.0 / (r - l), 0.0, 0.0, 0.0,  //
                0.0, -2.0 / (t - b), 0.0, 0.0,  //
                0.0, 0.0, 1.0 / (far - near), 0.0,  //
                -((r + l) / (r - l)), (t + b) / (t - b), far / (far - near), 1.0);
}
/// The same with near to depth 0 and far to 1.
FN Mat4 orthographicForwardZ(Real l, Real r, Real b, Real t, Real near, Real far) {
    return Mat4(2.0 / (r - l), 0.0, 0.0, 0.0,  //
                0.0, -2.0 / (t - b), 0.0, 0.0,  //
                0.0, 0.0, -1.0 / (far - near), 0.0,  //
                -((r + l) / (r - l)), (t + b) / (t - b), -near / (far - near), 1.0);
}

/// Through the window [l, r] x [b, t] of the near plane, reversed depth, no far plane: depth = near /
/// distance.
FN Mat4 frustumInfinite(Real l, Real r, Real b, Real t, Real near) {
    return Mat4(2.0 * near / (r - l), 0.0, 0.0, 0.0,  //
                0.0, -2.0 * near / (t - b), 0.0, 0.0,  //
                (r + l) / (r - l), -((t + b) / (t - b)), 0.0, -1.0,  //
                0.0, 0.0, near, 0.0);
}
/// The same with a far plane at depth 0.
FN Mat4 frustum(Real l, Real r, Real b, Real t, Real near, Real far) {
    Mat4 m = frustumInfinite(l, r, b, t, near);
    m[2].z = near / (far - near);
    m[3].z = near * far / (far - near);
    return m;
}
/// The same with near to depth 0 and far to 1.
FN Mat4 frustumForwardZ(Real l, Real r, Real b, Real t, Real near, Real far) {
    Mat4 m = frustumInfinite(l, r, b, t, near);
    m[2].z = -far / (far - near);
    m[3].z = -near * far / (far - near);
    return m;
}

/// The engine's default camera: vertical field of view, width over height, reversed depth, no far plane.
FN Mat4 perspective(Real fovY, Real aspect, Real near) {
    Real focal = 1.0 / realTan(0.5 * fovY);
    return Mat4(focal / aspect, 0.0, 0.0, 0.0,  //
                0.0, -focal, 0.0, 0.0,  //
                0.0, 0.0, 0.0, -1.0,  //
                0.0, 0.0, near, 0.0);
}
/// The same with a far plane at depth 0.
FN Mat4 perspectiveFinite(Real fovY, Real aspect, Real near, Real far) {
    Mat4 m = perspective(fovY, aspect, near);
    m[2].z = near / (far - near);
    m[3].z = near * far / (far - near);
    return m;
}

/// Distance along -z of a depth of `perspective`; 0 is infinitely far.
FN Real viewDistance(Real depth, Real near) { return near / depth; }

// Viewport: normalised device coordinates to pixels, x right and y down from the top left corner, the centre
// of pixel (i, j) at (i + 0.5, j + 0.5). z is left as it is.

FN Vec2 viewportPoint(Vec2 ndc, Vec2 size) {
    return Vec2((ndc.x + 1.0) * 0.5 * size.x, (ndc.y + 1.0) * 0.5 * size.y);
}
FN Vec2 viewportInverse(Vec2 pixel, Vec2 size) {
    return Vec2(pixel.x / size.x * 2.0 - 1.0, pixel.y / size.y * 2.0 - 1.0);
}
/// For the engine's clip space, whose y points down already.
FN Mat4 viewport(Vec2 size) {
    return Mat4(0.5 * size.x, 0.0, 0.0, 0.0,  //
                0.0, 0.5 * size.y, 0.0, 0.0,  //
                0.0, 0.0, 1.0, 0.0,  //
                0.5 * size.x, 0.5 * size.y, 0.0, 1.0);
}
/// For the cube's y up: turns it over.
FN Mat4 cubeViewport(Vec2 size) {
    return Mat4(0.5 * size.x, 0.0, 0.0, 0.0,  //
                0.0, -0.5 * size.y, 0.0, 0.0,  //
                0.0, 0.0, 1.0, 0.0,  //
                0.5 * size.x, 0.5 * size.y, 0.0, 1.0);
}

#endif
