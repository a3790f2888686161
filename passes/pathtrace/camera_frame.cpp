#include "passes/pathtrace/camera_frame.hpp"

#include <cmath>

namespace helio {
namespace {

constexpr double kTwoPi = 6.283185307179586;

/** Half the height of what is seen at distance 1, or of an orthographic image. */
double halfHeight(const Camera& camera) {
    if (camera.projection != Projection::Plane) return 1.0;
    return camera.perspective ? std::tan(0.5 * double(camera.yfov)) : double(camera.ymag);
}

}  // namespace

CameraFrame cameraFrame(const Camera& camera, const glm::dmat4& transform, double aspect) {
    const glm::dvec3 forward = glm::normalize(-glm::dvec3(transform[2]));
    // A sheared transform's axes are made orthogonal again, the view direction kept.
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(transform[1])));
    const glm::dvec3 up = glm::cross(right, forward);
    const double height = halfHeight(camera);
    const double width = camera.projection == Projection::Plane ? height * aspect : 1.0;
    CameraFrame frame;
    frame.origin = glm::vec4(glm::vec3(glm::dvec3(transform[3])), 1.0f);
    frame.right = glm::vec4(glm::vec3(right * width), 0.0f);
    frame.up = glm::vec4(glm::vec3(up * height), 0.0f);
    frame.forward = glm::vec4(glm::vec3(forward), 0.0f);
    return frame;
}

bool hasLens(const Camera& camera) {
    return camera.lens && camera.lens->apertureDiameter > 0;
}

CameraTable cameraTable(const Camera& camera, double aspect) {
    CameraTable table;
    const bool wide = camera.projection != Projection::Plane;
    if (!wide && !hasLens(camera)) return table;
    table.texels.resize(2);
    table.constants["PROJECTION"] = std::uint32_t(camera.projection);
    if (hasLens(camera)) {
        const double radius = 0.5 * double(camera.lens->apertureDiameter), height = halfHeight(camera);
        table.texels[0] = glm::vec4(glm::dvec4(radius / (height * aspect), radius / height,
                                               1.0 / double(camera.lens->focusDistance),
                                               double(camera.lens->bladeRotation)));
        table.constants["HAS_LENS"] = true;
        table.constants["BLADES"] = std::int32_t(camera.lens->blades);
    }
    const double half = 0.5 * double(camera.fieldOfView);
    table.texels[1] = glm::vec4(glm::dvec4(half / kTwoPi, std::sin(0.5 * half), 0.0, 0.0));
    return table;
}

}  // namespace helio
