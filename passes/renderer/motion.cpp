#include "passes/renderer/motion.hpp"

#include "passes/renderer/prepared_scene.hpp"

#include <heliograph/pose.hpp>

#include <algorithm>
#include <ranges>

namespace helio {
namespace {

/** Places at which a moving camera is known: turns between two neighbours are straight lines to 1e-4 of their
 * angle for all but whirling cameras. */
constexpr int kCameraPoses = 65;

/** Nodes and cameras alone, which are quick to pose. */
Scene withoutMeshes(const Scene& scene) {
    Scene bare;
    bare.name = scene.name;
    bare.cameras = scene.cameras;
    bare.nodes = scene.nodes;
    bare.roots = scene.roots;
    bare.animations = scene.animations;
    for (Node& node : bare.nodes) {
        node.mesh = node.light = node.skin = node.meter = -1;
        node.weights.clear();
        node.copies.clear();
    }
    for (Animation& animation : bare.animations)
        std::erase_if(animation.channels,
                      [](const AnimationChannel& channel) { return channel.path == AnimationPath::Weights; });
    return bare;
}

bool samePlaces(const std::vector<PlacedLight>& a, const std::vector<PlacedLight>& b) {
    return std::ranges::equal(a, b, {}, &PlacedLight::transform, &PlacedLight::transform);
}

/** Whether surfaces stand in two poses of a scene where they stand in one. */
bool sameSurfaces(const Scene& a, const Scene& b) {
    const auto placedA = a.instances(), placedB = b.instances();
    return std::ranges::equal(placedA, placedB, [&](const Instance& x, const Instance& y) {
        const auto &from = a.meshes[std::size_t(x.mesh)].primitives,
                   &to = b.meshes[std::size_t(y.mesh)].primitives;
        return x.transform == y.transform &&
               std::ranges::equal(from, to, [](const Primitive& p, const Primitive& q) {
                   return p.positions == q.positions && p.normals == q.normals;
               });
    });
}

std::vector<glm::dmat4> cameraPoses(const Scene& scene, const RenderOptions& options, double start,
                                    double duration) {
    const Scene bare = withoutMeshes(scene);
    std::vector<glm::dmat4> poses;
    for (int k = 0; k < kCameraPoses; ++k) {
        const Scene pose = posed(bare, start + duration * k / (kCameraPoses - 1), options.animation);
        if (pose.placedCameras().empty()) return {};
        poses.push_back(chooseView(pose, options.camera, 1).transform);
    }
    const bool moves = std::ranges::any_of(poses, [&](const glm::dmat4& pose) { return pose != poses[0]; });
    return moves ? poses : std::vector<glm::dmat4>();
}

/** When the shutter of the chosen camera opens and closes. */
std::optional<Shutter> shutterOf(const Scene& scene, const RenderOptions& options) {
    std::optional<Shutter> shutter;
    const bool anySays =
        std::ranges::any_of(scene.cameras, [](const Camera& c) { return c.shutter.has_value(); });
    if (anySays) shutter = chooseView(withoutMeshes(scene), options.camera, 1).camera.shutter;
    if (!options.shutter) return shutter;
    const auto [open, close] = *options.shutter;
    return Shutter{open, close, shutter ? shutter->rolling : 0.0};
}

}  // namespace

Motion motionOf(const Scene& scene, const RenderOptions& options) {
    Motion motion;
    const bool namesAnimation = !options.animation.empty() && options.animation != "none";
    if (!needsPose(scene) && !namesAnimation) {
        scene.validate();
        return motion;
    }
    const Shutter shutter = shutterOf(scene, options).value_or(Shutter{});
    const double start = options.frameTime + shutter.open;
    const double open = shutter.close - shutter.open, duration = open + shutter.rolling;
    motion.first = posed(scene, start, options.animation);
    if (!(duration > 0) || scene.animations.empty()) return motion;
    if (options.pipeline == Pipeline::Raster) {
        motion.skipped.emplace_back("motion blur",
                                    "the raster pipeline shows the pose in which the shutter opens");
        return motion;
    }
    for (std::uint32_t k = 1; k <= options.motionSteps; ++k)
        motion.later.push_back(posed(scene, start + duration * k / options.motionSteps, options.animation));
    if (!samePlaces(motion.first->placedLights(), motion.later.back().placedLights()))
        motion.skipped.emplace_back("moving punctual lights", "they shine from where the shutter opens");
    if (std::ranges::all_of(motion.later,
                            [&](const Scene& pose) { return sameSurfaces(*motion.first, pose); }))
        motion.later.clear();
    motion.cameraPoses = cameraPoses(scene, options, start, duration);
    if (!motion.later.empty() || !motion.cameraPoses.empty())
        motion.shutter = {shutter.rolling / duration, open / duration};
    return motion;
}

}  // namespace helio
