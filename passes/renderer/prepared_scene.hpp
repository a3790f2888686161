#pragma once
/** @file A scene made ready for the device, and how it is found again. */
#include "passes/pathtrace/camera_frame.hpp"
#include "passes/renderer/scene_identity.hpp"
#include "passes/scene/device_scene.hpp"

#include <heliograph/features.hpp>
#include <heliograph/renderer.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace helio {

class RasterSession;

/** The scene on the device with what was found out about it. */
struct PreparedScene {
    PreparedScene(Device& device, const Scene& scene, std::span<const Scene> later, const PackOptions& pack);
    ~PreparedScene();
    Scene::Bounds bounds;  ///< about `origin`
    /** The world's point that what is on the device is relative to: 0, or the middle of a scene that is
     * farther from the world's origin than it is large, whose details floats would lose there. */
    glm::dvec3 origin{0.0};
    DeviceScene deviceScene;
    SceneIdentity identity;
    std::vector<std::string> features;
    std::vector<std::pair<std::string, std::string>> skipped;  ///< what, why
    std::vector<std::string> warnings;                         ///< what is not shown as it is given
    std::unique_ptr<RasterSession> raster;                     ///< of the last size, where there was one
};

/** Keeps the last scene: one whose SceneIdentity and packing are the same is not made again. */
class SceneCache {
public:
    explicit SceneCache(Device& device) : device_(device) {}
    /** The scene under this environment; where it moves, with its poses at `later` times. The one before is
     * destroyed when another is made. */
    PreparedScene& prepare(const Scene& scene, const std::optional<Environment>& environment,
                           std::span<const Scene> later, const PackOptions& pack);
    std::uint64_t builds() const { return builds_; }

private:
    Device& device_;
    SceneIdentity identity_;
    PackOptions pack_;
    std::unique_ptr<PreparedScene> prepared_;
    std::uint64_t builds_ = 0;
};

/** A camera with its place. */
struct View {
    Camera camera;
    glm::dmat4 transform{1.0};
    std::vector<glm::dmat4> poses;  ///< while the shutter is open, where it moves
    ShutterTimes shutter;           ///< where anything moves
    std::vector<std::pair<Meter, glm::dmat4>> meters = {};
};
/** The camera to render with, by chooseCamera's rules, for an image of this aspect (width / height). */
View chooseView(const Scene& scene, const std::string& nameOrIndex, double aspect);

}  // namespace helio
