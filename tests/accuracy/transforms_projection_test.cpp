// Orthographic and perspective projections, fields of view, viewport (rows T8, T10, T11, T12, R1).
#include "tests/accuracy/transforms_support.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cstdio>

namespace {

using namespace helio;
using namespace helio::test;
using namespace helio::shared32;

struct Window {
    float l, r, b, t, near, far;
};
Window randomWindow(Random& random, int i) {
    const float w = std::fabs(random.magnitude(-4, 4)), h = std::fabs(random.magnitude(-4, 4));
    // Symmetric, off centre, and wholly to one side.
    const float x = i % 3 ? random.between(-1.5, 1.5) * w : 0.f,
                y = i % 3 ? random.between(-1.5, 1.5) * h : 0.f;
    const float near = std::fabs(random.magnitude(-6, 3));
    return {x - w, x + w, y - h, y + h, near, near * (1 + std::fabs(random.magnitude(-1, 10)))};
}

TEST(TransformsProjection, OrthographicCorners) {
    Random random(61);
    double cube = 0, vulkan = 0, reference = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const Window w = randomWindow(random, i);
        const Mat4 m = cubeOrthographic(w.l, w.r, w.b, w.t, -w.near, -w.far);
        const Mat4 v = orthographic(w.l, w.r, w.b, w.t, w.near, w.far);
        const Mat4 f = orthographicForwardZ(w.l, w.r, w.b, w.t, w.near, w.far);
        // A matrix's entries are rounded: scale * |x| + |offset| bounds what that moves.
        const double spread = 1 + std::max({std::fabs((double{w.r} + w.l) / (double{w.r} - w.l)),
                                            std::fabs((double{w.t} + w.b) / (double{w.t} - w.b)),
                                            (double{w.far} + w.near) / (double{w.far} - w.near)});
        for (int corner = 0; corner < 8; ++corner) {
            const bool right = corner & 1, top = corner & 2, isNear = corner & 4;
            const Vec3 p(right ? w.r : w.l, top ? w.t : w.b, isNear ? -w.near : -w.far);
            const glm::dvec3 c(projectPoint(m, p)), d(projectPoint(v, p)), e(projectPoint(f, p));
            const glm::dvec3 expected(right ? 1 : -1, top ? 1 : -1, isNear ? 1 : -1);
            cube = std::max(cube, glm::length(c - expected) / spread);
            vulkan = std::max(
                {vulkan, glm::length(d - glm::dvec3(expected.x, -expected.y, isNear ? 1 : 0)) / spread,
                 glm::length(e - glm::dvec3(expected.x, -expected.y, isNear ? 0 : 1)) / spread});
        }
        // glm::ortho has z from -1 at near to 1 at far: the cube's z negated.
        const glm::dmat4 g = glm::ortho<double>(w.l, w.r, w.b, w.t, w.near, w.far);
        for (int col = 0; col < 4; ++col)
            for (int row = 0; row < 3; ++row) {
                const double expected = row == 2 ? -g[col][row] : g[col][row];
                reference = std::max(reference, std::fabs(m[col][row] - expected) /
                                                    std::max(double{1}, std::fabs(expected)) /
                                                    (col == 3 ? spread : 1));
            }
    }
    std::printf("orthographic: cube corners %.3g, Vulkan corners %.3g, against GLM %.3g\n", cube, vulkan,
                reference);
    EXPECT_LE(cube, 2e-7);
    EXPECT_LE(vulkan, 2e-7);
    EXPECT_LE(reference, 2e-7);
}

TEST(TransformsProjection, SquishFixesThePlanesAndMovesTheMiddleToFar) {
    Random random(62);
    double worst = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const float n = -std::fabs(random.magnitude(-4, 4)), f = n * (1 + std::fabs(random.magnitude(-1, 8)));
        const Mat4 m = cubeSquish(n, f);
        const Vec3 p(random.between(-1, 1), random.between(-1, 1), 0);
        const Vec3 near = projectPoint(m, Vec3(p.x, p.y, n)), far = projectPoint(m, Vec3(p.x, p.y, f));
        // n + f - n f / n leaves n only to the rounding of f, the larger.
        worst = std::max({worst, std::fabs(near.z - double{n}) / std::fabs(double{f}),
                          std::fabs(far.z / double{f} - 1), std::fabs(double{near.x} - p.x),
                          std::fabs(far.x - double{p.x} * n / f)});
        const shared64::Vec3 exactNear =
            shared64::projectPoint(shared64::cubeSquish(n, f), shared64::Vec3(p.x, p.y, n));
        EXPECT_NEAR(exactNear.z / n, 1, 1e-12L);
        // z' = (n + f) - n f / z, and of the middle beyond the middle.
        const float z = n + (f - n) * random.between(0, 1);
        const double exact = double{n} + f - double{n} * f / z;
        worst =
            std::max(worst, std::fabs(projectPoint(m, Vec3(p.x, p.y, z)).z - exact) / std::fabs(double{f}));
        const float middle = 0.5f * (n + f);
        EXPECT_LT(projectPoint(m, Vec3(0, 0, middle)).z, middle);
    }
    std::printf("squish: %.3g\n", worst);
    EXPECT_LE(worst, 1e-6);
}

TEST(TransformsProjection, PerspectiveCorners) {
    Random random(63);
    double cube = 0, chain = 0, vulkan = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const Window w = randomWindow(random, i);
        const Mat4 m = cubePerspective(w.l, w.r, w.b, w.t, -w.near, -w.far);
        const Mat4 reversed = frustum(w.l, w.r, w.b, w.t, w.near, w.far);
        const Mat4 forward = frustumForwardZ(w.l, w.r, w.b, w.t, w.near, w.far);
        const Mat4 infinite = frustumInfinite(w.l, w.r, w.b, w.t, w.near);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                ASSERT_TRUE(std::isfinite(m[c][r]));  // the misprint divides by l + r = 0
        // M_ortho M_squish in double.
        const Eigen::Matrix4d product =
            toEigen(shared64::cubeOrthographic(w.l, w.r, w.b, w.t, -w.near, -w.far)) *
            toEigen(shared64::cubeSquish(-w.near, -w.far));
        chain = std::max(chain, (toEigen(m) - product).norm() / product.norm());
        const double spread = 1 + std::max({std::fabs((double{w.r} + w.l) / (double{w.r} - w.l)),
                                            std::fabs((double{w.t} + w.b) / (double{w.t} - w.b)),
                                            (double{w.far} + w.near) / (double{w.far} - w.near)});
        for (int corner = 0; corner < 8; ++corner) {
            const bool right = corner & 1, top = corner & 2, isNear = corner & 4;
            const double z = isNear ? w.near : w.far, along = z / w.near;
            // Rounding the corner to float moves it; its exact image is taken in double.
            const Vec3 p(static_cast<float>((right ? w.r : w.l) * along),
                         static_cast<float>((top ? w.t : w.b) * along), static_cast<float>(-z));
            const glm::dvec3 expected(right ? 1 : -1, top ? 1 : -1, isNear ? 1 : -1);
            cube = std::max(cube, glm::length(glm::dvec3(projectPoint(m, p)) - expected) / spread);
            const Vec4 clip = reversed * Vec4(p, 1.f);
            ASSERT_GT(clip.w, 0.f);
            vulkan = std::max({vulkan,
                               glm::length(glm::dvec3(divideByW(clip)) -
                                           glm::dvec3(expected.x, -expected.y, isNear ? 1 : 0)) /
                                   spread,
                               glm::length(glm::dvec3(projectPoint(forward, p)) -
                                           glm::dvec3(expected.x, -expected.y, isNear ? 0 : 1)) /
                                   spread,
                               glm::length(glm::dvec3(projectPoint(infinite, p)) -
                                           glm::dvec3(expected.x, -expected.y, w.near / z)) /
                                   spread});
        }
    }
    std::printf("perspective: cube corners %.3g, product %.3g, Vulkan corners %.3g\n", cube, chain, vulkan);
    EXPECT_LE(cube, 1e-6);
    EXPECT_LE(chain, 1e-6);
    EXPECT_LE(vulkan, 1e-6);
}

TEST(TransformsProjection, FieldsOfView) {
    Random random(64);
    double worst = 0;
    for (int i = 0; i < series(200'000); ++i) {
        const float fov = random.between(0.001, 3.1), aspect = random.between(0.2, 5),
                    near = std::fabs(random.magnitude(-9, 9));
        const Vec2 extents = frustumExtents(fov, aspect, near);
        worst = std::max({worst, std::fabs(double{fieldOfView(2.f * extents.y, near)} / fov - 1),
                          std::fabs(double{extents.x} / extents.y / aspect - 1)});
        // Both ways to a matrix agree, and with GLM's (its y is up, its depth forward).
        const auto a = toEigen(perspective(fov, aspect, near));
        const auto b = toEigen(frustumInfinite(-extents.x, extents.x, -extents.y, extents.y, near));
        worst = std::max(worst, (a - b).norm() / a.norm());
        const glm::dmat4 g = glm::perspective<double>(fov, aspect, near, 2.0 * near);
        worst = std::max({worst, std::fabs(a(0, 0) / g[0][0] - 1), std::fabs(-a(1, 1) / g[1][1] - 1)});
        const float far = near * random.between(1.5, 1000);
        const auto c = toEigen(perspectiveFinite(fov, aspect, near, far));
        const auto d = toEigen(frustum(-extents.x, extents.x, -extents.y, extents.y, near, far));
        worst = std::max(worst, (c - d).norm() / c.norm());
    }
    std::printf("fields of view: %.3g relative\n", worst);
    EXPECT_LE(worst, 1e-6);
    // 36 x 24 mm behind 50 mm.
    EXPECT_NEAR(fieldOfView(24, 50), radians(26.99146656L), 1e-6 * 0.47);
    EXPECT_NEAR(fieldOfView(36, 50), radians(39.59775271L), 1e-6 * 0.69);
    EXPECT_NEAR(shared64::fieldOfView(24, 50), 26.99146656L * 3.14159265358979323846L / 180, 1e-10L);
}

TEST(TransformsProjection, ReversedInfiniteDepthKeepsRelativeDistance) {
    // depth = near / distance: relative steps of 2^-24 or less everywhere, 3.64e-5 at 500 for near = 0.1.
    const Mat4 m = perspective(1.f, 1.5f, 0.1f);
    for (float distance : {0.1f, 1.f, 10.f, 500.f, 1e6f, 1e20f}) {
        const float depth = projectPoint(m, Vec3(0, 0, -distance)).z;
        EXPECT_NEAR(viewDistance(depth, 0.1f) / distance, 1, 2.4e-7);
        const double step =
            shared64::viewDistance(nextDown(depth), 0.1f) - shared64::viewDistance(depth, 0.1f);
        EXPECT_LE(step / distance, 1.2e-7);
        if (distance == 500.f) {
            EXPECT_NEAR(step, 3.64e-5L, 0.01e-5L);
        }
    }
    EXPECT_EQ(projectPoint(m, Vec3(0, 0, -0.1f)).z, 1.f);
    const Vec4 atInfinity = m * Vec4(0, 0, -1, 0);
    EXPECT_EQ(atInfinity.z / atInfinity.w, 0.f);
}

TEST(TransformsProjection, ModelViewProjectionChain) {
    Random random(65);
    double worst = 0;
    for (int i = 0; i < series(300'000); ++i) {
        AffineParts parts;
        parts.translation = random.vector(3);
        parts.rotation = quaternionAbout(random.direction(), random.between(-3, 3));
        parts.scale = Vec3(random.between(0.5, 2));
        parts.shear = Vec3(0.f);
        const Mat4 model = composeAffine(parts),
                   node = affineMatrix(rotationAbout(random.direction(), 1.f), random.vector());
        const Mat4 view = lookAt(random.direction() * 20.f, random.vector(), random.direction());
        const Mat4 projection = perspective(random.between(0.5, 1.5), random.between(0.5, 2), 0.1f);
        const Mat4 mvp = projection * view * node * model;
        const Vec3 p = random.vector(2);
        // Step by step in double, from the same float matrices.
        const Eigen::Vector4d exact =
            toEigen(projection) *
            (toEigen(view) * (toEigen(node) * (toEigen(model) * toEigen(Vec4(p, 1.f)))));
        if (exact.w() < 1) continue;
        const Eigen::Vector4d clip = toEigen(mvp * Vec4(p, 1.f));
        worst = std::max(worst, (clip - exact).norm() / exact.norm());
    }
    std::printf("model view projection: %.3g relative\n", worst);
    EXPECT_LE(worst, 1e-6);
}

TEST(TransformsProjection, ViewportCornersAndCentres) {
    for (Vec2 size : {Vec2(1024, 512), Vec2(1, 1), Vec2(8192, 4096), Vec2(1280, 720), Vec2(333, 777)}) {
        EXPECT_EQ(viewportPoint(Vec2(-1, -1), size), Vec2(0, 0));
        EXPECT_EQ(viewportPoint(Vec2(1, 1), size), size);
        EXPECT_EQ(viewportPoint(Vec2(0, 0), size), size * 0.5f);
        EXPECT_EQ(projectPoint(viewport(size), Vec3(-1, -1, 0.25f)), Vec3(0, 0, 0.25f));
        EXPECT_EQ(projectPoint(viewport(size), Vec3(1, 1, 0.75f)), Vec3(size, 0.75f));
        // The cube's y points up: its top left is pixel (0, 0).
        EXPECT_EQ(projectPoint(cubeViewport(size), Vec3(-1, 1, -0.5f)), Vec3(0, 0, -0.5f));
        EXPECT_EQ(projectPoint(cubeViewport(size), Vec3(1, -1, 0)), Vec3(size, 0));
    }
    // Sizes of powers of two: centres there and back exactly.
    const Vec2 size(1024, 256);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 1024; ++x) {
            const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            ASSERT_EQ(viewportPoint(viewportInverse(centre, size), size), centre);
            ASSERT_EQ(projectPoint(viewport(size), Vec3(viewportInverse(centre, size), 0.f)),
                      Vec3(centre, 0.f));
        }
    // Up in the world is up in the picture, right is right.
    const Mat4 m = viewport(Vec2(640, 480)) * perspective(1.f, 4.f / 3.f, 0.1f);
    EXPECT_LT(projectPoint(m, Vec3(0, 1, -5)).y, 240.f);
    EXPECT_GT(projectPoint(m, Vec3(1, 0, -5)).x, 320.f);
}

}  // namespace
