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
 * fisheyes and lens tables right and up are unit. */
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

/** The frame of a placed meter: right and up are half its sides, w of forward is 1 where light from all sides
 * counts. It is moved forward by the rounding of points whose coordinates are at most `extent`. */
CameraFrame meterFrame(const Meter& meter, const glm::dmat4& transform, const glm::dvec3& extent);

/** When the rows of the image are exposed, as parts of the whole time that is rendered: row j of h from
 * (j + 1/2) / h * `rolling` on, for `open`. */
struct ShutterTimes {
    double rolling = 0, open = 0;
    bool operator==(const ShutterTimes&) const = default;
};

/** What a camera takes beyond its frame. */
struct CameraTable {
    /** uCamera; empty for a pinhole or parallel rays, which need none. Texels:
     * 0: lens radius over the lengths of the frame's right and up, 1 / focus distance, rotation of the blades
     * 1: fisheye: half the field of view in turns, sine of a quarter of it
     * 2: ShutterTimes
     * from 3, for each place of a moving camera: origin; right, its length; up, its length; forward
     * lens table, from LENS_BASE: half the film's width and height, z of the film and of the last surface;
     * scene units of a unit, rings per unit of film radius, what a pupil's area is worth; kPupilRings exit
     * pupils (low, high, side); the surfaces of tracedSurfaces() */
    std::vector<glm::vec4> texels;
    SpecConstants constants;  ///< of kernels compiled with CAMERA_TABLE
};
CameraTable cameraTable(const Camera& camera, double aspect, const ShutterTimes& shutter = {},
                        const std::vector<glm::dmat4>& poses = {});

/** Rings of the film that have an exit pupil each. */
inline constexpr int kPupilRings = 32;

/** Whether the camera's lens is more than a pinhole. */
bool hasLens(const Camera& camera);

}  // namespace helio
