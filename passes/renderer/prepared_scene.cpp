#include "passes/renderer/prepared_scene.hpp"

#include "passes/renderer/raster_render.hpp"
#include "passes/renderer/scene_warnings.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

/** Refuses a camera without a direction of view or without an upright: every pipeline makes its axes from its
 * node's -Z and Y, whatever their lengths. */
void checkAxes(const Scene& scene, const PlacedCamera& placed) {
    const auto unit = [](const glm::dvec3& v) {
        // By the largest component first: squares of what a double holds need not fit a double.
        const double size = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return glm::normalize(v / size);
    };
    const glm::dvec3 up = unit(glm::dvec3(placed.transform[1])), back = unit(glm::dvec3(placed.transform[2]));
    if (glm::length(glm::cross(up, back)) > 1e-6) return;  // false for NaN
    const std::string& name = placed.node < 0 ? std::string() : scene.nodes[std::size_t(placed.node)].name;
    throw InputError(scene.name,
                     fmt::format("node {}{} (camera {})", placed.node, name.empty() ? "" : " '" + name + "'",
                                 placed.camera),
                     "its transform is singular: the camera has no direction or no upright",
                     "give the camera's node and its parents scales that are not 0");
}

glm::dvec3 originOf(const Scene::Bounds& bounds) {
    if (bounds.empty()) return glm::dvec3(0.0);
    const glm::dvec3 centre = 0.5 * bounds.lower + 0.5 * bounds.upper, size = bounds.upper - bounds.lower;
    const double distance = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
    return distance > std::max({size.x, size.y, size.z}) ? centre : glm::dvec3(0.0);
}

PackOptions about(PackOptions pack, const glm::dvec3& origin) {
    pack.origin = origin;
    return pack;
}

}  // namespace

PreparedScene::PreparedScene(Device& device, const Scene& scene, std::span<const Scene> later,
                             const PackOptions& pack)
    : bounds(scene.bounds()),
      origin(originOf(bounds)),
      deviceScene(device, scene, later, about(pack, origin)),
      skipped(scene.skipped),
      warnings(deviceScene.info().warnings) {
    bounds.lower -= origin;
    bounds.upper -= origin;
    warnOfPrecision(scene, warnings);
    warnOfProportions(scene, warnings);
    const SceneFeatures all(scene);
    features = all.present();
    for (const SceneFeatures::Absent& absent : all.absent()) skipped.emplace_back(absent.name, absent.why);
}

PreparedScene::~PreparedScene() = default;

PreparedScene& SceneCache::prepare(const Scene& scene, const std::optional<Environment>& environment,
                                   std::span<const Scene> later, const PackOptions& pack) {
    SceneIdentity identity = identify(scene, environment);
    for (const Scene& pose : later) {
        const SceneIdentity next = identify(pose, environment);
        for (std::size_t i = 0; i < 2; ++i)
            identity.words[i] = (identity.words[i] + next.words[i]) * 0x9e3779b97f4a7c15ull;
    }
    if (prepared_ && identity == identity_ && pack == pack_) {
        return *prepared_;
    }
    prepared_.reset();  // before the new one: both need not fit the device
    const bool same = environment == scene.environment;
    if (same) {
        prepared_ = std::make_unique<PreparedScene>(device_, scene, later, pack);
    } else {
        Scene lit = scene;
        lit.environment = environment;
        prepared_ = std::make_unique<PreparedScene>(device_, lit, later, pack);
    }
    prepared_->identity = identity;
    identity_ = identity;
    pack_ = pack;
    ++builds_;
    return *prepared_;
}

View chooseView(const Scene& scene, const std::string& nameOrIndex, double aspect) {
    const auto viewOf = [](const Scene& from, const PlacedCamera& placed) {
        checkAxes(from, placed);
        return View{from.cameras[std::size_t(placed.camera)], placed.transform, {}, {}};
    };
    // chooseCamera adds a camera to a scene that has none, hence the copies; meshes are needed only then.
    if (scene.placedCameras().empty()) {
        Scene framed = scene;
        const PlacedCamera placed = chooseCamera(framed, nameOrIndex, aspect);
        return viewOf(framed, placed);
    }
    Scene bare;
    bare.name = scene.name;
    bare.cameras = scene.cameras;
    bare.nodes = scene.nodes;
    bare.roots = scene.roots;
    for (Node& node : bare.nodes) node.mesh = node.light = node.meter = -1;
    const PlacedCamera placed = chooseCamera(bare, nameOrIndex, aspect);
    return viewOf(bare, placed);
}

}  // namespace helio
