// Radiosity against closed forms and the cube's table: dense, iterative, and bounce by bounce.
#include "engine/verify/radiosity.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace helio::verify {
namespace {

/** The inside of the unit cube, each face n x n: x = 0, x = 1, y = 0, y = 1, floor z = 0, ceiling z = 1. */
std::vector<Patch> cube(int n, double emission, double reflectance, double floorReflectance,
                        bool onlyFloorEmits) {
    const std::vector<Patch> faces = {{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}};
    std::vector<Patch> parts;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        Patch face = faces[i];
        face.reflectance = i == 4 ? floorReflectance : reflectance;
        face.emission = i == 4 || !onlyFloorEmits ? emission : 0;
        subdivide(face, n, parts);
    }
    return parts;
}

double meanOfFace(const std::vector<double>& radiance, std::size_t face) {
    const std::size_t count = radiance.size() / 6;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += radiance[face * count + i];
    return sum / double(count);
}

TEST(Radiosity, FormFactorsAreTheClosedForms) {
    const Radiosity whole(cube(1, 0, 0, 0, false));
    EXPECT_NEAR(whole.formFactor(4, 5), formFactorParallelRectangles(1, 1, 1), 2e-6);
    EXPECT_NEAR(whole.formFactor(4, 0), formFactorPerpendicularRectangles(1, 1, 1), 5e-4);  // a shared edge
    for (int n : {1, 3}) {
        const Radiosity room(cube(n, 0, 0, 0, false));
        for (std::size_t i = 0; i < room.size(); ++i) {
            double sum = 0;
            for (std::size_t k = 0; k < room.size(); ++k) sum += room.formFactor(i, k);
            EXPECT_NEAR(sum, 1.0, 1e-12) << i;  // point by point, so whatever the quadrature
        }
    }
}

TEST(Radiosity, FurnacesAndTheirBounces) {
    for (double reflectance : {0.2, 0.5, 0.8, 0.9}) {
        const Radiosity room(cube(2, 1, reflectance, reflectance, false));
        for (double radiance : room.solve()) EXPECT_NEAR(radiance, furnaceRadiance(1, reflectance), 1e-11);
        for (int n = 0; n < 6; ++n)
            for (double radiance : room.bounce(n)) EXPECT_NEAR(radiance, std::pow(reflectance, n), 1e-12);
    }
}

/** Truths of the unit cube whose floor emits 1 and reflects nothing, all else 1/2: means of floor, ceiling,
 * walls. */
TEST(Radiosity, CubeOfTheTable) {
    const Radiosity room(cube(8, 1, 0.5, 0, true));
    const std::vector<double> dense = room.solve();
    int iterations = 0;
    const std::vector<double> iterative = room.iterate(1e-14, &iterations);
    for (std::size_t i = 0; i < dense.size(); ++i) ASSERT_NEAR(dense[i], iterative[i], 1e-12);
    EXPECT_NEAR(meanOfFace(dense, 4), 1.0, 1e-12);
    // Patches of constant radiance err by their size squared: two sizes give the limit.
    const std::vector<double> coarse = Radiosity(cube(4, 1, 0.5, 0, true)).solve();
    const auto limit = [&](std::size_t face) {
        return (4 * meanOfFace(dense, face) - meanOfFace(coarse, face)) / 3;
    };
    fmt::print("ceiling {:.6f} -> {:.6f}, wall {:.6f} -> {:.6f}, {} iterations\n", meanOfFace(dense, 5),
               limit(5), meanOfFace(dense, 0), limit(0), iterations);
    EXPECT_NEAR(limit(5), 0.15518, 5e-5);
    EXPECT_NEAR(limit(0), 0.16400, 5e-5);
    // The series sums to the solution, and its tail falls by less than the reflectance a bounce.
    std::vector<double> sum(room.size());
    for (int n = 0; n < 50; ++n) {
        const std::vector<double> term = room.bounce(n);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += term[i];
    }
    for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(sum[i], dense[i], 1e-12);
}

}  // namespace
}  // namespace helio::verify
