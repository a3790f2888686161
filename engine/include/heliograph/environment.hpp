#pragma once
/** @file
 * Images of the surroundings on the sphere: latitude and longitude, the six faces of a cube, the mirrored
 * ball; where directions lie on them, and conversions. +Y is up, images are seen from inside.
 */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string_view>

namespace helio {

/** How an image covers the sphere of directions; (x, y) are pixels from the upper left corner. */
enum class EnvironmentMapping : std::uint8_t {
    LatLong,  ///< u = x / width = 1/2 - atan2(x, z) / 2 pi, v = y / height = acos(y) / pi
    /** Faces +X, -X, +Y, -Y, +Z, -Z from the top, n x 6n pixels, each as seen from the centre: +-X with +-z
     * to the right and y up, +-Z with -+x to the right and y up, +-Y with x to the right and +-z up
     * (OpenEXR's). */
    Cube,
    /** A mirrored ball in a square, as a distant viewer on the +Z axis sees it: n = (2x/w - 1, 1 - 2y/h, .)
     * is its normal, 2 n.z n - z the direction. Nothing is outside of the disc; its rim is -Z. */
    Sphere,
};

/** "latlong", "cube", "sphere". */
std::optional<EnvironmentMapping> environmentMapping(std::string_view name);
/** Cube where the image is six times as high as wide, ball where it is a square, else lat-long. */
EnvironmentMapping likelyEnvironmentMapping(std::uint32_t width, std::uint32_t height);

/** Direction (unit) of a point of an image of this mapping; none outside a ball's disc. Exact in double. */
std::optional<glm::dvec3> environmentDirection(EnvironmentMapping mapping, std::uint32_t width,
                                               std::uint32_t height, const glm::dvec2& position);
/** Where a direction of any length but 0 lies. */
glm::dvec2 environmentPosition(EnvironmentMapping mapping, std::uint32_t width, std::uint32_t height,
                               const glm::dvec3& direction);
/** Solid angle of a texel, in closed form, sr: those of an image sum to 4 pi. */
double texelSolidAngle(EnvironmentMapping mapping, std::uint32_t width, std::uint32_t height, std::uint32_t x,
                       std::uint32_t y);

/** Linear radiance along a direction, bilinear between texels: across a cube's edges and corners too, round
 * in longitude; a ball takes the texels that its disc touches. */
class EnvironmentImage {
public:
    /** Decodes an image as Environment::image is. Throws InputError unless its shape is the mapping's: any
     * for lat-long, n x 6n for a cube, a square for a ball. */
    EnvironmentImage(const TextureImage& image, EnvironmentMapping mapping);

    glm::vec3 along(const glm::dvec3& direction) const;
    /** The image in another mapping: `size` is the width of lat-long (half as high), of a cube's face and of
     * a ball; 0 keeps about as many texels round the horizon. A texel is the mean over its area. Linear
     * floats, alpha 1. */
    TextureImage convert(EnvironmentMapping mapping, std::uint32_t size = 0) const;
    /** Mean radiance over the sphere. */
    glm::dvec3 mean() const;

private:
    glm::vec3 texel(std::int64_t x, std::int64_t y) const;
    glm::vec3 cubeTexel(std::int64_t face, std::int64_t x, std::int64_t y) const;
    glm::vec3 alongBall(const glm::dvec2& position) const;

    EnvironmentMapping mapping_;
    std::uint32_t width_, height_;
    std::vector<glm::vec3> texels_;
};

}  // namespace helio
