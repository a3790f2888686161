#pragma once
/** @file What the transform tests share: GLM to Eigen in double, norms, random matrices. */
#include "engine/core/shared.hpp"
#include "tests/support/sanitized.hpp"

#include <Eigen/Dense>
#include <random>

namespace helio::test {

constexpr double kUnitRoundoff = 5.9604644775390625e-08;  // of float

template <class M>
auto toEigen(const M& m) {
    constexpr int n = static_cast<int>(M::length());
    Eigen::Matrix<double, n, n> e;
    for (int c = 0; c < n; ++c)
        for (int r = 0; r < n; ++r) e(r, c) = m[c][r];
    return e;
}
inline Eigen::Vector3d toEigen(const shared32::Vec3& v) {
    return {v.x, v.y, v.z};
}
inline Eigen::Vector4d toEigen(const shared32::Vec4& v) {
    return {v.x, v.y, v.z, v.w};
}

/** Largest magnitude of the entries' differences. */
template <class A, class B>
double maxDifference(const A& a, const B& b) {
    return (a - b).cwiseAbs().maxCoeff();
}
/** How far from a rotation: entries of R^T R - I, and det - 1. */
inline double rotationDefect(const shared32::Mat3& m) {
    const Eigen::Matrix3d r = toEigen(m);
    return std::max((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
                    std::fabs(r.determinant() - 1));
}

class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float between(double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(engine_));
    }
    /// Either sign, magnitude 2^low..2^high.
    float magnitude(double low, double high) {
        const double x = std::exp2(std::uniform_real_distribution<double>(low, high)(engine_));
        return static_cast<float>(engine_() & 1 ? x : -x);
    }
    shared32::Vec3 vector(double extent = 1) {
        return {between(-extent, extent), between(-extent, extent), between(-extent, extent)};
    }
    shared32::Vec3 direction() {
        std::normal_distribution<double> normal;
        const glm::dvec3 v(normal(engine_), normal(engine_), normal(engine_));
        return shared32::Vec3(glm::normalize(v));
    }
    template <class M>
    M matrix(double extent = 1) {
        M m;
        for (int c = 0; c < m.length(); ++c)
            for (int r = 0; r < m.length(); ++r) m[c][r] = between(-extent, extent);
        return m;
    }
    std::mt19937_64& engine() { return engine_; }

private:
    std::mt19937_64 engine_;
};

}  // namespace helio::test
