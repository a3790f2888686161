// Directions and solid angles of the mappings of the sphere.
#include "engine/scene/cube_faces.hpp"

#include <heliograph/environment.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helio {
namespace {

constexpr double kPi = std::numbers::pi;

/** Solid angle of the part of the plane z = 1 between 0 and (x, y). */
double cornerAngle(double x, double y) {
    return std::atan2(x * y, std::sqrt(x * x + y * y + 1));
}

/** Area of the unit disc between 0 and (x, y), with the sign of x y. */
double discArea(double x, double y) {
    const double a = std::min(std::abs(x), 1.0), b = std::min(std::abs(y), 1.0);
    const double sign = std::signbit(x) == std::signbit(y) ? 1 : -1;
    if (a * a + b * b <= 1) return sign * a * b;
    const double edge = std::sqrt((1 - b) * (1 + b));
    const auto under = [](double t) { return 0.5 * (t * std::sqrt((1 - t) * (1 + t)) + std::asin(t)); };
    return sign * (edge * b + under(a) - under(edge));
}

}  // namespace

std::optional<EnvironmentMapping> environmentMapping(std::string_view name) {
    if (name == "latlong") return EnvironmentMapping::LatLong;
    if (name == "cube") return EnvironmentMapping::Cube;
    if (name == "sphere") return EnvironmentMapping::Sphere;
    return {};
}

EnvironmentMapping likelyEnvironmentMapping(std::uint32_t width, std::uint32_t height) {
    if (height == width) return EnvironmentMapping::Sphere;
    return std::uint64_t(height) == 6 * std::uint64_t(width) ? EnvironmentMapping::Cube
                                                             : EnvironmentMapping::LatLong;
}

std::optional<glm::dvec3> environmentDirection(EnvironmentMapping mapping, std::uint32_t width,
                                               std::uint32_t height, const glm::dvec2& position) {
    if (mapping == EnvironmentMapping::LatLong) {
        const double turn = (0.5 - position.x / width) * 2 * kPi, polar = kPi * position.y / height;
        const double ring = std::sin(polar);
        return glm::dvec3(ring * std::sin(turn), std::cos(polar), ring * std::cos(turn));
    }
    if (mapping == EnvironmentMapping::Cube) {
        const auto face =
            std::clamp(std::int64_t(std::floor(position.y / width)), std::int64_t(0), std::int64_t(5));
        const double s = 2 * position.x / width - 1, t = 2 * (position.y / width - double(face)) - 1;
        const CubeFace& f = kCubeFaces[face];
        return glm::normalize(f.forward + s * f.right + t * f.down);
    }
    const glm::dvec2 n(2 * position.x / width - 1, 1 - 2 * position.y / height);
    const double aside = glm::dot(n, n);
    if (aside > 1) return {};
    const double z = std::sqrt(1 - aside);
    return glm::dvec3(2 * z * n.x, 2 * z * n.y, 1 - 2 * aside);
}

glm::dvec2 environmentPosition(EnvironmentMapping mapping, std::uint32_t width, std::uint32_t height,
                               const glm::dvec3& direction) {
    const glm::dvec3 d = glm::normalize(direction);
    if (mapping == EnvironmentMapping::LatLong)
        return {(0.5 - std::atan2(d.x, d.z) / (2 * kPi)) * width,
                std::atan2(std::hypot(d.x, d.z), d.y) / kPi * height};
    if (mapping == EnvironmentMapping::Cube) {
        const glm::dvec3 a = glm::abs(d);
        const int face = a.x >= a.y && a.x >= a.z ? (d.x > 0 ? 0 : 1)
                         : a.y >= a.z             ? (d.y > 0 ? 2 : 3)
                                                  : (d.z > 0 ? 4 : 5);
        const CubeFace& f = kCubeFaces[face];
        const double depth = glm::dot(d, f.forward);
        // The lower edge belongs to this face, not to the one below in the image.
        const double y = ((glm::dot(d, f.down) / depth + 1) / 2 + face) * width;
        return {(glm::dot(d, f.right) / depth + 1) / 2 * width,
                std::clamp(y, double(face) * width, std::nextafter((face + 1.0) * width, 0.0))};
    }
    // The normal is halfway between the direction and +Z; towards -Z any point of the rim.
    const double length = std::hypot(d.x, d.y), scale = std::sqrt(2 * (1 + std::max(d.z, 0.0)));
    // sin of half the angle to +Z: from 1 - z or from x and y, where it does not cancel.
    const double radius = d.z > 0 ? length / scale : std::sqrt((1 - d.z) / 2);
    const glm::dvec2 n = length > 0 ? glm::dvec2(d.x, d.y) / length * radius : glm::dvec2(d.z > 0 ? 0 : 1, 0);
    return {(n.x + 1) / 2 * width, (1 - n.y) / 2 * height};
}

double texelSolidAngle(EnvironmentMapping mapping, std::uint32_t width, std::uint32_t height, std::uint32_t x,
                       std::uint32_t y) {
    if (mapping == EnvironmentMapping::LatLong) {
        const double middle = kPi * (y + 0.5) / height;
        return 2 * kPi / width * 2 * std::sin(middle) * std::sin(kPi / (2 * height));
    }
    const auto difference = [](const auto& area, double x0, double x1, double y0, double y1) {
        return area(x1, y1) - area(x0, y1) - area(x1, y0) + area(x0, y0);
    };
    if (mapping == EnvironmentMapping::Cube) {
        const std::uint32_t row = y % width;
        const auto edge = [&](std::uint32_t i) { return 2.0 * i / width - 1; };
        return difference(cornerAngle, edge(x), edge(x + 1), edge(row), edge(row + 1));
    }
    // The ball is seen in equal areas: mirroring doubles angles, and the disc's area is the cosine's.
    const double x0 = 2.0 * x / width - 1, x1 = 2.0 * (x + 1) / width - 1;
    const double y0 = 2.0 * y / height - 1, y1 = 2.0 * (y + 1) / height - 1;
    return 4 * difference(discArea, x0, x1, y0, y1);
}

}  // namespace helio
