// Homogeneous coordinates, affine transforms, views (rows T3, T4, T5, T8, T9).
#include "tests/accuracy/transforms_support.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cstdio>

namespace {

using namespace helio;
using namespace helio::test;
using namespace helio::shared32;

TEST(TransformsAffine, PlaneScaleShearRotation) {
    Random random(51);
    double area = 0, closed = 0;
    for (int i = 0; i < series(300'000); ++i) {
        const float angle = random.between(-10, 10);
        const Vec2 s(random.magnitude(-3, 3), random.magnitude(-3, 3)),
            k(random.between(-2, 2), random.between(-2, 2));
        const Vec2 t(random.between(-5, 5), random.between(-5, 5)),
            p(random.between(-1, 1), random.between(-1, 1));
        ASSERT_EQ(divideByW(scaling2(s) * Vec3(p, 1.f)), Vec2(s.x * p.x, s.y * p.y));
        ASSERT_EQ(divideByW(translation2(t) * Vec3(p, 1.f)), p + t);
        ASSERT_EQ(divideByW(translation2(t) * Vec3(p, 0.f) + Vec3(0, 0, 1)), p);  // vectors are not moved
        const Vec2 sheared = divideByW(shearing2(k) * Vec3(p, 1.f));
        ASSERT_LE(std::fabs(sheared.x - (double{p.x} + double{k.x} * p.y)), 4e-7);
        ASSERT_LE(std::fabs(sheared.y - (double{p.y} + double{k.y} * p.x)), 4e-7);
        const Vec2 turned = divideByW(rotation2(angle) * Vec3(p, 1.f));
        closed = std::max(
            {closed, std::fabs(turned.x - (std::cos(double{angle}) * p.x - std::sin(double{angle}) * p.y)),
             std::fabs(turned.y - (std::sin(double{angle}) * p.x + std::cos(double{angle}) * p.y))});
        // The unit square's area grows by the determinant.
        const Mat3 m = rotation2(angle) * shearing2(k) * scaling2(s);
        const glm::dmat3 d(m);
        const double grown = d[0].x * d[1].y - d[0].y * d[1].x;
        const double scale = std::fabs(double{s.x} * s.y) * (1 + std::fabs(double{k.x} * k.y));
        area = std::max(
            {area, std::fabs(determinantAccurate(m) - grown) / scale,
             std::fabs(grown - double{s.x} * s.y * (1 - double{k.x} * k.y)) / scale / (1 + glm::dot(k, k))});
    }
    std::printf("plane: rotation %.3g, area %.3g\n", closed, area);
    EXPECT_LE(closed, 4e-7);
    EXPECT_LE(area, 4e-7);
}

TEST(TransformsAffine, HomogeneousAlgebra) {
    Random random(52);
    for (int i = 0; i < series(300'000); ++i) {
        const Vec3 p = random.vector(100), q = random.vector(100);
        const Vec4 difference = homogeneousPoint(p) - homogeneousPoint(q);
        ASSERT_EQ(difference.w, 0.f);
        ASSERT_EQ(Vec3(difference), p - q);
        ASSERT_EQ((homogeneousPoint(p) + homogeneousVector(q)).w, 1.f);
        ASSERT_EQ(divideByW(homogeneousPoint(p) + homogeneousPoint(q)), (p + q) * 0.5f);
        // Projective scale does not matter, exactly so for powers of two and to a rounding each otherwise.
        const float w = std::ldexp(1.f, static_cast<int>(random.between(-60, 61)));
        ASSERT_EQ(divideByW(homogeneousPoint(p) * w), p);
        ASSERT_EQ(divideByW(homogeneousPoint(p) * -w), p);
        const Vec2 flat = divideByW(Vec3(p.x * w, p.y * w, w));
        ASSERT_EQ(flat, Vec2(p.x, p.y));
        const Vec3 other = divideByW(homogeneousPoint(p) * random.magnitude(-60, 60));
        ASSERT_LE(glm::length(glm::dvec3(other) - glm::dvec3(p)),
                  4 * kUnitRoundoff * glm::length(glm::dvec3(p)));
    }
}

AffineParts randomParts(Random& random, bool shear) {
    AffineParts p;
    p.translation = random.vector(100);
    p.rotation = quaternionAbout(random.direction(), random.between(-3.14, 3.14));
    p.scale =
        Vec3(std::fabs(random.magnitude(-4, 4)), std::fabs(random.magnitude(-4, 4)), random.magnitude(-4, 4));
    p.shear = shear ? random.vector(2) : Vec3(0.f);
    return p;
}

TEST(TransformsAffine, CompositionDecompositionAndInverses) {
    Random random(53);
    double matrices = 0, parts = 0, order = 0, inverse = 0, rigid = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const AffineParts p = randomParts(random, i % 2);
        const Mat4 m = composeAffine(p);
        // Shear, scale, rotate, translate in double.
        Eigen::Matrix3d u = Eigen::Matrix3d::Identity();
        u(0, 1) = p.shear.x, u(0, 2) = p.shear.y, u(1, 2) = p.shear.z;
        const Eigen::Quaterniond q(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z);
        const Eigen::Matrix3d linear = q.normalized().toRotationMatrix() * toEigen(p.scale).asDiagonal() * u;
        order = std::max(order, (toEigen(linearPart(m)) - linear).norm() / linear.norm());
        ASSERT_EQ(Vec3(m[3]), p.translation);
        ASSERT_EQ(m[0].w + m[1].w + m[2].w, 0.f);

        const AffineParts back = decomposeAffine(m);
        matrices = std::max(matrices, (toEigen(composeAffine(back)) - toEigen(m)).norm() / linear.norm());
        ASSERT_EQ(back.translation, p.translation);
        if (i % 2 == 0)  // without shear every part comes back
            parts = std::max({parts,
                              maxDifference(toEigen(back.scale), toEigen(p.scale)) /
                                  toEigen(p.scale).cwiseAbs().maxCoeff(),
                              std::min(maxDifference(toEigen(back.rotation), toEigen(p.rotation)),
                                       maxDifference(toEigen(back.rotation), -toEigen(p.rotation)))});

        const Vec3 x = random.vector(10);
        const double size = glm::length(glm::dvec3(x)) + glm::length(glm::dvec3(p.translation));
        const Eigen::Matrix4d em = toEigen(m);
        const double kappa = toEigen(linearPart(m)).norm() * toEigen(linearPart(m)).inverse().norm();
        inverse = std::max(inverse,
                           (toEigen(inverseAffine(m)) - em.inverse()).norm() / em.inverse().norm() / kappa);

        const Mat4 r = affineMatrix(rotationAbout(random.direction(), random.between(-3, 3)), p.translation);
        const Vec3 round = transformPoint(inverseRigid(r), transformPoint(r, x));
        rigid = std::max(rigid, glm::length(glm::dvec3(round) - glm::dvec3(x)) / size);
        // Rows of R^T and -R^T t themselves.
        ASSERT_EQ(linearPart(inverseRigid(r)), transpose(linearPart(r)));
        ASSERT_EQ(transformVector(r, x), linearPart(r) * x);
    }
    std::printf(
        "affine: order %.3g, recomposed %.3g, parts %.3g, inverse/kappa %.3g, rigid round trip %.3g\n", order,
        matrices, parts, inverse, rigid);
    EXPECT_LE(order, 1e-6);
    EXPECT_LE(matrices, 1e-6);
    EXPECT_LE(parts, 1e-6);
    EXPECT_LE(inverse, 4 * kUnitRoundoff);
    EXPECT_LE(rigid, 1e-6);
    EXPECT_EQ(translation(Vec3(1, 2, 3)) * Vec4(4, 5, 6, 1), Vec4(5, 7, 9, 1));
    EXPECT_EQ(translation(Vec3(1, 2, 3)) * Vec4(4, 5, 6, 0), Vec4(4, 5, 6, 0));
    EXPECT_EQ(scaling(Vec3(2, 3, 4)) * Vec4(1, 1, 1, 1), Vec4(2, 3, 4, 1));
}

TEST(TransformsAffine, NormalMatrixKeepsRightAngles) {
    Random random(54);
    double worst = 0;
    for (int i = 0; i < series(300'000); ++i) {
        const Mat3 m = linearPart(composeAffine(randomParts(random, true)));
        const Vec3 n = random.direction();
        const Vec3 t = anyPerpendicular(n);
        const glm::dvec3 moved = glm::normalize(glm::dvec3(m * t));
        const glm::dvec3 normal = glm::normalize(glm::dvec3(normalMatrix(m) * n));
        const double before = glm::dot(glm::dvec3(n), glm::dvec3(t));
        const double kappa = toEigen(m).norm() * toEigen(m).inverse().norm();
        worst = std::max(worst, (std::fabs(glm::dot(moved, normal)) - std::fabs(before)) / kappa);
    }
    std::printf("normal matrix: n.t / kappa %.3g\n", worst);
    EXPECT_LE(worst, 4 * kUnitRoundoff);
}

TEST(TransformsAffine, ViewMatrix) {
    Random random(55);
    double orthonormal = 0, atEye = 0, against = 0, gazeError = 0, upError = 0;
    for (int i = 0; i < series(300'000); ++i) {
        const Vec3 eye = random.vector(10);
        const Vec3 gaze = random.direction() * std::fabs(random.magnitude(-3, 3));
        Vec3 up = random.direction() * std::fabs(random.magnitude(-3, 3));
        const double sine =
            glm::length(glm::cross(glm::normalize(glm::dvec3(gaze)), glm::normalize(glm::dvec3(up))));
        if (sine < 0.05L) continue;
        const Mat4 v = viewMatrix(eye, gaze, up);
        orthonormal = std::max(orthonormal, rotationDefect(linearPart(v)));
        atEye =
            std::max(atEye, double{glm::length(transformPoint(v, eye))} / (1 + glm::length(glm::dvec3(eye))));
        const glm::dvec3 g(transformVector(v, gaze)), u(transformVector(v, up));
        gazeError =
            std::max(gazeError, glm::length(g / glm::length(glm::dvec3(gaze)) - glm::dvec3(0, 0, -1)));
        // up lies in the y-z plane, above.
        upError = std::max(upError, std::fabs(u.x) / glm::length(u));
        ASSERT_GT(u.y, 0);
        // GLM's, in double, on the same gaze.
        const glm::dvec3 e(eye);
        const glm::dmat4 reference = glm::lookAt(e, e + glm::dvec3(gaze), glm::dvec3(up));
        const glm::dmat4 computed(v);
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                against = std::max(against, std::fabs(computed[c][r] - reference[c][r]) * sine);
        for (int r = 0; r < 3; ++r)
            against =
                std::max(against, std::fabs(computed[3][r] - reference[3][r]) * sine / (1 + glm::length(e)));
    }
    std::printf("view: orthonormal %.3g, eye %.3g, gaze %.3g, up %.3g, against GLM %.3g\n", orthonormal,
                atEye, gazeError, upError, against);
    EXPECT_LE(orthonormal, 5e-7);
    EXPECT_LE(atEye, 5e-7);
    EXPECT_LE(gazeError, 5e-7);
    EXPECT_LE(upError, 5e-7);
    EXPECT_LE(against, 5e-7);
}

TEST(TransformsAffine, ViewMatrixOfAwkwardInput) {
    const Vec3 axes[] = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(-1, 1e-3f, 1e-3f)};
    for (const Vec3& a : axes)
        for (float size : {1.f, -1.f, 1e-30f, 1e30f, -1e-20f})
            for (float upSize : {1.f, -1.f, 1e-30f, 1e30f, 0.f}) {
                // up along the gaze, against it, or zero.
                const Mat4 v = viewMatrix(Vec3(1, 2, 3), a * size, a * upSize);
                ASSERT_LE(rotationDefect(linearPart(v)), 5e-7);
                ASSERT_LE(glm::length(transformPoint(v, Vec3(1, 2, 3))), 2e-6f);
                const Vec3 g = transformVector(v, normalizeSafe(a * size, Vec3(0.f)));
                ASSERT_LE(glm::length(g - Vec3(0, 0, -1)), 5e-7);
            }
    EXPECT_LE(rotationDefect(linearPart(viewMatrix(Vec3(0.f), Vec3(0.f), Vec3(0.f)))), 5e-7);
    EXPECT_EQ(lookAt(Vec3(0, 0, 5), Vec3(0.f), Vec3(0, 1, 0)), translation(Vec3(0, 0, -5)));
}

}  // namespace
