#include "engine/scene/gltf/cube_map.hpp"

#include <heliograph/image.hpp>

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helio::gltf {
namespace {

constexpr std::uint32_t widest = 4096;

std::uint32_t widthOf(std::uint32_t size) {
    return std::min(size, widest / 4) * 4;
}

/** RGBD: alpha brings colours below 1. It is at least one step of 8 bits. */
glm::vec3 radianceAt(const TextureImage& image, std::size_t texel) {
    return std::visit(
        [&](const auto& values) -> glm::vec3 {
            using T = typename std::decay_t<decltype(values)>::value_type;
            const T* const c = &values[texel * 4];
            if constexpr (std::is_same_v<T, float>) {
                return {c[0], c[1], c[2]};
            } else {
                constexpr double one = std::numeric_limits<T>::max();
                const double divisor = std::max(c[3] / one, 1 / 255.0);
                return glm::dvec3(srgbDecode(c[0] / one), srgbDecode(c[1] / one), srgbDecode(c[2] / one)) /
                       divisor;
            }
        },
        image.texels);
}

/** Linear faces, and radiance along a direction. */
class Cube {
public:
    explicit Cube(const std::array<const TextureImage*, 6>& faces) {
        for (std::size_t f = 0; f < 6; ++f) {
            sizes_[f] = faces[f]->width;
            faces_[f].resize(std::size_t(sizes_[f]) * sizes_[f]);
            for (std::size_t i = 0; i < faces_[f].size(); ++i) faces_[f][i] = radianceAt(*faces[f], i);
        }
    }

    /** OpenGL 4.6, table 8.19: the face of the greatest component, and s, t on it. */
    glm::vec3 along(const glm::dvec3& d) const {
        const glm::dvec3 a = glm::abs(d);
        if (a.x >= a.y && a.x >= a.z) return on(d.x > 0 ? 0 : 1, (d.x > 0 ? -d.z : d.z) / a.x, -d.y / a.x);
        if (a.y >= a.z) return on(d.y > 0 ? 2 : 3, d.x / a.y, (d.y > 0 ? d.z : -d.z) / a.y);
        return on(d.z > 0 ? 4 : 5, (d.z > 0 ? d.x : -d.x) / a.z, -d.y / a.z);
    }

private:
    /** s and t from -1 to 1; the stored face is flipped. */
    glm::vec3 on(std::size_t face, double s, double t) const {
        const std::uint32_t size = sizes_[face];
        const double last = size - 1.0;
        const double x = std::clamp((1 - s) / 2 * size - 0.5, 0.0, last);
        const double y = std::clamp((1 + t) / 2 * size - 0.5, 0.0, last);
        const auto x0 = std::size_t(x), y0 = std::size_t(y);
        const std::size_t x1 = std::min(x0 + 1, std::size_t(last)), y1 = std::min(y0 + 1, std::size_t(last));
        const auto at = [&](std::size_t column, std::size_t row) {
            return faces_[face][row * size + column];
        };
        const float u = float(x - double(x0)), v = float(y - double(y0));
        return glm::mix(glm::mix(at(x0, y0), at(x1, y0), u), glm::mix(at(x0, y1), at(x1, y1), u), v);
    }

    std::array<std::uint32_t, 6> sizes_{};
    std::array<std::vector<glm::vec3>, 6> faces_;
};

}  // namespace

std::size_t latLongTexels(std::uint32_t size) {
    const std::size_t width = widthOf(size);
    return width * (width / 2);
}

TextureImage latLongOf(const std::array<const TextureImage*, 6>& faces) {
    const Cube cube(faces);
    std::uint32_t size = 1;
    for (const TextureImage* const face : faces) size = std::max(size, face->width);
    TextureImage image;
    image.width = widthOf(size);
    image.height = image.width / 2;
    auto& texels =
        image.texels.emplace<std::vector<float>>(std::size_t(image.width) * image.height * 4, 1.0f);
    // Where faces are finer than the image, each of its texels is the mean of so many samples a side.
    const std::uint32_t side = (size * 4 + image.width - 1) / image.width;
    constexpr double pi = std::numbers::pi;
    tbb::parallel_for(std::uint32_t(0), image.height, [&](std::uint32_t row) {
        for (std::uint32_t column = 0; column < image.width; ++column) {
            glm::dvec3 sum(0.0);
            for (std::uint32_t k = 0; k < side * side; ++k) {
                const double u = (column + (k % side + 0.5) / side) / image.width;
                const double polar = pi * (row + (k / side + 0.5) / side) / image.height;
                const double turn = (0.5 - u) * 2 * pi;  // atan2(x, z)
                const double ring = std::sin(polar);
                sum += cube.along({ring * std::sin(turn), std::cos(polar), ring * std::cos(turn)});
            }
            for (int c = 0; c < 3; ++c)
                texels[(std::size_t(row) * image.width + column) * 4 + std::size_t(c)] =
                    float(sum[c] / (side * side));
        }
    });
    return image;
}

}  // namespace helio::gltf
