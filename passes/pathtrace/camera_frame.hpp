#pragma once
/** @file The camera as kernels take it; the twin of CameraFrame in passes/pathtrace/camera.glsl. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

namespace helio {

/** World-space frame of a camera for an image of a given aspect. Ray directions are
 * forward + x right + y up with x, y in [-1, 1] (perspective), or start there (orthographic). */
struct CameraFrame {
    glm::vec4 origin{0.0f};
    glm::vec4 right{0.0f};
    glm::vec4 up{0.0f};
    glm::vec4 forward{0.0f};
};

/** The frame of a placed camera; a scale in the node's transform is left out, as glTF says. The vertical
 * field of view (or height) is the camera's, the horizontal one follows the aspect (width / height). Computed
 * in double. */
CameraFrame cameraFrame(const Camera& camera, const glm::dmat4& transform, double aspect);

}  // namespace helio
