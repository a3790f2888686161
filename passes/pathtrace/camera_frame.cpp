#include "passes/pathtrace/camera_frame.hpp"

#include <cmath>

namespace helio {

CameraFrame cameraFrame(const Camera& camera, const glm::dmat4& transform, double aspect) {
    const glm::dvec3 forward = glm::normalize(-glm::dvec3(transform[2]));
    // A sheared transform's axes are made orthogonal again, the view direction kept.
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(transform[1])));
    const glm::dvec3 up = glm::cross(right, forward);
    const double height = camera.perspective ? std::tan(0.5 * double(camera.yfov)) : double(camera.ymag);
    CameraFrame frame;
    frame.origin = glm::vec4(glm::vec3(glm::dvec3(transform[3])), 1.0f);
    frame.right = glm::vec4(glm::vec3(right * (height * aspect)), 0.0f);
    frame.up = glm::vec4(glm::vec3(up * height), 0.0f);
    frame.forward = glm::vec4(glm::vec3(forward), 0.0f);
    return frame;
}

}  // namespace helio
