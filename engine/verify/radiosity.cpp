#include "engine/verify/radiosity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace helio::verify {
namespace {

Vector at(const Patch& p, double s, double t) {
    Vector x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = p.corner[c] + s * p.u[c] + t * p.v[c];
    return x;
}

Vector unitNormal(const Patch& p) {
    Vector n = {p.u[1] * p.v[2] - p.u[2] * p.v[1], p.u[2] * p.v[0] - p.u[0] * p.v[2],
                p.u[0] * p.v[1] - p.u[1] * p.v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    assert(length > 0);
    for (double& c : n) c /= length;
    return n;
}

}  // namespace

void subdivide(const Patch& patch, int n, std::vector<Patch>& parts) {
    Patch part = patch;
    for (std::size_t c = 0; c < 3; ++c) {
        part.u[c] /= n;
        part.v[c] /= n;
    }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            part.corner = at(patch, double(i) / n, double(j) / n);
            parts.push_back(part);
        }
}

Radiosity::Radiosity(std::span<const Patch> patches) {
    const std::size_t n = patches.size();
    factors_.assign(n * n, 0.0);
    for (const Patch& p : patches) {
        emission_.push_back(p.emission);
        reflectance_.push_back(p.reflectance);
    }
    // Gauss-Legendre on [0, 1].
    constexpr std::array<double, 4> nodes = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                             0.93056815579702629};
    constexpr std::array<double, 4> weights = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                               0.17392742256872693};
    for (std::size_t i = 0; i < n; ++i) {
        const Vector normal = unitNormal(patches[i]);
        for (std::size_t k = 0; k < n; ++k) {
            if (k == i) continue;
            const Patch& q = patches[k];
            const std::array<Vector, 4> corners = {at(q, 0, 0), at(q, 0, 1), at(q, 1, 1), at(q, 1, 0)};
            double sum = 0;
            for (std::size_t a = 0; a < 4; ++a)
                for (std::size_t b = 0; b < 4; ++b)
                    sum += weights[a] * weights[b] *
                           irradiancePolygon(at(patches[i], nodes[a], nodes[b]), normal, corners);
            factors_[i * n + k] =
                std::max(0.0, sum) / std::numbers::pi;  // patches in one plane: rounding alone
        }
    }
}

Radiosity::Radiosity(std::vector<double> factors, std::vector<double> emission,
                     std::vector<double> reflectance)
    : emission_(std::move(emission)), reflectance_(std::move(reflectance)), factors_(std::move(factors)) {
    assert(reflectance_.size() == size() && factors_.size() == size() * size());
}

std::vector<double> Radiosity::apply(const std::vector<double>& radiance) const {
    std::vector<double> result(size());
    for (std::size_t i = 0; i < size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < size(); ++k) sum += formFactor(i, k) * radiance[k];
        result[i] = reflectance_[i] * sum;
    }
    return result;
}

std::vector<double> Radiosity::solve() const {
    const std::size_t n = size();
    std::vector<double> matrix(n * n), x = emission_;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k)
            matrix[i * n + k] = (i == k ? 1.0 : 0.0) - reflectance_[i] * formFactor(i, k);
    // I - K is diagonally dominant: no pivoting is needed.
    for (std::size_t pivot = 0; pivot < n; ++pivot)
        for (std::size_t row = pivot + 1; row < n; ++row) {
            const double factor = matrix[row * n + pivot] / matrix[pivot * n + pivot];
            if (factor == 0) continue;
            for (std::size_t k = pivot; k < n; ++k) matrix[row * n + k] -= factor * matrix[pivot * n + k];
            x[row] -= factor * x[pivot];
        }
    for (std::size_t row = n; row-- > 0;) {
        for (std::size_t k = row + 1; k < n; ++k) x[row] -= matrix[row * n + k] * x[k];
        x[row] /= matrix[row * n + row];
    }
    return x;
}

std::vector<double> Radiosity::iterate(double tolerance, int* iterations, int most,
                                       const std::function<bool()>& goOn) const {
    std::vector<double> radiance = emission_;
    for (int turn = 1;; ++turn) {
        std::vector<double> next = apply(radiance);
        double change = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            next[i] += emission_[i];
            change = std::max(change, std::abs(next[i] - radiance[i]));
        }
        radiance = std::move(next);
        if (iterations != nullptr) *iterations = turn;
        if (change <= tolerance || turn >= most || !goOn()) return radiance;
    }
}

std::vector<double> Radiosity::bounce(int n) const {
    std::vector<double> radiance = emission_;
    for (int i = 0; i < n; ++i) radiance = apply(radiance);
    return radiance;
}

}  // namespace helio::verify
