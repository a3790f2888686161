#include <heliograph/verify.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace helio::verify {
namespace {

constexpr double pi = std::numbers::pi;

Vector subtract(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

double formFactorParallelRectangles(double a, double b, double d) {
    assert(a > 0 && b > 0 && d > 0);
    const double x = a / d, y = b / d;
    const double sx = std::hypot(1.0, x), sy = std::hypot(1.0, y);
    const double logarithm = 0.5 * (std::log1p(x * x) + std::log1p(y * y) - std::log1p(x * x + y * y));
    return 2 / (pi * x * y) *
           (logarithm + x * sy * std::atan(x / sy) + y * sx * std::atan(y / sx) - x * std::atan(x) -
            y * std::atan(y));
}

double formFactorPerpendicularRectangles(double l, double width, double height) {
    assert(l > 0 && width > 0 && height > 0);
    const double w = width / l, h = height / l;
    const double w2 = w * w, h2 = h * h, r = std::hypot(w, h), s = w2 + h2;
    const double logarithm = std::log1p(w2) + std::log1p(h2) - std::log1p(s) +
                             w2 * (std::log(w2) + std::log1p(s) - std::log1p(w2) - std::log(s)) +
                             h2 * (std::log(h2) + std::log1p(s) - std::log1p(h2) - std::log(s));
    return (w * std::atan(1 / w) + h * std::atan(1 / h) - r * std::atan(1 / r) + 0.25 * logarithm) / (pi * w);
}

double formFactorCoaxialDisks(double r1, double r2, double d) {
    assert(r1 > 0 && r2 > 0 && d > 0);
    const double a = r1 / d, b = r2 / d;
    const double s = 1 + (1 + b * b) / (a * a), ratio = r2 / r1;
    // (s - sqrt(s^2 - 4 ratio^2)) / 2 without cancellation.
    return 2 * ratio * ratio / (s + std::sqrt(s * s - 4 * ratio * ratio));
}

double formFactorInfiniteWall(double d, double h) {
    assert(d >= 0 && h > 0);
    const double r = std::hypot(d, h);
    return 0.5 * h * h / (r * (r + d));  // (1 - d / r) / 2 without cancellation
}

double irradiancePolygon(const Vector& point, const Vector& normal, std::span<const Vector> vertices) {
    assert(vertices.size() >= 3);
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vector a = subtract(vertices[i], point);
        const Vector b = subtract(vertices[(i + 1) % vertices.size()], point);
        const Vector c = cross(a, b);
        const double length = std::sqrt(dot(c, c));
        if (length > 0) sum += std::atan2(length, dot(a, b)) * dot(c, normal) / length;
    }
    return 0.5 * sum;
}

double irradianceCentredRectangle(double a, double b, double h) {
    assert(a > 0 && b > 0 && h > 0);
    const double x = a / 2, y = b / 2, rx = std::hypot(x, h), ry = std::hypot(y, h);
    return 2 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

double solidAngleCentredRectangle(double a, double b, double h) {
    assert(a > 0 && b > 0 && h > 0);
    return 4 * std::atan2(a * b / 4, h * std::sqrt(h * h + (a * a + b * b) / 4));
}

double irradianceDisk(double r, double d) {
    return pi * r * r / (r * r + d * d);
}

double irradianceSphere(double r, double d, double theta) {
    assert(r > 0 && d > r);
    const double sine = r / d, sigma = std::asin(sine), cosine = std::cos(theta);
    if (theta >= pi / 2 + sigma) return 0;
    if (theta <= pi / 2 - sigma) return pi * sine * sine * cosine;
    const double root = std::sqrt((1 - sine) * (1 + sine));  // cos sigma
    const double s = std::sin(theta), cotangent = root / sine * (cosine / s);
    return pi / 2 - std::asin(std::min(1.0, root / s)) +
           sine * sine * cosine * std::acos(std::clamp(-cotangent, -1.0, 1.0)) -
           root * std::sqrt(std::max(0.0, sine * sine - cosine * cosine));
}

double furnaceRadiance(double emission, double reflectance, int bounces) {
    assert(reflectance >= 0 && reflectance < 1);
    const double kept = bounces < 0 ? 1 : 1 - std::pow(reflectance, bounces + 1);
    return emission * kept / (1 - reflectance);
}

double sphereCavityRadiance(double emission, double reflectance, double fraction) {
    assert(reflectance >= 0 && reflectance < 1);
    return reflectance * fraction * emission / (1 - reflectance);
}

std::array<double, 2> infinitePlatesRadiance(double emission, double reflectance1, double reflectance2) {
    const double first = emission / (1 - reflectance1 * reflectance2);
    return {first, reflectance2 * first};
}

Reflectances fresnelDielectric(double cosine, double eta) {
    assert(cosine >= 0 && cosine <= 1 && eta > 0);
    const double sine2 = (1 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1) return {1, 1};
    const double t = std::sqrt(1 - sine2);
    const double s = (cosine - eta * t) / (cosine + eta * t);
    const double p = (eta * cosine - t) / (eta * cosine + t);
    return {s * s, p * p};
}

Reflectances fresnelConductor(double cosine, double n, double k) {
    assert(cosine >= 0 && cosine <= 1);
    const std::complex<double> eta(n, k);
    const std::complex<double> t = std::sqrt(1.0 - (1 - cosine * cosine) / (eta * eta));
    return {std::norm((cosine - eta * t) / (cosine + eta * t)),
            std::norm((eta * cosine - t) / (eta * cosine + t))};
}

double fresnelDielectricAverage(double eta) {
    assert(eta > 0);
    if (eta == 1) return 0;
    // From the dense side by reciprocity: (1 - Fi) n^2 = 1 - Fe.
    if (eta < 1) return 1 - eta * eta * (1 - fresnelDielectricAverage(1 / eta));
    const double n = eta, n2 = n * n, n4 = n2 * n2, m = n2 - 1, p = n2 + 1;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * m * m / (p * p * p) * std::log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / (p * (n4 - 1)) +
           8 * n4 * (n4 + 1) / (p * (n4 - 1) * (n4 - 1)) * std::log(n);
}

}  // namespace helio::verify
