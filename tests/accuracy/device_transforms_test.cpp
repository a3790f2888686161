// Vectors, transforms and colour on the device against the same source in double, at the tolerances of their
// rows.
#include "tests/accuracy/device_check.hpp"
#include "tests/accuracy/transforms_support.hpp"

namespace {

using namespace helio;
using namespace helio::test;

constexpr int kCount = 200'000;

template <typename F>
auto many(F make, int count = kCount) {
    std::vector<decltype(make(0))> values;
    for (int i = 0; i < count; ++i) values.push_back(make(i));
    return values;
}

TEST(DeviceTransforms, Vectors) {
    Random random(201);
    const auto us = many([&](int) { return random.vector(); }),
               vs = many([&](int) { return random.vector(); });
    const auto near = many([&](int i) { return us[std::size_t(i)] * 3.f + random.vector() * 1e-6f; });
    DEVICE_CHECK(Vec3, 2.4e-7, (return cross(a, b);), us, vs);
    DEVICE_CHECK(Real, 2.4e-7, (return dot(a, b);), us, vs);
    DEVICE_CHECK_RELATIVE(Vec3, 1.2e-7, (return crossAccurate(a, b);), us, near);
    DEVICE_CHECK_RELATIVE(Real, 1.2e-7, (return differenceOfProducts(a.x, b.y, a.y, b.x);), us, near);
    DEVICE_CHECK(Real, 4e-7, (return angleBetween(a, b);), us, near);
    DEVICE_CHECK(Vec3, 5e-7, (return projectOnto(a, b);), us, vs);
    const auto n = many([&](int) { return random.direction(); });
    DEVICE_CHECK(Mat3, 6e-7, (Vec3 t; Vec3 s; orthonormalBasis(a, t, s); return Mat3(t, s, a);), n);
    const auto extreme = many([&](int) {
        return glm::vec3(random.magnitude(-120, 120), random.magnitude(-120, 120),
                         random.magnitude(-120, 120));
    });
    DEVICE_CHECK_RELATIVE(Real, 2.4e-7, (return lengthSafe(a);), extreme);
    DEVICE_CHECK(Vec3, 2.4e-7, (return normalizeSafe(a, Vec3(0.0));), extreme);
}

TEST(DeviceTransforms, SidesOfLinesAreExactOnAGrid) {
    Random random(202);
    auto grid = [&](int) {
        return glm::vec2(std::floor(random.between(-2048, 2048)), std::floor(random.between(-2048, 2048))) *
               (1.f / 256.f);
    };
    const auto a = many(grid), b = many(grid);
    const auto p = many([&](int i) {
        const auto k = std::size_t(i);
        return i % 3 ? grid(i) : a[k] + (b[k] - a[k]) * 0.5f;
    });
    const auto device =
        runOnDevice<std::int32_t>("shaders/shared/vector.glsl", "sideOfLine(a, b, c)", a, b, p);
    for (std::size_t i = 0; i < device.size(); ++i) {
        const glm::dvec2 u = glm::dvec2(b[i]) - glm::dvec2(a[i]), v = glm::dvec2(p[i]) - glm::dvec2(a[i]);
        const double area = u.x * v.y - u.y * v.x;
        ASSERT_EQ(device[i], area > 0 ? 1 : area < 0 ? -1 : 0) << i;
    }
}

TEST(DeviceTransforms, Matrices) {
    Random random(203);
    const auto ms = many([&](int) { return random.matrix<glm::mat4>(); }),
               ns = many([&](int) { return random.matrix<glm::mat4>(); });
    DEVICE_CHECK(Mat4, 5e-7, (return a * b;), ms, ns);
    DEVICE_CHECK(Mat4, 1e-12, (return transpose(a);), ms);
    DEVICE_CHECK(Mat4, 5e-7, (return transpose(a * b) - transpose(b) * transpose(a) + Mat4(1.0);), ms, ns);
    DEVICE_CHECK(Real, 2.4e-7, (return determinantAccurate(a);), ms);
    const auto ms3 = many([&](int) { return random.matrix<glm::mat3>(); });
    DEVICE_CHECK(Real, 2.4e-7, (return determinantAccurate(a);), ms3);
    // Inverses by their condition number.
    for (int size : {3, 4}) {
        const auto inverses4 = runOnDevice<glm::mat4>("shaders/shared/matrix.glsl", "inverseAccurate(a)", ms);
        const auto inverses3 =
            runOnDevice<glm::mat3>("shaders/shared/matrix.glsl", "inverseAccurate(a)", ms3);
        double worst = 0;
        for (std::size_t i = 0; i < ms.size(); ++i) {
            auto judge = [&](const auto& exact, const auto& computed) {
                const auto inverse = exact.inverse().eval();
                const double kappa = exact.norm() * inverse.norm();
                if (kappa < 1e6)
                    worst = std::max(worst,
                                     (computed - inverse).norm() / inverse.norm() / (kappa * kUnitRoundoff));
            };
            if (size == 3)
                judge(toEigen(ms3[i]), toEigen(inverses3[i]));
            else
                judge(toEigen(ms[i]), toEigen(inverses4[i]));
        }
        std::printf("inverse %dx%d on the device: %.3f kappa u\n", size, size, worst);
        EXPECT_LE(worst, 4);
    }
}

TEST(DeviceTransforms, HilbertMatricesAreInvertedWithinTheirConditionNumber) {
    glm::mat4 h;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) h[c][r] = 1.f / static_cast<float>(c + r + 1);
    const auto exact = toEigen(h);
    const auto inverse = exact.inverse().eval();
    const auto computed =
        runOnDevice<glm::mat4>("shaders/shared/matrix.glsl", "inverseAccurate(a)", std::vector{h})[0];
    const double kappa = exact.norm() * inverse.norm();
    EXPECT_LE((toEigen(computed) - inverse).norm() / inverse.norm(), 4 * kappa * kUnitRoundoff);
}

TEST(DeviceTransforms, PlaneAndHomogeneous) {
    Random random(204);
    const auto angle = many([&](int) { return random.between(-10, 10); });
    const auto p = many([&](int) { return random.vector(); });
    DEVICE_CHECK(Vec3, 4e-7, (return rotation2(a) * b;), angle, p);
    DEVICE_CHECK(Vec3, 4e-7, (return shearing2(Vec2(b.x, b.y)) * scaling2(Vec2(b.y, b.z)) * a;), p, p);
    const auto w = many([&](int i) { return std::ldexp(i % 2 ? 1.f : -1.f, i % 121 - 60); });
    const auto scaled =
        runOnDevice<glm::vec3>("shaders/shared/transform.glsl", "divideByW(homogeneousPoint(a) * b)", p, w);
    for (std::size_t i = 0; i < p.size(); ++i) ASSERT_EQ(scaled[i], p[i]) << w[i];
}

TEST(DeviceTransforms, Rotations) {
    Random random(205);
    const auto angles = many([&](int i) {
        const glm::vec3 a(random.between(-3.1, 3.1), random.between(-1.5, 1.5), random.between(-3.1, 3.1));
        return i % 5 ? a
                     : glm::vec3(a.x, (i % 2 ? 1.f : -1.f) * 1.57079637f, a.z);  // every fifth in gimbal lock
    });
    DEVICE_CHECK(Mat3, 5e-7, (return rotationEuler(a);), angles);
    DEVICE_CHECK(Mat3, 5e-7, (return rotationEuler(eulerAngles(rotationEuler(a)));), angles);
    const auto axis = many([&](int) { return random.direction() * std::fabs(random.magnitude(-60, 60)); });
    const auto angle = many([&](int i) {
        return i % 3 == 0   ? random.between(-3.2, 3.2)
               : i % 3 == 1 ? 1e-7f * std::fabs(random.magnitude(0, 10))
                            : shared32::PI - 1e-7f * std::fabs(random.magnitude(0, 10));
    });
    DEVICE_CHECK(Mat3, 5e-7, (return rotationAbout(a, b);), axis, angle);
    DEVICE_CHECK(Mat3, 6e-7, (Mat3 r = rotationAbout(a, b); return transpose(r) * r;), axis, angle);
    DEVICE_CHECK(Mat3, 5e-7, (return quaternionToMatrix(quaternionAbout(a, b));), axis, angle);
    DEVICE_CHECK(Mat3, 1e-6, (return quaternionToMatrix(quaternionFromMatrix(rotationAbout(a, b)));), axis,
                 angle);
    const auto t = many([&](int) { return random.between(0, 1); });
    DEVICE_CHECK(Vec4, 5e-7, (return quaternionSlerp(quaternionAbout(a, 1.0), quaternionAbout(a, b), c);),
                 axis, t, t);
    DEVICE_CHECK(Vec4, 5e-7, (return quaternionSlerp(quaternionAbout(a, 1.0), -quaternionAbout(a, b), c);),
                 axis, t, t);
    DEVICE_CHECK(Vec4, 1e-6,
                 (return quaternionProduct(quaternionAbout(a, b), quaternionAbout(Vec3(a.y, a.z, a.x), b));),
                 axis, angle);
    DEVICE_CHECK(Vec3, 1e-6, (return quaternionRotate(quaternionAbout(a, b), Vec3(1.0, 0.0, 0.0));), axis,
                 angle);
}

TEST(DeviceTransforms, AffineAndViews) {
    Random random(206);
    const auto t = many([&](int) { return random.vector(10); });
    const auto axis = many([&](int) { return random.direction(); });
    const auto scale = many([&](int) {
        return glm::vec3(std::fabs(random.magnitude(-3, 3)), std::fabs(random.magnitude(-3, 3)),
                         random.magnitude(-3, 3));
    });
    const auto shear = many([&](int) { return random.vector(2); });
    DEVICE_CHECK(Mat4, 1e-6,
                 (AffineParts p; p.translation = a; p.rotation = quaternionAbout(b, b.x); p.scale = c;
                  p.shear = d; return composeAffine(p);),
                 t, axis, scale, shear);
    DEVICE_CHECK(Mat4, 1e-6,
                 (AffineParts p; p.translation = a; p.rotation = quaternionAbout(b, b.x); p.scale = c;
                  p.shear = d; return composeAffine(decomposeAffine(composeAffine(p)));),
                 t, axis, scale, shear);
    DEVICE_CHECK(Mat4, 1e-6, (return inverseRigid(affineMatrix(rotationAbout(b, a.x), a));), t, axis);
    DEVICE_CHECK(Mat4, 1e-6, (return inverseAffine(affineMatrix(rotationAbout(b, a.x), a));), t, axis);
    // Up at 30 to 150 degrees from the gaze.
    const auto up = many([&](int i) {
        const glm::vec3 g = axis[std::size_t(i)];
        return glm::normalize(glm::cross(g, random.direction())) + g * random.between(-1.7, 1.7);
    });
    DEVICE_CHECK(Mat4, 5e-7, (return viewMatrix(a, b, c);), t, axis, up);
    // Along the gaze: finite, orthonormal.
    const auto views =
        runOnDevice<glm::mat4>("shaders/shared/transform.glsl", "viewMatrix(a, b, b * 3.0)", t, axis);
    double defect = 0;
    for (const auto& v : views) defect = std::max(defect, rotationDefect(glm::mat3(v)));
    EXPECT_LE(defect, 5e-7);
}

TEST(DeviceTransforms, Projections) {
    Random random(207);
    // Left, bottom, near and right, top, far.
    const auto low = many([&](int i) {
        const float x = i % 3 ? random.between(-1, 1) : 0.f;
        return glm::vec3(x - std::fabs(random.magnitude(-1, 2)), -1, std::fabs(random.magnitude(-4, 1)));
    });
    const auto high = many([&](int i) {
        const glm::vec3 l = low[std::size_t(i)];
        return glm::vec3(i % 3 ? l.x + std::fabs(random.magnitude(1, 3)) : -l.x,
                         i % 3 ? random.between(0, 2) : 1.f, l.z * (1 + std::fabs(random.magnitude(0, 8))));
    });
    DEVICE_CHECK(Mat4, 2e-7, (return cubeOrthographic(a.x, b.x, a.y, b.y, -a.z, -b.z);), low, high);
    DEVICE_CHECK(Mat4, 2e-7, (return orthographic(a.x, b.x, a.y, b.y, a.z, b.z);), low, high);
    DEVICE_CHECK(Mat4, 1e-6, (return cubeSquish(-a.z, -b.z);), low, high);
    DEVICE_CHECK(Mat4, 1e-6, (return cubePerspective(a.x, b.x, a.y, b.y, -a.z, -b.z);), low, high);
    DEVICE_CHECK(Mat4, 1e-6, (return frustum(a.x, b.x, a.y, b.y, a.z, b.z);), low, high);
    DEVICE_CHECK(Mat4, 1e-6, (return frustumInfinite(a.x, b.x, a.y, b.y, a.z);), low, high);
    DEVICE_CHECK(Mat4, 1e-6, (return frustumForwardZ(a.x, b.x, a.y, b.y, a.z, b.z);), low, high);
    // The frustum's corners to the cube's: the far right top one is far / near times the near one.
    DEVICE_CHECK(Vec3, 1e-6,
                 (Mat4 m = cubePerspective(a.x, b.x, a.y, b.y, -a.z, -b.z);
                  return projectPoint(m, Vec3(b.x, b.y, -a.z));),
                 low, high);
    const auto fov = many([&](int) { return random.between(0.01, 3); });
    const auto aspect = many([&](int) { return random.between(0.2, 5); });
    DEVICE_CHECK(Mat4, 1e-6, (return perspective(a, b, 0.125);), fov, aspect);
    DEVICE_CHECK(Mat4, 1e-6, (return perspectiveFinite(a, b, 0.125, 1000.0);), fov, aspect);
    DEVICE_CHECK_RELATIVE(Real, 1e-6,
                          (Vec2 e = frustumExtents(a, b, 0.125); return fieldOfView(2.0 * e.y, 0.125);), fov,
                          aspect);
    const std::vector<glm::vec2> corners{{-1, -1}, {1, 1}, {0, 0}, {-1, 1}};
    const std::vector<glm::vec2> sizes{{1024, 512}, {1024, 512}, {1024, 512}, {8192, 1}};
    EXPECT_EQ(runOnDevice<glm::vec2>("shaders/shared/projection.glsl", "viewportPoint(a, b)", corners, sizes),
              (std::vector<glm::vec2>{{0, 0}, {1024, 512}, {512, 256}, {0, 1}}));
    const auto projected = runOnDevice<glm::vec4>("shaders/shared/projection.glsl",
                                                  "viewport(b) * vec4(a, 0.25, 1.0)", corners, sizes);
    EXPECT_EQ(projected[1], glm::vec4(1024, 512, 0.25f, 1));
}

TEST(DeviceTransforms, Color) {
    const auto values = floatsSpaced(0.f, 1.f, 1'000'001);
    DEVICE_CHECK(Real, 1e-6, (return encodeSrgb(a);), values);
    DEVICE_CHECK(Real, 1e-6, (return decodeSrgb(a);), values);
    const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 0.5f, 4}};
    DEVICE_CHECK(Real, 2e-7, (return luminance(a);), colors);
}

}  // namespace
