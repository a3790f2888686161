// Product, transpose, determinant and inverse (row T2) against Eigen in double, ill-conditioned matrices
// included. Errors are relative in the Frobenius norm and held against kappa(A) 4 u.
#include "tests/accuracy/transforms_support.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace {

using namespace helio;
using namespace helio::test;
using namespace helio::shared32;

/// The worst of error / (kappa u) over random matrices, more and more of them nearly singular.
template <class M>
double worstInverse(std::uint32_t seed, double& worstDeterminant) {
    Random random(seed);
    double worst = 0;
    worstDeterminant = 0;
    for (int i = 0; i < series(200'000); ++i) {
        M m = random.matrix<M>();
        if (i % 2) {  // last column near the span of the others
            const float closeness = std::ldexp(1.f, -static_cast<int>(random.between(1, 15)));
            auto last = m[0] * random.between(-1, 1) + m[1] * random.between(-1, 1);
            m[m.length() - 1] = last + m[m.length() - 1] * closeness;
        }
        if (i % 5 == 0)  // rows of different size
            for (int c = 0; c < m.length(); ++c) m[c][0] *= 1000.f;
        const auto exact = toEigen(m);
        const auto inverse = exact.inverse().eval();
        const double kappa = exact.norm() * inverse.norm();
        if (kappa > 1e6) continue;  // beyond what float can represent the input for
        worst = std::max(
            worst, (toEigen(inverseAccurate(m)) - inverse).norm() / inverse.norm() / (kappa * kUnitRoundoff));
        const double det = exact.determinant();
        worstDeterminant =
            std::max(worstDeterminant, std::fabs(determinantAccurate(m) / det - 1) / (kappa * kUnitRoundoff));
    }
    return worst;
}

TEST(TransformsMatrix, InverseAndDeterminantStayWithinTheConditionNumber) {
    double det3, det4;
    const double inverse3 = worstInverse<Mat3>(31, det3), inverse4 = worstInverse<Mat4>(32, det4);
    std::printf("error / (kappa u): inverse 3x3 %.3f, 4x4 %.3f; determinant 3x3 %.3f, 4x4 %.3f\n", inverse3,
                inverse4, det3, det4);
    EXPECT_LE(inverse3, 4);
    EXPECT_LE(inverse4, 4);
    EXPECT_LE(det3, 4);
    EXPECT_LE(det4, 4);
}

template <class M>
void hilbert(double tolerance) {
    M h;
    for (int c = 0; c < h.length(); ++c)
        for (int r = 0; r < h.length(); ++r) h[c][r] = 1.f / static_cast<float>(c + r + 1);
    const auto exact = toEigen(h);  // of the rounded entries
    const auto inverse = exact.inverse().eval();
    const double kappa = exact.norm() * inverse.norm();
    const auto computed = toEigen(inverseAccurate(h));
    const double error = (computed - inverse).norm() / inverse.norm();
    std::printf("Hilbert-%d: kappa %.4g, error %.3g = %.3f kappa u\n", int(h.length()), kappa, error,
                error / (kappa * kUnitRoundoff));
    EXPECT_LE(error, tolerance * kappa * kUnitRoundoff);
    EXPECT_LE((exact * computed - decltype(computed)::Identity()).norm(), 4 * kappa * kUnitRoundoff);
}

TEST(TransformsMatrix, HilbertMatrices) {
    hilbert<Mat3>(4);
    hilbert<Mat4>(4);
    // The inverse of the exact Hilbert matrix is integer: 9 and 16 in the corner. In double, entries rounded.
    shared64::Mat4 h;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) h[c][r] = 1 / static_cast<double>(c + r + 1);
    const shared64::Mat4 inverse = shared64::inverseAccurate(h);
    EXPECT_NEAR(inverse[0][0], 16, 1e-9);
    EXPECT_NEAR(inverse[3][3], 2800, 1e-7);
    EXPECT_NEAR(shared64::determinantAccurate(h) * 6048000, 1, 1e-9);
}

TEST(TransformsMatrix, ProductsAndTransposes) {
    Random random(33);
    double product = 0, transposed = 0;
    for (int i = 0; i < series(300'000); ++i) {
        const Mat4 a = random.matrix<Mat4>(), b = random.matrix<Mat4>();
        const auto ea = toEigen(a), eb = toEigen(b);
        const double scale = ea.norm() * eb.norm();
        product = std::max(product, (toEigen(a * b) - ea * eb).norm() / scale);
        const Mat4 left = transpose(a * b), right = transpose(b) * transpose(a);
        transposed = std::max(transposed, (toEigen(left) - toEigen(right)).norm() / scale);
        ASSERT_EQ(transpose(transpose(a)), a);
        const Mat3 c = random.matrix<Mat3>(), d = random.matrix<Mat3>();
        product = std::max(product, (toEigen(c * d) - toEigen(c) * toEigen(d)).norm() /
                                        (toEigen(c).norm() * toEigen(d).norm()));
    }
    std::printf("product %.3f u, (AB)^T - B^T A^T %.3f u\n", product / kUnitRoundoff,
                transposed / kUnitRoundoff);
    EXPECT_LE(product, 4 * kUnitRoundoff);
    EXPECT_LE(transposed, 4 * kUnitRoundoff);
}

TEST(TransformsMatrix, CofactorsOfSingularMatrices) {
    const Mat3 flat(1, 0, 0, 0, 1, 0, 0, 0, 0);  // squashes z: normals along z survive
    EXPECT_EQ(determinantAccurate(flat), 0.f);
    EXPECT_EQ(cofactorMatrix(flat) * Vec3(0, 0, 1), Vec3(0, 0, 1));
    const Mat4 rankOne(1, 2, 3, 4, 2, 4, 6, 8, 3, 6, 9, 12, 4, 8, 12, 16);
    EXPECT_EQ(determinantAccurate(rankOne), 0.f);
    EXPECT_EQ(inverseAccurate(Mat4(1.f)), Mat4(1.f));
    EXPECT_EQ(inverseAccurate(Mat3(2.f)), Mat3(0.5f));
}

}  // namespace
