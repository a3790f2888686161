#pragma once
/** @file The camera as the rasterizer takes it. shaders/raster/view.glsl says how the rows are used. */
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace helio {

/** Projection to homogeneous pixels (x right, y down, centres at one half) of d = vertex - eye. */
struct RasterView {
    glm::dvec3 eye{0.0};   ///< world; subtracted first, so that nothing is lost far from the origin
    glm::dvec3 rowX{0.0};  ///< X = rowX.d (+ width/2 where orthographic)
    glm::dvec3 rowY{0.0};  ///< Y = rowY.d (+ height/2 where orthographic)
    glm::dvec3 rowW{
        0.0};  ///< distance along the viewing axis = rowW.d: the projective w of a perspective view
    /** Perspective: distance of the near plane; depth = depthOffset / w, and depthSlope is what
     * conventionalDepth() puts there. Orthographic: depth = depthOffset +
     * depthSlope (rowW.d). Depth is 1 at the near plane and falls with distance, 0 is infinitely far. */
    double depthOffset = 0.0;
    double depthSlope = 0.0;
    std::uint32_t width = 0;   ///< pixels
    std::uint32_t height = 0;  ///< pixels
    bool orthographic = false;
};

/** Largest width or height that the rasterizer takes, pixels. */
inline constexpr std::uint32_t kMaxRasterSize = 16384;

/** The view of a placed camera. Pixels are square: the size sets the aspect, the vertical field of view (or
 * ymag) is kept. `nearDistance` is where surfaces begin to be seen; 0 takes a millionth of the camera's znear
 * (or of 1 where that is 0), since rays begin at the eye itself. `farthest` is the greatest distance along
 * the axis that an orthographic depth must tell apart; a perspective view has none. Scale in the camera's
 * transform is ignored, as glTF says. Throws InputError for a camera or size that gives no view. */
RasterView makeRasterView(const glm::dmat4& cameraToWorld, const Camera& camera,
                          std::array<std::uint32_t, 2> size, double nearDistance = 0.0,
                          double farthest = 0.0);

/** The perspective view of a point of a thin lens: `point` in units of the lens's radius, to the right and
 * up. What lies in the sharp plane stays where it is in the image. */
RasterView lensView(const RasterView& view, const ThinLens& lens, const glm::dvec2& point);

/** Gives a perspective view what the conventional depth formats need: a far distance beyond the near one. */
void conventionalDepth(RasterView& view, double farDistance);

/** Least difference of distances along the axis that a view's depths tell apart at the distance z, in theory:
 * a step of the format over the slope of what it holds. */
double resolvableDepth(const RasterView& view, DepthFormat format, double z);

}  // namespace helio
