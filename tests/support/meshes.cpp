#include "tests/support/meshes.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

namespace helio::test {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

/** Hash of a lattice point to [0, 1) (lowbias32, C. Wellons 2018). */
double hashed(int x, int y, int z) {
    std::uint32_t h =
        std::uint32_t(x) * 0x9e3779b1u ^ std::uint32_t(y) * 0x85ebca77u ^ std::uint32_t(z) * 0xc2b2ae3du;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    h ^= h >> 16;
    return double(h) / 4294967296.0;
}

/** Value noise in [0, 1). */
double noise(const glm::dvec3& p) {
    const glm::dvec3 cell = glm::floor(p);
    const glm::dvec3 f = p - cell, fade = f * f * (3.0 - 2.0 * f);
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
        sum += hashed(int(cell.x) + dx, int(cell.y) + dy, int(cell.z) + dz) *
               (dx != 0 ? fade.x : 1 - fade.x) * (dy != 0 ? fade.y : 1 - fade.y) *
               (dz != 0 ? fade.z : 1 - fade.z);
    }
    return sum;
}

double fractal(const glm::dvec3& p) {
    return noise(p) + 0.5 * noise(p * 2.03) + 0.25 * noise(p * 4.1) + 0.125 * noise(p * 8.3);
}

/** Two triangles per cell of a grid of columns x rows cells; `at` is given (i, j). */
void grid(Corners& out, int columns, int rows, const std::function<glm::dvec3(int, int)>& at) {
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const glm::vec3 a(at(i, j)), b(at(i + 1, j)), c(at(i + 1, j + 1)), d(at(i, j + 1));
            for (const glm::vec3& p : {a, b, c, a, c, d}) out.push_back(p);
        }
}

}  // namespace

Corners knot() {
    constexpr int around = 50, along = 700;
    const auto axis = [](double s) {
        const double r = 2.0 + std::cos(3.0 * s);
        return glm::dvec3(r * std::cos(2.0 * s), r * std::sin(2.0 * s), std::sin(3.0 * s));
    };
    Corners out;
    grid(out, along, around, [&](int i, int j) {
        const double s = kTau * (i % along) / along, a = kTau * (j % around) / around;
        const glm::dvec3 tangent = glm::normalize(axis(s + 1e-4) - axis(s - 1e-4));
        const glm::dvec3 side = glm::normalize(glm::cross(tangent, glm::dvec3(0.1, 0.2, 1.0)));
        const glm::dvec3 out_ = std::cos(a) * side + std::sin(a) * glm::cross(tangent, side);
        return axis(s) + out_ * (0.4 + 0.15 * fractal((axis(s) + out_) * 4.0));
    });
    return out;
}

Corners octasphere(int level) {
    const int n = 1 << level;
    Corners out;
    for (int face = 0; face < 8; ++face) {
        const glm::dvec3 sign((face & 1) != 0 ? -1 : 1, (face & 2) != 0 ? -1 : 1, (face & 4) != 0 ? -1 : 1);
        // Integers that sum to n: a corner is computed from the same numbers in every face that has it.
        const auto at = [&](int i, int j) {
            const glm::dvec3 p(i, j, n - i - j);
            return glm::vec3(sign * p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) + 0.0);
        };
        const bool mirrored = sign.x * sign.y * sign.z < 0;
        const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
            out.insert(out.end(), {a, mirrored ? c : b, mirrored ? b : c});
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            }
    }
    return out;
}

Corners landscape(std::size_t triangles) {
    const double scale = std::sqrt(double(triangles) / 1e6);
    Corners out;
    const int side = int(400 * scale);
    const auto height = [](double x, double z) {
        return 1.4 * fractal(glm::dvec3(0.5 * x, 0.0, 0.5 * z)) - 1.2;
    };
    grid(out, side, side, [&](int i, int j) {
        const double x = (double(i) / side - 0.5) * 20, z = (0.5 - double(j) / side) * 20;
        return glm::dvec3(x, height(x, z), z);
    });
    const int columns = int(100 * scale), rows = int(50 * scale);
    for (int b = 0; b < 54; ++b) {
        const glm::dvec3 centre((hashed(b, 1, 0) - 0.5) * 16, 0.3 + 2.5 * hashed(b, 2, 0),
                                (hashed(b, 3, 0) - 0.5) * 16);
        const double radius = 0.35 + 0.8 * hashed(b, 4, 0), roughness = 0.2 + 0.8 * hashed(b, 5, 0);
        grid(out, columns, rows, [&](int i, int j) {
            const double a = kTau * (i % columns) / columns, polar = std::numbers::pi * j / rows;
            const glm::dvec3 d(std::sin(polar) * std::cos(a), std::cos(polar), std::sin(polar) * std::sin(a));
            return centre +
                   d * radius * (1 + roughness * (fractal(d * 3.0 + glm::dvec3(7.0 * b, 0, 0)) - 0.9));
        });
    }
    const int stalks = int(2900 * scale * scale);
    for (int s = 0; s < stalks; ++s) {
        const glm::dvec3 from((hashed(s, 11, 1) - 0.5) * 18, 0, (hashed(s, 12, 1) - 0.5) * 18);
        const glm::dvec3 d = glm::normalize(glm::dvec3(hashed(s, 13, 1) - 0.5, 0.7, hashed(s, 14, 1) - 0.5));
        const glm::dvec3 u = 0.012 * glm::normalize(glm::cross(d, glm::dvec3(1, 0.1, 0))),
                         v = glm::cross(d, u);
        const double length = 0.5 + 2 * hashed(s, 15, 1);
        grid(out, 4, 6, [&](int i, int j) {
            const double a = kTau * (i % 4) / 4;
            return from + d * (length * j / 6) + u * std::cos(a) + v * std::sin(a);
        });
    }
    return out;
}

Corners cloud(std::size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    // The surface met by a line of unit length stays the same.
    const float size = 2.0f / std::sqrt(float(count));
    Corners out;
    out.reserve(count * 3);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 centre = point();
        for (int k = 0; k < 3; ++k) out.push_back(centre + size * point());
    }
    return out;
}

Scene sceneOf(const Corners& corners) {
    Scene scene;
    Primitive primitive;
    primitive.positions = corners;
    for (std::uint32_t i = 0; i < corners.size(); ++i) primitive.indices.push_back(i);
    scene.meshes.push_back({"mesh", {std::move(primitive)}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(std::move(node));
    scene.roots = {0};
    return scene;
}

}  // namespace helio::test
