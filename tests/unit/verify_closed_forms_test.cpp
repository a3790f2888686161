// Closed forms against published numbers, and against numerical integration where that is independent.
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace helio::verify {
namespace {

constexpr double pi = std::numbers::pi;
double radians(double degrees) {
    return degrees * pi / 180;
}

TEST(FormFactors, MatchPublishedValues) {
    EXPECT_NEAR(formFactorParallelRectangles(1, 1, 1), 0.199824895698, 1e-12);
    EXPECT_NEAR(formFactorParallelRectangles(1, 1, 2), 0.068589588819, 1e-12);
    EXPECT_NEAR(formFactorParallelRectangles(2, 1, 1), 0.285875384851, 1e-12);
    EXPECT_NEAR(formFactorPerpendicularRectangles(1, 1, 1), 0.200043776075, 1e-12);
    EXPECT_NEAR(formFactorParallelRectangles(1, 1, 1) + 4 * formFactorPerpendicularRectangles(1, 1, 1), 1,
                1e-14);
    EXPECT_NEAR(formFactorCoaxialDisks(1, 1, 1), 0.381966011250, 1e-12);
}

TEST(FormFactors, AreReciprocalAndCloseABox) {
    // l x w x h box: the factors from the floor sum to 1, and area times factor is symmetric.
    const double l = 2, w = 0.7, h = 3.1;
    EXPECT_NEAR(formFactorParallelRectangles(l, w, h) + 2 * formFactorPerpendicularRectangles(l, w, h) +
                    2 * formFactorPerpendicularRectangles(w, l, h),
                1, 1e-13);
    EXPECT_NEAR(w * formFactorPerpendicularRectangles(l, w, h),
                h * formFactorPerpendicularRectangles(l, h, w), 1e-14);
    EXPECT_NEAR(4 * formFactorCoaxialDisks(2, 3, 1.5), 9 * formFactorCoaxialDisks(3, 2, 1.5), 1e-13);
    // A tiny disk sees what a point on the axis does.
    EXPECT_NEAR(formFactorCoaxialDisks(1e-6, 1, 2) * pi / irradianceDisk(1, 2), 1, 1e-11);
}

TEST(Irradiance, MatchesPublishedValues) {
    EXPECT_NEAR(irradianceCentredRectangle(1, 1, 1), 0.752274688454, 1e-12);
    EXPECT_NEAR(irradianceCentredRectangle(2, 2, 1), 1.740839502734, 1e-12);
    EXPECT_NEAR(solidAngleCentredRectangle(1, 1, 1), 0.805431683161, 1e-12);
    EXPECT_NEAR(irradianceDisk(1, 2), pi / 5, 1e-15);
    EXPECT_NEAR(irradianceSphere(1, 3, 0), pi / 9, 1e-15);
    EXPECT_NEAR(irradianceSphere(1, 3, radians(60)), pi / 18, 1e-15);
    EXPECT_NEAR(irradianceSphere(1, 2, radians(90)), 0.090586073706, 1e-12);
    EXPECT_EQ(irradianceSphere(1, 2, radians(120.001)), 0);
    EXPECT_NEAR(formFactorInfiniteWall(0, 1), 0.5, 1e-15);
    EXPECT_NEAR(formFactorInfiniteWall(1, 1), 0.5 * (1 - 1 / std::sqrt(2.0)), 1e-15);
}

TEST(Irradiance, OfAPolygonAgreesWithTheRectangleAndTurnsWithItsOrder) {
    const Vector up = {0, 0, 1}, origin = {0, 0, 0};
    const std::vector<Vector> square = {{0.5, 0.5, 1}, {-0.5, 0.5, 1}, {-0.5, -0.5, 1}, {0.5, -0.5, 1}};
    EXPECT_NEAR(irradiancePolygon(origin, up, square), 0.752274688454, 1e-12);
    const std::vector<Vector> reversed(square.rbegin(), square.rend());
    EXPECT_NEAR(irradiancePolygon(origin, up, reversed), -0.752274688454, 1e-12);
}

TEST(Irradiance, OfAPartlySunkenSphereAgreesWithIntegration) {
    // Integrates cos over the visible cap: sphere of half-angle sigma, centre at theta from the normal.
    for (const double degrees : {65.0, 75.0, 90.0, 105.0, 115.0}) {
        const double theta = radians(degrees), sigma = std::asin(0.5);
        double sum = 0;
        const int n = 2000;
        for (int i = 0; i < n; ++i) {
            const double a = sigma * (i + 0.5) / n;  // angle from the sphere's centre
            for (int k = 0; k < n / 10; ++k) {
                const double phi = pi * (k + 0.5) / (n / 10);
                const double cosine =
                    std::cos(theta) * std::cos(a) + std::sin(theta) * std::sin(a) * std::cos(phi);
                sum += std::max(0.0, cosine) * std::sin(a) * 2 * pi / (n / 10) * sigma / n;
            }
        }
        EXPECT_NEAR(irradianceSphere(1, 2, theta), sum, 2e-5) << degrees;
    }
}

TEST(Enclosures, MatchTheGeometricSeries) {
    EXPECT_DOUBLE_EQ(furnaceRadiance(1, 0.5), 2);
    EXPECT_NEAR(furnaceRadiance(1, 0.9), 10, 1e-13);
    EXPECT_DOUBLE_EQ(furnaceRadiance(1, 0.5, 0), 1);
    EXPECT_DOUBLE_EQ(furnaceRadiance(1, 0.5, 3), 1.875);
    EXPECT_NEAR(sphereCavityRadiance(1, 0.8, 0.1), 0.4, 1e-15);
    EXPECT_NEAR(infinitePlatesRadiance(1, 0.5, 0.8)[0], 1.6666667, 1e-7);
    EXPECT_NEAR(infinitePlatesRadiance(1, 0.5, 0.8)[1], 1.3333333, 1e-7);
}

TEST(Fresnel, MatchesPublishedValues) {
    const auto at = [](double degrees) { return fresnelDielectric(std::cos(radians(degrees)), 1.5); };
    EXPECT_NEAR(at(0).average(), 0.04, 1e-15);
    EXPECT_NEAR(at(30).s, 0.0577961054, 1e-10);
    EXPECT_NEAR(at(45).p, 0.0084664590, 1e-10);
    EXPECT_NEAR(at(60).average(), 0.0891867128, 1e-10);
    EXPECT_NEAR(at(85).average(), 0.6127996453, 1e-10);
    EXPECT_NEAR(at(56.309932474).p, 0, 1e-18);
    EXPECT_NEAR(at(56.309932474).s, 0.147928994083, 1e-11);
    EXPECT_EQ(fresnelDielectric(std::cos(radians(41.82)), 1 / 1.5).average(), 1);
    EXPECT_LT(fresnelDielectric(std::cos(radians(41.80)), 1 / 1.5).average(), 1);
    EXPECT_NEAR(fresnelConductor(1, 0.2, 3.9).average(), 0.951951952, 1e-9);
    EXPECT_NEAR(fresnelConductor(0.5, 0.2, 3.9).s, 0.9762484424, 1e-10);
    EXPECT_NEAR(fresnelConductor(0.5, 0.2, 3.9).p, 0.9155163212, 1e-10);
}

TEST(Fresnel, AveragesMatchPublishedValuesAndQuadrature) {
    EXPECT_NEAR(fresnelDielectricAverage(1.3), 0.061131825, 1e-9);
    EXPECT_NEAR(fresnelDielectricAverage(1.5), 0.091777959, 1e-9);
    EXPECT_NEAR(fresnelDielectricAverage(2.4), 0.210181302, 1e-9);
    EXPECT_NEAR(fresnelDielectricAverage(1 / 1.33), 0.471949149, 1e-9);
    EXPECT_NEAR(fresnelDielectricAverage(1 / 2.0), 0.790149159, 1e-9);
    double sum = 0;
    const int n = 1000000;
    for (int i = 0; i < n; ++i) sum += fresnelDielectric(std::sqrt((i + 0.5) / n), 1.7).average() / n;
    EXPECT_NEAR(fresnelDielectricAverage(1.7), sum, 1e-8);
}

}  // namespace
}  // namespace helio::verify
