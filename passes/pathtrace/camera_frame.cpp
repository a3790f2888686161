#include "passes/pathtrace/camera_frame.hpp"

#include "engine/scene/lens_table.hpp"

#include <cmath>
#include <utility>

namespace helio {
namespace {

constexpr double kTwoPi = 6.283185307179586, kPi = 0.5 * kTwoPi;

/** Half the height of what is seen at distance 1, or of an orthographic image. */
double halfHeight(const Camera& camera) {
    if (camera.projection != Projection::Plane || camera.lensTable) return 1.0;
    return camera.perspective ? std::tan(0.5 * double(camera.yfov)) : double(camera.ymag);
}

/** When rows are exposed, and the camera's places meanwhile. */
void addMotion(const Camera& camera, double aspect, const ShutterTimes& shutter,
               const std::vector<glm::dmat4>& poses, CameraTable& table) {
    table.constants["HAS_TIME"] = true;
    table.texels[2] = glm::vec4(glm::dvec4(shutter.rolling, shutter.open, 0.0, 0.0));
    if (poses.size() < 2) return;
    table.constants["CAMERA_KEYS"] = std::int32_t(poses.size());
    for (const glm::dmat4& pose : poses) {
        const CameraFrame frame = cameraFrame(camera, pose, aspect);
        table.texels.push_back(frame.origin);
        for (const glm::vec4& side : {frame.right, frame.up})
            table.texels.emplace_back(glm::vec3(side), glm::length(glm::vec3(side)));
        table.texels.push_back(frame.forward);
    }
}

void addLensTable(const LensTable& lens, double aspect, CameraTable& table) {
    const ParaxialLens near = paraxial(lens);
    const std::vector<glm::dvec4> surfaces = tracedSurfaces(lens);
    const double height = 0.5 * double(lens.filmHeight), width = height * aspect,
                 reach = std::hypot(width, height);
    const double distance = near.filmDistance;
    table.constants["LENS_BASE"] = std::int32_t(table.texels.size());
    table.constants["LENS_SURFACES"] = std::int32_t(surfaces.size());
    table.texels.emplace_back(glm::dvec4(width, height, surfaces[0].y - distance, surfaces[0].y));
    // An ideal lens of this f-number gives the irradiance pi L / (4 N^2) on the axis: that is shown as L.
    table.texels.emplace_back(glm::dvec4(double(lens.scale), kPupilRings / reach,
                                         4.0 * near.fNumber * near.fNumber / (kPi * distance * distance),
                                         0.0));
    for (const ExitPupil& pupil : exitPupils(lens, reach, kPupilRings))
        table.texels.emplace_back(glm::dvec4(pupil.low, pupil.high, pupil.side, 0.0));
    for (const glm::dvec4& surface : surfaces) table.texels.emplace_back(surface);
}

}  // namespace

CameraFrame cameraFrame(const Camera& camera, const glm::dmat4& transform, double aspect) {
    const glm::dvec3 forward = glm::normalize(-glm::dvec3(transform[2]));
    // A sheared transform's axes are made orthogonal again, the view direction kept.
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(transform[1])));
    const glm::dvec3 up = glm::cross(right, forward);
    const double height = halfHeight(camera);
    const bool isPlane = camera.projection == Projection::Plane && !camera.lensTable;
    const double width = isPlane ? height * aspect : 1.0;
    CameraFrame frame;
    frame.origin = glm::vec4(glm::vec3(glm::dvec3(transform[3])), 1.0f);
    frame.right = glm::vec4(glm::vec3(right * width), 0.0f);
    frame.up = glm::vec4(glm::vec3(up * height), 0.0f);
    frame.forward = glm::vec4(glm::vec3(forward), 0.0f);
    return frame;
}

CameraFrame meterFrame(const Meter& meter, const glm::dmat4& transform, const glm::dvec3& extent) {
    CameraFrame frame = cameraFrame(Camera{}, transform, 1.0);
    const bool isPoint =
        meter.quantity == Meter::Quantity::Irradiance || meter.quantity == Meter::Quantity::Radiance;
    const glm::dvec3 forward(frame.forward);
    const double offset = 0x1.4p-21 * glm::dot(glm::abs(forward), extent);  // 10 * 2^-24, see offset.glsl
    frame.origin += glm::vec4(glm::vec3(forward * offset), 0.0f);
    for (auto& [side, length] : {std::pair{&frame.right, meter.width}, std::pair{&frame.up, meter.height}})
        *side = glm::vec4(glm::normalize(glm::vec3(*side)) * (isPoint ? 0.0f : 0.5f * length), 0.0f);
    const bool hemisphere =
        meter.quantity == Meter::Quantity::Irradiance || meter.quantity == Meter::Quantity::Flux;
    frame.forward.w = hemisphere ? 1.0f : 0.0f;
    return frame;
}

bool hasLens(const Camera& camera) {
    return camera.lens && camera.lens->apertureDiameter > 0;
}

CameraTable cameraTable(const Camera& camera, double aspect, const ShutterTimes& shutter,
                        const std::vector<glm::dmat4>& poses) {
    CameraTable table;
    const bool wide = camera.projection != Projection::Plane, moves = shutter != ShutterTimes{};
    if (!wide && !hasLens(camera) && !moves && !camera.lensTable) return table;
    table.texels.resize(3);
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
    if (moves) addMotion(camera, aspect, shutter, poses, table);
    if (camera.lensTable) addLensTable(*camera.lensTable, aspect, table);
    return table;
}

}  // namespace helio
