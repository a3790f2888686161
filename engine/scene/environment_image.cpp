// Lookups of images of the surroundings, and their conversion.
#include "engine/scene/cube_faces.hpp"

#include <heliograph/environment.hpp>
#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace helio {
namespace {

using Mapping = EnvironmentMapping;

/** Texels round the horizon. */
std::uint32_t around(Mapping mapping, std::uint32_t width) {
    return mapping == Mapping::LatLong ? width : mapping == Mapping::Cube ? 4 * width : 2 * width;
}
glm::uvec2 shape(Mapping mapping, std::uint32_t size) {
    if (mapping == Mapping::LatLong) return {size, std::max(size / 2, 1u)};
    return {size, mapping == Mapping::Cube ? 6 * size : size};
}

}  // namespace

EnvironmentImage::EnvironmentImage(const TextureImage& image, EnvironmentMapping mapping)
    : mapping_(mapping), width_(image.width), height_(image.height), texels_(std::size_t(width_) * height_) {
    const bool fits = mapping == Mapping::LatLong || (mapping == Mapping::Cube && height_ == 6 * width_) ||
                      (mapping == Mapping::Sphere && height_ == width_);
    if (!fits || texels_.empty())
        throw InputError(
            image.name, "environment",
            fmt::format("{} x {} pixels are no {}", width_, height_,
                        mapping == Mapping::Cube ? "six faces of a cube" : "square about a ball"),
            mapping == Mapping::Cube ? "stack the square faces +X, -X, +Y, -Y, +Z, -Z"
                                     : "cut the image to the ball");
    std::visit(
        [&](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            for (std::size_t i = 0; i < texels_.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c) {
                    const T value = values[i * 4 + c];
                    if constexpr (std::is_same_v<T, float>)
                        texels_[i][glm::length_t(c)] = value;
                    else
                        texels_[i][glm::length_t(c)] =
                            float(srgbDecode(double(value) / double(std::numeric_limits<T>::max())));
                }
        },
        image.texels);
}

glm::vec3 EnvironmentImage::texel(std::int64_t x, std::int64_t y) const {
    return texels_[std::size_t(y) * width_ + std::size_t(x)];
}

/** A texel of a face, or the one across its edge; beyond a corner, the mean of those about it. */
glm::vec3 EnvironmentImage::cubeTexel(std::int64_t face, std::int64_t x, std::int64_t y) const {
    const auto n = std::int64_t(width_);
    const bool outX = x < 0 || x >= n, outY = y < 0 || y >= n;
    if (!outX && !outY) return texel(x, face * n + y);
    const std::int64_t inX = std::clamp(x, std::int64_t(0), n - 1),
                       inY = std::clamp(y, std::int64_t(0), n - 1);
    if (outX && outY)
        return (cubeTexel(face, inX, inY) + cubeTexel(face, x, inY) + cubeTexel(face, inX, y)) / 3.0f;
    // A hair beyond the edge, where the neighbour has the same coordinate along it.
    constexpr double hair = 1e-9;
    const glm::dvec2 at(outX ? (x < 0 ? -hair : 1 + hair) * double(n) : double(x) + 0.5,
                        outY ? (y < 0 ? -hair : 1 + hair) * double(n) : double(y) + 0.5);
    const CubeFace& f = kCubeFaces[face];
    const glm::dvec3 d =
        f.forward + (2 * at.x / double(n) - 1) * f.right + (2 * at.y / double(n) - 1) * f.down;
    const glm::dvec2 p = environmentPosition(Mapping::Cube, width_, height_, d);
    return texel(std::clamp(std::int64_t(p.x), std::int64_t(0), n - 1),
                 std::clamp(std::int64_t(p.y), std::int64_t(0), 6 * n - 1));
}

glm::vec3 EnvironmentImage::alongBall(const glm::dvec2& position) const {
    const glm::dvec2 p = position - 0.5;
    const auto x0 = std::int64_t(std::floor(p.x)), y0 = std::int64_t(std::floor(p.y));
    glm::dvec3 sum(0.0);
    double weights = 0;
    for (std::int64_t k = 0; k < 4; ++k) {
        const std::int64_t x = x0 + (k & 1), y = y0 + (k >> 1);
        if (x < 0 || y < 0 || x >= std::int64_t(width_) || y >= std::int64_t(height_)) continue;
        // Touched by the disc: its nearest point to the middle is inside.
        const double r = width_ / 2.0;
        const auto nearest = [&](std::int64_t i) {
            return std::max(0.0, std::max(double(i) - r, r - double(i) - 1)) / r;
        };
        const double nx = nearest(x), ny = nearest(y);
        if (nx * nx + ny * ny >= 1) continue;
        const double weight = (1 - std::abs(p.x - double(x))) * (1 - std::abs(p.y - double(y))) + 1e-9;
        sum += weight * glm::dvec3(texel(x, y));
        weights += weight;
    }
    return weights > 0 ? glm::vec3(sum / weights) : glm::vec3(0.0f);
}

glm::vec3 EnvironmentImage::along(const glm::dvec3& direction) const {
    const glm::dvec2 position = environmentPosition(mapping_, width_, height_, direction);
    if (mapping_ == Mapping::Sphere) return alongBall(position);
    const auto n = std::int64_t(width_), h = std::int64_t(height_);
    const std::int64_t face = mapping_ == Mapping::Cube ? std::clamp(std::int64_t(position.y / width_),
                                                                     std::int64_t(0), std::int64_t(5))
                                                        : 0;
    const glm::dvec2 p = position - glm::dvec2(0, double(face * n)) - 0.5, corner = glm::floor(p);
    const glm::vec2 f(p - corner);
    const auto at = [&](std::int64_t i, std::int64_t j) {
        const std::int64_t x = std::int64_t(corner.x) + i, y = std::int64_t(corner.y) + j;
        if (mapping_ == Mapping::Cube) return cubeTexel(face, x, y);
        return texel((x + n) % n, std::clamp(y, std::int64_t(0), h - 1));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), f.x), glm::mix(at(0, 1), at(1, 1), f.x), f.y);
}

TextureImage EnvironmentImage::convert(EnvironmentMapping mapping, std::uint32_t size) const {
    const std::uint32_t horizon = around(mapping_, width_);
    if (size == 0) size = std::max(horizon / around(mapping, 1), 1u);
    const glm::uvec2 target = shape(mapping, size);
    if (std::uint64_t(target.x) * target.y > (1u << 26))
        throw InputError("", "environment", fmt::format("{} x {} pixels are too many", target.x, target.y),
                         fmt::format("ask for {} at most", 1u << 26));
    // Points a texel and axis: two at least, and one for each finer texel.
    const std::uint32_t ratio = (horizon + around(mapping, size) - 1) / around(mapping, size);
    const std::uint32_t side = std::clamp(ratio, 2u, 16u);
    TextureImage result{.name = "", .width = target.x, .height = target.y, .texels = std::vector<float>()};
    auto& out = std::get<std::vector<float>>(result.texels);
    out.assign(std::size_t(target.x) * target.y * 4, 0.0f);
    tbb::parallel_for(std::uint32_t(0), target.y, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < target.x; ++x) {
            glm::dvec3 sum(0.0);
            double weights = 0;
            for (std::uint32_t k = 0; k < side * side; ++k) {
                const glm::dvec2 at(x + (k % side + 0.5) / side, y + (k / side + 0.5) / side);
                const auto d = environmentDirection(mapping, target.x, target.y, at);
                if (!d) continue;
                // Solid angle by the position within the texel, where it differs.
                const double weight =
                    mapping == Mapping::LatLong ? std::sqrt(std::max(1 - d->y * d->y, 1e-12)) : 1.0;
                sum += weight * glm::dvec3(along(*d));
                weights += weight;
            }
            float* const texel = &out[(std::size_t(y) * target.x + x) * 4];
            for (glm::length_t c = 0; c < 3; ++c) texel[c] = weights > 0 ? float(sum[c] / weights) : 0.0f;
            texel[3] = 1.0f;
        }
    });
    return result;
}

glm::dvec3 EnvironmentImage::mean() const {
    glm::dvec3 sum(0.0);
    double angle = 0;
    for (std::uint32_t y = 0; y < height_; ++y)
        for (std::uint32_t x = 0; x < width_; ++x) {
            const double weight = texelSolidAngle(mapping_, width_, height_, x, y);
            sum += weight * glm::dvec3(texels_[std::size_t(y) * width_ + x]);
            angle += weight;
        }
    return sum / angle;
}

}  // namespace helio
