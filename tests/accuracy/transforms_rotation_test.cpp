// Rotations (rows T6, T7): against Eigen's AngleAxis, quaternions and the matrix exponential in double.
#include "tests/accuracy/transforms_support.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace {

using namespace helio;
using namespace helio::test;
using namespace helio::shared32;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d eulerReference(const Vec3& a) {
    return (AngleAxisd(double{a.x}, Vector3d::UnitX()) * AngleAxisd(double{a.y}, Vector3d::UnitY()) *
            AngleAxisd(double{a.z}, Vector3d::UnitZ()))
        .toRotationMatrix();
}

TEST(TransformsRotation, AboutTheAxes) {
    Random random(41);
    double worst = 0, defect = 0, sum = 0;
    for (int i = 0; i < series(300'000); ++i) {
        const float a = i % 2 ? random.between(-7, 7) : random.magnitude(-30, 15);
        worst = std::max({worst,
                          maxDifference(toEigen(rotationX(a)),
                                        AngleAxisd(double{a}, Vector3d::UnitX()).toRotationMatrix()),
                          maxDifference(toEigen(rotationY(a)),
                                        AngleAxisd(double{a}, Vector3d::UnitY()).toRotationMatrix()),
                          maxDifference(toEigen(rotationZ(a)),
                                        AngleAxisd(double{a}, Vector3d::UnitZ()).toRotationMatrix())});
        defect = std::max({defect, rotationDefect(rotationX(a)), rotationDefect(rotationY(a)),
                           rotationDefect(rotationZ(a))});
        // R(a) R(b) = R(a + b) where the sum is exact.
        const float b = std::ldexp(std::floor(random.between(-1000, 1000)), -8),
                    c = std::ldexp(std::floor(random.between(-1000, 1000)), -8);
        sum = std::max(sum, maxDifference(toEigen(rotation2(b) * rotation2(c)), toEigen(rotation2(b + c))));
    }
    std::printf("axis rotations %.3g, defect %.3g, R(a)R(b)-R(a+b) %.3g\n", worst, defect, sum);
    EXPECT_LE(worst, 1.2e-7);
    EXPECT_LE(defect, 5e-7);
    EXPECT_LE(sum, 4e-7);
}

TEST(TransformsRotation, EulerAnglesThereAndBack) {
    Random random(42);
    double built = 0, defect = 0, angles = 0, matrices = 0;
    for (int i = 0; i < series(300'000); ++i) {
        Vec3 a(random.between(-3.14, 3.14), random.between(-1.4, 1.4), random.between(-3.14, 3.14));
        const Mat3 r = rotationEuler(a);
        built = std::max(built, maxDifference(toEigen(r), eulerReference(a)));
        defect = std::max(defect, rotationDefect(r));
        // Away from gimbal lock the angles come back; a and c lose 1 / cos b.
        const Vec3 back = eulerAngles(r);
        for (int k = 0; k < 3; ++k)
            angles =
                std::max(angles, std::fabs(double{back[k]} - a[k]) * (k == 1 ? 1 : std::cos(double{a.y})));
        // In gimbal lock and ever closer to it the rotation comes back.
        a.y = (i & 1 ? HALF_PI : -HALF_PI) + (i % 7 ? random.magnitude(-40, -1) : 0.f);
        const Mat3 locked = rotationEuler(a);
        matrices =
            std::max(matrices, maxDifference(toEigen(rotationEuler(eulerAngles(locked))), toEigen(locked)));
    }
    std::printf("Euler: built %.3g, defect %.3g, angles back %.3g, rotations back near the lock %.3g\n",
                built, defect, angles, matrices);
    EXPECT_LE(built, 5e-7);
    EXPECT_LE(defect, 5e-7);
    EXPECT_LE(angles, 5e-7);
    EXPECT_LE(matrices, 5e-7);
    // Exactly locked: sin b = 1 to the last bit.
    const Mat3 lock(0, 1, 0, 0, 0, 1, 1, 0, 0);
    EXPECT_LE(maxDifference(toEigen(rotationEuler(eulerAngles(lock))), toEigen(lock)), 2e-7);
}

/// exp(alpha N) by its series, scaled and squared: independent of sines.
Matrix3d exponential(const Vector3d& n, double alpha) {
    Matrix3d a;
    a << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
    a *= alpha / 1024;
    Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
    for (int k = 1; k < 12; ++k) {
        term = term * a / k;
        sum += term;
    }
    for (int k = 0; k < 10; ++k) sum = sum * sum;
    return sum;
}

TEST(TransformsRotation, Rodrigues) {
    Random random(43);
    double worst = 0, defect = 0, trace = 0, axisMoves = 0, quaternion = 0, back = 0;
    for (int i = 0; i < series(100'000); ++i) {
        const Vec3 axis = random.direction() * std::fabs(random.magnitude(-60, 60));  // any length
        float angle = random.between(-3.2, 3.2);
        if (i % 4 == 0) angle = 1e-7f * std::fabs(random.magnitude(0, 10));
        if (i % 4 == 1) angle = std::min(PI - 1e-7f * std::fabs(random.magnitude(0, 10)), PI);
        if (i % 64 == 1) angle = PI;
        const Vector3d n = toEigen(axis).normalized();
        const Mat3 r = rotationAbout(axis, angle);
        const Matrix3d e = toEigen(r);
        worst = std::max({worst, maxDifference(e, AngleAxisd(double{angle}, n).toRotationMatrix()),
                          i % 10 ? 0 : maxDifference(e, exponential(n, angle))});
        defect = std::max(defect, rotationDefect(r));
        trace = std::max(trace, std::fabs(e.trace() - 1 - 2 * std::cos(double{angle})));
        axisMoves = std::max(axisMoves, (e * n - n).norm());
        const Vec4 q = quaternionAbout(axis, angle);
        quaternion = std::max(quaternion, maxDifference(toEigen(quaternionToMatrix(q)), e));
        // Axis and angle come back from the matrix, up to the sign of both.
        Vec3 axisBack;
        float angleBack;
        quaternionAxisAngle(quaternionFromMatrix(r), axisBack, angleBack);
        back = std::max(back, maxDifference(toEigen(rotationAbout(axisBack, angleBack)), e));
    }
    std::printf("Rodrigues %.3g, defect %.3g, trace %.3g, axis %.3g, quaternion %.3g, back %.3g\n", worst,
                defect, trace, axisMoves, quaternion, back);
    EXPECT_LE(worst, 5e-7);
    EXPECT_LE(defect, 6e-7);
    EXPECT_LE(trace, 6e-7);
    EXPECT_LE(axisMoves, 5e-7);
    EXPECT_LE(quaternion, 6e-7);
    EXPECT_LE(back, 1e-6);
    EXPECT_EQ(rotationAbout(Vec3(0.f), 1.f), Mat3(1.f));
    // The skew part carries small angles to full precision: x = 1e-7 about z turns x by exactly that.
    EXPECT_EQ(rotationAbout(Vec3(0, 0, 7), 1e-7f)[0].y, 1e-7f);
    EXPECT_EQ(crossMatrix(Vec3(1, 2, 3)) * Vec3(4, 5, 6), cross(Vec3(1, 2, 3), Vec3(4, 5, 6)));
}

TEST(TransformsRotation, QuaternionProductRotateAndSlerp) {
    Random random(44);
    double product = 0, rotate = 0, slerp = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const Vec4 a = quaternionAbout(random.direction(), random.between(-3, 3));
        const Vec4 b =
            i % 3 ? quaternionAbout(random.direction(), random.between(-3, 3))
                  : quaternionProduct(
                        quaternionAbout(random.direction(), std::fabs(random.magnitude(-20, -3))), a);
        const Eigen::Quaterniond ea(a.w, a.x, a.y, a.z), eb(b.w, b.x, b.y, b.z);
        const Eigen::Vector4d exact = (ea * eb).coeffs();
        product = std::max(product, maxDifference(toEigen(quaternionProduct(a, b)), exact));
        const Vec3 v = random.vector();
        rotate =
            std::max(rotate, maxDifference(toEigen(quaternionRotate(a, v)), ea.normalized() * toEigen(v)));
        const float t = random.between(0, 1);
        // Eigen takes the shorter way too; either sign is the same rotation.
        const Eigen::Vector4d s = ea.normalized().slerp(double{t}, eb.normalized()).coeffs();
        const Eigen::Vector4d computed = toEigen(quaternionSlerp(a, b, t));
        // Nearly opposite quaternions have no sure shorter way.
        if (std::fabs(ea.dot(eb)) > 1e-3L)
            slerp = std::max(slerp, std::min(maxDifference(computed, s), maxDifference(computed, -s)));
        EXPECT_LE(
            maxDifference(toEigen(quaternionProduct(a, quaternionConjugate(a))), Eigen::Vector4d(0, 0, 0, 1)),
            5e-7);
    }
    std::printf("quaternions: product %.3g, rotate %.3g, slerp %.3g\n", product, rotate, slerp);
    EXPECT_LE(product, 5e-7);
    EXPECT_LE(rotate, 1e-6);
    EXPECT_LE(slerp, 5e-7);
}

}  // namespace
