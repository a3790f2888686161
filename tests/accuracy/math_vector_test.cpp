// Vector operations (lecture 2): identities and double-precision results over random and extreme inputs;
// sides and insides against exact integers.
#include "engine/core/shared.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

namespace {

using namespace helio;
using namespace helio::shared32;
using glm::dvec3;

constexpr double kUlp = 1.1920928955078125e-07;  // of 1

Vec3 randomVector(std::mt19937_64& random) {
    std::uniform_real_distribution<float> unit(-1.f, 1.f);
    return Vec3(unit(random), unit(random), unit(random));
}

TEST(MathVector, LagrangeAndJacobiIdentities) {
    std::mt19937_64 random(21);
    double lagrange = 0, jacobi = 0, against = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Vec3 a = randomVector(random), b = randomVector(random), c = randomVector(random);
        const dvec3 ab(crossAccurate(a, b));
        const double d = dotAccurate(a, b);
        const double scale = glm::dot(dvec3(a), dvec3(a)) * glm::dot(dvec3(b), dvec3(b));
        lagrange = std::max(lagrange, std::fabs(glm::dot(ab, ab) + d * d - scale) / scale);
        const dvec3 sum = dvec3(crossAccurate(a, crossAccurate(b, c))) +
                          dvec3(crossAccurate(b, crossAccurate(c, a))) +
                          dvec3(crossAccurate(c, crossAccurate(a, b)));
        const double lengths = glm::length(dvec3(a)) * glm::length(dvec3(b)) * glm::length(dvec3(c));
        jacobi = std::max(jacobi, glm::length(sum) / lengths);
        // The plain operators against GLM in double, by the scale of what is added.
        const dvec3 crossError = dvec3(cross(a, b)) - glm::cross(dvec3(a), dvec3(b));
        against = std::max({against, glm::length(crossError) / std::sqrt(scale),
                            std::fabs(double{dot(a, b)} - glm::dot(dvec3(a), dvec3(b))) / std::sqrt(scale)});
    }
    std::printf("Lagrange %.3f ulp, Jacobi %.3f ulp, dot and cross %.3f ulp of the scale\n", lagrange / kUlp,
                jacobi / kUlp, against / kUlp);
    EXPECT_LE(lagrange, 2 * kUlp);
    EXPECT_LE(jacobi, 2 * kUlp);
    EXPECT_LE(against, 2 * kUlp);
}

TEST(MathVector, CrossOfNearlyParallelVectors) {
    std::mt19937_64 random(22);
    double worst = 0;
    for (int i = 0; i < 300'000; ++i) {
        const Vec3 a = randomVector(random);
        const Vec3 b = a * 3.f + randomVector(random) * 1e-6f;
        const Vec3 c = crossAccurate(a, b);
        const dvec3 exact =
            glm::cross(dvec3(a), dvec3(b));  // products exact, one difference rounded to 2^-53
        for (int k = 0; k < 3; ++k)
            if (std::fabs(exact[k]) > 1e-12L) worst = std::max(worst, verify::ulpError(c[k], exact[k]));
    }
    std::printf("crossAccurate of nearly parallel vectors: worst %.3f ULP\n", worst);
    EXPECT_LE(worst, 2);
}

TEST(MathVector, LengthsAndDirectionsAtEveryMagnitude) {
    std::mt19937_64 random(23);
    double lengthWorst = 0, unitWorst = 0, directionWorst = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        // One component may dwarf the others; squares would leave the range from 1e-19 and 1e19 on.
        const int exponent = static_cast<int>(random() % 250) - 125;
        Vec3 v;
        for (int k = 0; k < 3; ++k) {
            const int below = static_cast<int>(random() % (i % 3 ? 3 : 40));
            v[k] = std::ldexp(std::uniform_real_distribution<float>(-1.f, 1.f)(random),
                              std::max(exponent - below, -125));
        }
        const double exact = glm::length(dvec3(v));
        if (exact < 1.2e-38L) continue;
        lengthWorst = std::max(lengthWorst, verify::ulpError(lengthSafe(v), exact));
        const dvec3 n(normalizeSafe(v, Vec3(0.f)));
        unitWorst = std::max(unitWorst, std::fabs(glm::length(n) - 1));
        directionWorst = std::max(directionWorst, glm::length(n - dvec3(v) / exact));
        const double planar = std::hypot(double{v.x}, double{v.y});
        if (planar > 1.2e-38L) lengthWorst = std::max(lengthWorst, verify::ulpError(hypot(v.x, v.y), planar));
    }
    std::printf("lengthSafe %.3f ULP, |normalizeSafe| - 1 %.3f ulp, direction %.3f ulp\n", lengthWorst,
                unitWorst / kUlp, directionWorst / kUlp);
    EXPECT_LE(lengthWorst, 2);
    EXPECT_LE(unitWorst, 2 * kUlp);
    EXPECT_LE(directionWorst, 2 * kUlp);
    EXPECT_EQ(normalizeSafe(Vec3(0.f), Vec3(0.f, 1.f, 0.f)), Vec3(0.f, 1.f, 0.f));
    EXPECT_EQ(lengthSafe(Vec3(0.f)), 0.f);
    EXPECT_EQ(lengthSafe(Vec3(3e30f, 4e30f, 0.f)), 5e30f);
    EXPECT_EQ(lengthSafe(Vec3(3e-30f, 4e-30f, 0.f)), 5e-30f);
    EXPECT_EQ(lengthSafe(Vec2(3e30f, -4e30f)), 5e30f);
}

TEST(MathVector, AnglesFromZeroToPi) {
    std::mt19937_64 random(24);
    double worst = 0, relative = 0;
    for (int i = 0; i < 300'000; ++i) {
        const Vec3 a = randomVector(random);
        Vec3 b = randomVector(random);
        if (i % 3) b = a * (i % 3 == 1 ? 2.f : -2.f) + b * std::ldexp(1.f, -static_cast<int>(random() % 18));
        const dvec3 u = glm::normalize(dvec3(a)), v = glm::normalize(dvec3(b));
        const double exact = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
        const double error = std::fabs(angleBetween(a, b) - exact);
        worst = std::max(worst, error);
        if (i % 3 == 0 && exact < 1) relative = std::max(relative, error / exact);
    }
    std::printf("angleBetween worst absolute error %.3g, relative for spread vectors %.3g\n", worst,
                relative);
    EXPECT_LE(worst, 4e-7);  // acos(dot) would be off by 3e-4 near 0 and pi
    EXPECT_FLOAT_EQ(angleBetween(Vec3(1e30f, 0, 0), Vec3(0, 1e-30f, 0)), HALF_PI);
    EXPECT_EQ(angleBetween(Vec3(1, 0, 0), Vec3(-5, 0, 0)), PI);
    EXPECT_EQ(angleBetween(Vec3(1, 2, 3), Vec3(1, 2, 3)), 0.f);
}

TEST(MathVector, ProjectionsAndBases) {
    std::mt19937_64 random(25);
    double basisWorst = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Vec3 a = randomVector(random), b = randomVector(random);
        const dvec3 exact = dvec3(b) * (glm::dot(dvec3(a), dvec3(b)) / glm::dot(dvec3(b), dvec3(b)));
        ASSERT_LE(glm::length(dvec3(projectOnto(a, b)) - exact), 4 * kUlp * glm::length(dvec3(a)));
        ASSERT_LE(std::fabs(glm::dot(dvec3(rejectFrom(a, b)), glm::normalize(dvec3(b)))),
                  4 * kUlp * glm::length(dvec3(a)));
        Vec3 n = normalizeSafe(a, Vec3(0.f, 0.f, 1.f));
        if (i % 4 == 0) n = normalizeSafe(Vec3(a.x * 1e-4f, a.y * 1e-4f, i % 8 ? -1.f : 1.f), n);
        Vec3 t, s;
        orthonormalBasis(n, t, s);
        const dvec3 dn(n), dt(t), ds(s);
        basisWorst = std::max({basisWorst, std::fabs(glm::dot(dn, dt)), std::fabs(glm::dot(dn, ds)),
                               std::fabs(glm::dot(dt, ds)), std::fabs(glm::length(dt) - 1),
                               std::fabs(glm::length(ds) - 1), glm::length(glm::cross(dt, ds) - dn)});
        ASSERT_LE(std::fabs(glm::dot(dvec3(anyPerpendicular(a)), glm::normalize(dvec3(a)))), 2 * kUlp);
    }
    std::printf("orthonormalBasis worst error %.3g\n", basisWorst);
    EXPECT_LE(basisWorst, 6e-7);
    for (const Vec3 n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1e-30f, -1)}) {
        Vec3 t, s;
        orthonormalBasis(n, t, s);
        EXPECT_EQ(cross(t, s), n);
    }
}

int exactSide(glm::i64vec2 a, glm::i64vec2 b, glm::i64vec2 p) {
    const std::int64_t area = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

TEST(MathVector, SidesAndInsidesAreExactOnAGrid) {
    std::mt19937_64 random(26);
    int onLine = 0, inside = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        // 24-bit coordinates of a 1/256 grid; every second point lies next to the line.
        auto grid = [&](int bits) { return static_cast<std::int64_t>(random() % (1u << bits)); };
        const int bits = i % 3 ? 22 : 4;
        const glm::i64vec2 a(grid(bits), grid(bits)), b(grid(bits), grid(bits)), c(grid(bits), grid(bits));
        glm::i64vec2 p(grid(bits), grid(bits));
        if (i % 2) p = (a + b) / std::int64_t{2} + glm::i64vec2(grid(1), grid(1));
        auto point = [](glm::i64vec2 v) { return Vec2(v) * (1.f / 256.f); };
        const int side = exactSide(a, b, p);
        onLine += side == 0;
        ASSERT_EQ(sideOfLine(point(a), point(b), point(p)), side);
        ASSERT_EQ(sideOfLine(point(b), point(a), point(p)), -side);
        const int s2 = exactSide(b, c, p), s3 = exactSide(c, a, p);
        const auto low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
        const bool in = ((side >= 0 && s2 >= 0 && s3 >= 0) || (side <= 0 && s2 <= 0 && s3 <= 0)) &&
                        p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
        inside += in;
        ASSERT_EQ(insideTriangle(point(a), point(b), point(c), point(p)), in);
    }
    EXPECT_GT(onLine, 1000);
    EXPECT_GT(inside, 1000);
    EXPECT_GT(cross2(Vec2(1, 0), Vec2(0, 1)), 0);  // counter-clockwise, y up: left
}

}  // namespace
