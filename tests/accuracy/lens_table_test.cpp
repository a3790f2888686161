// Cameras with a table of lens surfaces: first-order optics by ray-transfer matrices against traced rays and
// published focal lengths, and pictures against brute-force irradiance on the film.
#include "engine/scene/lens_table.hpp"

#include "engine/core/shared.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace helio::test {
namespace {

constexpr double kTurn = 6.283185307179586L;

LensTable doubleGauss() {
    for (const Camera& camera : load("sample:lenses").cameras)
        if (camera.lensTable) {
            LensTable lens = *camera.lensTable;
            lens.focusDistance = std::numeric_limits<float>::infinity();
            return lens;
        }
    return {};
}
LensTable table(std::vector<LensSurface> surfaces) {
    LensTable lens;
    lens.surfaces = std::move(surfaces);
    return lens;
}

/** Traces from the film's side; false where the ray does not get through. */
bool leaves(const LensTable& lens, shared64::Vec3& origin, shared64::Vec3& direction) {
    for (const shared64::Vec4 surface : tracedSurfaces(lens))
        if (!shared64::crossLensSurface(surface, origin, direction)) return false;
    return true;
}

double rear(const LensTable& lens) {
    return tracedSurfaces(lens)[0].y;
}

TEST(LensTable, FocalLengths) {
    const LensTable thick = table({{100, 10, 1.5f, 20}, {-100, 0, 1, 20}});
    EXPECT_NEAR(paraxial(thick).focalLength, 101.6949153L, 1e-6L);
    EXPECT_NEAR(paraxial(thick).fNumber, 101.6949153L / 20, 1e-3L);
    const LensTable ball = table({{1, 2, 1.5f, 0.5f}, {-1, 0, 1, 0.5f}});
    EXPECT_NEAR(paraxial(ball).focalLength, 1.5L, 1e-6L);
    EXPECT_NEAR(paraxial(ball).filmDistance, 0.5L, 1e-6L);  // half a radius behind the ball
    const LensTable gauss = doubleGauss();
    fmt::print("double Gauss: focal length {:.4f} mm, f/{:.4f}, film at {:.4f} mm, {:.5f} focal lengths\n",
               paraxial(gauss).focalLength, paraxial(gauss).fNumber, paraxial(gauss).filmDistance,
               paraxial(gauss).filmDistance / paraxial(gauss).focalLength);
    // As patented; radii are printed to four digits.
    EXPECT_NEAR(paraxial(gauss).focalLength, 50, 0.02L);
    EXPECT_NEAR(paraxial(gauss).filmDistance / paraxial(gauss).focalLength, 0.71436L, 1e-4L);
    EXPECT_NEAR(paraxial(gauss).fNumber, 2, 0.1L);
    // Rays along the axis bend by height over focal length.
    for (const LensTable& lens : {thick, ball, gauss}) {
        const double f = paraxial(lens).focalLength, height = 1e-4L * f;
        shared64::Vec3 origin(height, 0, rear(lens) - 1), direction(0, 0, 1);
        ASSERT_TRUE(leaves(lens, origin, direction));
        EXPECT_NEAR(-height * direction.z / direction.x / f, 1.0L, 1e-6L);
    }
}

TEST(LensTable, TheFilmMovesToWhatIsInFocus) {
    for (const double focus : {0.6, 2.0, 50.0}) {
        LensTable lens = doubleGauss();
        lens.focusDistance = float(focus);
        shared64::Vec3 origin(0, 0, rear(lens) - paraxial(lens).filmDistance);
        shared64::Vec3 direction = glm::normalize(shared64::Vec3(1e-3L, 0, 1));
        ASSERT_TRUE(leaves(lens, origin, direction));
        const double meets =
            origin.z - origin.x * direction.z / direction.x;  // millimetres from the front vertex
        EXPECT_NEAR(meets / (focus * 1000), 1.0L, 1e-3L) << focus;
    }
    LensTable near = doubleGauss();
    near.focusDistance = 0.01f;
    SceneBuilder b;
    b.camera({0, 0, 0}, {0, 0, -1}, 0.5f);
    b.scene.cameras[0].lensTable = near;
    EXPECT_THROW(b.scene.validate(), InputError);
}

/** Irradiance over radiance of a uniform scene at a point of the film, by quadrature over the plane of the
 * last surface, as a part of pi / (4 N^2). */
double irradiance(const LensTable& lens, double x, double y) {
    const double back = rear(lens), distance = paraxial(lens).filmDistance, n = paraxial(lens).fNumber;
    const double half = 0.75L * double(lens.surfaces.back().diameter);
    constexpr int side = 240;
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const shared64::Vec3 target((i + 0.5L) / side * 2 * half - half,
                                        (j + 0.5L) / side * 2 * half - half, back);
            shared64::Vec3 origin(x, y, back - distance), direction = glm::normalize(target - origin);
            const double cosine = direction.z;
            if (leaves(lens, origin, direction)) sum += cosine * cosine * cosine * cosine;
        }
    return sum * (2 * half / side) * (2 * half / side) / (distance * distance) * 8 * n * n / kTurn;
}

/** A picture of radiance 1 all around. */
Traced furnace(const LensTable& lens, std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
    SceneBuilder b;
    b.sphere({0, 0, 0}, 10.0f, 1, true, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    b.camera({0, 0, 0}, {0, 0, -1}, 0.5f);
    b.scene.cameras[0].lensTable = lens;
    b.scene.validate();
    PathTraceOptions o;
    o.size = {width, height};
    o.maxDepth = 0;
    o.sampler = SamplerKind::Independent;
    return trace(b.scene, o, samples);
}

TEST(LensTable, IrradianceOnTheAxisAndVignetting) {
    for (const float stop : {1.0f, 0.5f}) {
        LensTable lens = doubleGauss();
        lens.stop = stop;
        // On the axis: pi L sin^2 of the steepest ray that leaves.
        lens.filmHeight = 0.2f;
        double low = 0, high = 1;
        for (int step = 0; step < 50; ++step) {
            const double tangent = 0.5L * (low + high);
            shared64::Vec3 origin(0, 0, rear(lens) - paraxial(lens).filmDistance);
            shared64::Vec3 direction = glm::normalize(shared64::Vec3(tangent, 0, 1));
            (leaves(lens, origin, direction) ? low : high) = tangent;
        }
        const double n = paraxial(lens).fNumber, sine2 = low * low / (1 + low * low),
                     truth = sine2 * 4 * n * n;
        const Estimate axis = estimate(furnace(lens, 8, 8, 4096), 0, [](std::size_t) { return true; });
        fmt::print("stop {}: f/{:.3f}, on the axis {:.5f} +- {:.5f}, pi sin^2 gives {:.5f}\n", stop, n,
                   axis.mean, axis.error, truth);
        EXPECT_LT(std::abs(axis.mean - truth), 4 * axis.error + 1e-3L);
        // pi / (4 N^2) near the axis; wide open the steepest rays are steeper than paraxial ones.
        EXPECT_NEAR(axis.mean, 1, stop < 1 ? 0.01L : 0.06L);

        lens.filmHeight = 24;
        constexpr std::uint32_t width = 36, height = 24;
        const Traced image = furnace(lens, width, height, 2048);
        for (const std::array<std::uint32_t, 2> p : {std::array{18u, 12u}, {27u, 12u}, {34u, 1u}}) {
            const std::size_t i = p[1] * width + p[0];
            const double wanted = irradiance(lens, p[0] + 0.5L - 18, p[1] + 0.5L - 12);
            const double sigma = std::sqrt(image.variance[i].x);
            fmt::print("  pixel {} {}: {:.5f} +- {:.5f}, by quadrature {:.5f}\n", p[0], p[1], image.mean[i].x,
                       sigma, wanted);
            EXPECT_LT(std::abs(image.mean[i].x - wanted), 4 * sigma + 0.004L);
            EXPECT_LT(sigma, 0.02L);
        }
    }
}

TEST(LensTable, PicturesAreUprightAndOfTheirSize) {
    // A small square beside the axis in focus: its image lies at the height that the matrices give.
    LensTable lens = doubleGauss();
    lens.focusDistance = 2;
    lens.filmHeight = 8;
    lens.stop = 0.2f;
    const ParaxialLens near = paraxial(lens);
    const double magnification = near.matrix[0][0] + near.filmDistance * near.matrix[0][1];
    SceneBuilder b;
    b.quad({0.03f, 0.05f, -2}, {0.05f, 0.05f, -2}, {0.05f, 0.07f, -2}, {0.03f, 0.07f, -2},
           b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    b.camera({0, 0, 0}, {0, 0, -1}, 0.5f);
    b.scene.cameras[0].lensTable = lens;
    PathTraceOptions o;
    o.size = {64, 64};
    o.maxDepth = 0;
    const Traced image = trace(b.scene, o, 256);
    double sum = 0, x = 0, y = 0;
    for (std::uint32_t j = 0; j < 64; ++j)
        for (std::uint32_t i = 0; i < 64; ++i) {
            const double v = image.mean[j * 64 + i].x;
            sum += v, x += v * (i + 0.5L - 32) / 8, y += v * (31.5L - j) / 8;  // millimetres
        }
    fmt::print("magnification {:.5f}: at ({:.4f}, {:.4f}) mm, truth ({:.4f}, {:.4f})\n", magnification,
               x / sum, y / sum, -magnification * 40, -magnification * 60);
    EXPECT_NEAR(x / sum / (-magnification * 40), 1, 0.01L);
    EXPECT_NEAR(y / sum / (-magnification * 60), 1, 0.01L);
}

}  // namespace
}  // namespace helio::test
