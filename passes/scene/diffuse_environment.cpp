#include "passes/scene/packed_scene.hpp"

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace helio::pack {
namespace {

/** Light from one part of the sphere: the integral of radiance times direction, a vector for each channel. On
 * a surface whose horizon does not cut the part, its dot product with the normal is the part's irradiance. */
using Moment = std::array<glm::dvec3, 3>;

constexpr std::uint32_t kParts = 128;  // round the equator; half as many from pole to pole

/** Bilinear, repeating in u, as shaders/scene/environment.glsl looks images up. */
glm::dvec3 lookUp(std::span<const glm::vec3> texels, std::uint32_t width, std::uint32_t height, double u,
                  double v) {
    const double x = u * width - 0.5, y = std::clamp(v * height - 0.5, 0.0, height - 1.0);
    const double left = std::floor(x), top = std::floor(y);
    const auto texel = [&](double column, double row) {
        const auto i = std::size_t(std::min(row, height - 1.0)) * width +
                       std::size_t(std::int64_t(column) + width) % width;
        return glm::dvec3(texels[i]);
    };
    return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), x - left),
                    glm::mix(texel(left, top + 1), texel(left + 1, top + 1), x - left), y - top);
}

glm::dvec3 direction(double u, double v) {
    const double turn = glm::two_pi<double>() * (0.5 - u), angle = glm::pi<double>() * v;
    return {std::sin(angle) * std::sin(turn), std::cos(angle), std::sin(angle) * std::cos(turn)};
}

std::vector<Moment> moments(std::span<const glm::vec3> texels, std::uint32_t width, std::uint32_t height) {
    std::vector<Moment> parts(std::size_t(kParts) * (kParts / 2), Moment{});
    // Points a part and axis: every texel gets one, and where they are few the interpolation is followed.
    const std::uint32_t fine = std::max(4u, std::max(width, 2 * height) / kParts);
    std::vector<glm::dvec3> equator(kParts * fine);
    for (std::uint32_t i = 0; i < kParts * fine; ++i)
        equator[i] = direction((i + 0.5) / (kParts * fine), 0.5);
    tbb::parallel_for(std::uint32_t(0), kParts / 2, [&](std::uint32_t row) {
        const double rows = kParts / 2 * fine, columns = kParts * fine;
        for (std::uint32_t j = row * fine; j < (row + 1) * fine; ++j) {
            const double v = (j + 0.5) / rows;
            const double sine = std::sin(glm::pi<double>() * v), cosine = std::cos(glm::pi<double>() * v);
            const double solidAngle =
                2 * sine * std::sin(glm::half_pi<double>() / rows) * glm::two_pi<double>() / columns;
            for (std::uint32_t i = 0; i < kParts * fine; ++i) {
                const glm::dvec3 light = lookUp(texels, width, height, (i + 0.5) / columns, v) * solidAngle;
                const glm::dvec3 from(sine * equator[i].x, cosine, sine * equator[i].z);
                Moment& part = parts[row * kParts + i / fine];
                for (std::size_t c = 0; c < 3; ++c) part[c] += light[glm::length_t(c)] * from;
            }
        }
    });
    return parts;
}

}  // namespace

std::vector<glm::vec4> diffuseEnvironment(std::span<const glm::vec3> texels, std::uint32_t width,
                                          std::uint32_t height) {
    const std::vector<Moment> parts = moments(texels, width, height);
    std::vector<glm::vec4> table(std::size_t(kDiffuseEnvironmentWidth) * (kDiffuseEnvironmentHeight + 1));
    tbb::parallel_for(std::uint32_t(0), kDiffuseEnvironmentHeight + 1, [&](std::uint32_t row) {
        for (std::uint32_t column = 0; column < kDiffuseEnvironmentWidth; ++column) {
            const glm::dvec3 normal =
                direction(double(column) / kDiffuseEnvironmentWidth, double(row) / kDiffuseEnvironmentHeight);
            glm::dvec3 irradiance(0.0);
            for (const Moment& part : parts)
                for (std::size_t c = 0; c < 3; ++c)
                    irradiance[glm::length_t(c)] += std::max(glm::dot(part[c], normal), 0.0);
            table[row * kDiffuseEnvironmentWidth + column] =
                glm::vec4(glm::vec3(irradiance * glm::one_over_pi<double>()), 0.0f);
        }
    });
    return table;
}

}  // namespace helio::pack
