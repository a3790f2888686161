#include "passes/raster/view.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace helio {

RasterView makeRasterView(const glm::dmat4& cameraToWorld, const Camera& camera,
                          std::array<std::uint32_t, 2> size, double nearDistance, double farthest) {
    const std::string place = camera.name.empty() ? "camera" : fmt::format("camera {}", camera.name);
    const auto refuse = [&](const std::string& fault, const char* remedy) {
        throw InputError("", place, fault, remedy);
    };
    if (size[0] == 0 || size[1] == 0 || size[0] > kMaxRasterSize || size[1] > kMaxRasterSize)
        refuse(fmt::format("image of {} x {} pixels", size[0], size[1]),
               "choose 1 to 16384 pixels each way for the rasterizer");
    const glm::dvec3 axisY(cameraToWorld[1]), axisZ(cameraToWorld[2]);
    // A sheared transform's axes are made orthogonal again, the view direction kept.
    const glm::dvec3 forward = -axisZ / glm::length(axisZ);
    const glm::dvec3 across = glm::cross(forward, axisY);
    const glm::dvec3 right = across / glm::length(across), up = glm::cross(right, forward);
    if (!std::isfinite(right.x + right.y + right.z))
        refuse("its transform is singular", "correct the node's transform");

    RasterView view;
    // Vertices are floats in world space; the eye is put on the same grid, as rays have it.
    view.eye = glm::dvec3(glm::vec3(glm::dvec3(cameraToWorld[3])));
    view.width = size[0];
    view.height = size[1];
    view.rowW = forward;
    const double halfWidth = 0.5 * size[0], halfHeight = 0.5 * size[1];
    if (camera.perspective) {
        const double tangent = std::tan(0.5 * double(camera.yfov));
        if (!(tangent > 0.0) || !(camera.yfov < 3.1415925f))
            refuse("its field of view is not between 0 and pi", "correct yfov");
        const double focal = halfHeight / tangent;  // pixels
        view.rowX = focal * right + halfWidth * view.rowW;
        view.rowY = -focal * up + halfHeight * view.rowW;
        const double znear = camera.znear > 0.0f ? double(camera.znear) : 1.0;
        view.depthOffset = nearDistance > 0.0 ? nearDistance : 1e-6 * znear;
    } else {
        if (!(std::abs(double(camera.ymag)) > 0.0)) refuse("its height is 0", "correct ymag");
        const double scale = halfHeight / double(camera.ymag);  // pixels per unit
        view.rowX = scale * right;
        view.rowY = -scale * up;
        view.orthographic = true;
        const double begin = nearDistance;
        double end = std::max(farthest, double(camera.znear) + 1.0);
        if (std::isfinite(camera.zfar)) end = std::max(end, double(camera.zfar));
        if (!(end > begin)) end = begin + 1.0;
        view.depthSlope = -1.0 / (end - begin);
        view.depthOffset = end / (end - begin);
    }
    return view;
}

RasterView lensView(const RasterView& view, const ThinLens& lens, const glm::dvec2& point) {
    const glm::dvec3 across = view.rowX - 0.5 * view.width * view.rowW;
    const glm::dvec3 down = view.rowY - 0.5 * view.height * view.rowW;
    const double focal = glm::length(across);  // pixels
    const double radius = 0.5 * double(lens.apertureDiameter);
    RasterView result = view;
    const glm::dvec3 aside = (radius / focal) * (point.x * across - point.y * down);
    result.eye = glm::dvec3(glm::vec3(view.eye + aside));
    // What the point at distance w along the axis moves by, (eye' - eye) (1 / focus - 1 / w), is 0 at the
    // focus.
    const glm::dvec3 moved = result.eye - view.eye;
    const double perFocus = 1.0 / double(lens.focusDistance);
    result.rowX += glm::dot(moved, across) * perFocus * view.rowW;
    result.rowY += glm::dot(moved, down) * perFocus * view.rowW;
    return result;
}

void conventionalDepth(RasterView& view, double farDistance) {
    assert(!view.orthographic && view.depthOffset > 0);
    const double far = farDistance > view.depthOffset ? farDistance : 2 * view.depthOffset;
    view.depthSlope = far / (far - view.depthOffset);
}

double resolvableDepth(const RasterView& view, DepthFormat format, double z) {
    // Reversed depth d and how fast it falls; conventional depth is scale (1 - d).
    const double d = view.orthographic ? view.depthOffset + view.depthSlope * z : view.depthOffset / z;
    const double slope = view.orthographic ? -view.depthSlope : view.depthOffset / (z * z);
    const double scale = view.orthographic ? 1 : view.depthSlope;
    const auto ulp = [](double value) { return std::ldexp(1.0, std::ilogb(value) - 23); };
    switch (format) {
        case DepthFormat::Reversed:
            return ulp(d) / slope;
        case DepthFormat::Float:
            return ulp(scale * (1 - d)) / (scale * slope);
        case DepthFormat::Unorm24:
            return 1 / 16777215.0 / (scale * slope);
        case DepthFormat::Unorm16:
            return 1 / 65535.0 / (scale * slope);
    }
    return 0;
}

}  // namespace helio
