#pragma once
/** @file What moves while the shutter is open. */
#include "passes/pathtrace/camera_frame.hpp"

#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace helio {

/** A scene's poses over the time that its rendered rows are exposed. */
struct Motion {
    /** As the shutter opens; none where the scene has no poses. */
    std::optional<Scene> first;
    std::vector<Scene> later;             ///< evenly over the time; empty where no surface moves
    std::vector<glm::dmat4> cameraPoses;  ///< likewise; empty where the camera stands still
    ShutterTimes shutter;                 ///< zero where nothing moves
    std::vector<std::pair<std::string, std::string>> skipped;  ///< what moves and is shown still, why
};

/** Throws what posed() throws. */
Motion motionOf(const Scene& scene, const RenderOptions& options);

}  // namespace helio
