#pragma once
/** @file The camera as kernels take it; the twin of passes/pathtrace/camera.glsl. */
#include <heliograph/kernel.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace helio {

/** World-space frame of a camera for an image of a given aspect. Ray directions are
 * forward + x right + y up with x, y in [-1, 1] (perspective), or start there (orthographic). For panoramas
 * and fisheyes right and up are unit. */
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

/** What a camera takes beyond its frame. */
struct CameraTable {
    /** uCamera; empty for a pinhole or parallel rays, which need none. Texels:
     * 0: lens radius over the lengths of the frame's right and up, 1 / focus distance, rotation of the blades
     * 1: fisheye: half the field of view in turns, sine of a quarter of it */
    std::vector<glm::vec4> texels;
    SpecConstants constants;  ///< of kernels compiled with CAMERA_TABLE
};
CameraTable cameraTable(const Camera& camera, double aspect);

/** Whether the camera's lens is more than a pinhole. */
bool hasLens(const Camera& camera);

}  // namespace helio
