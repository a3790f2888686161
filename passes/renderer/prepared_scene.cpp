#include "passes/renderer/prepared_scene.hpp"

#include "passes/renderer/raster_render.hpp"

namespace helio {

PreparedScene::PreparedScene(Device& device, const Scene& scene, const PackOptions& pack)
    : deviceScene(device, scene, pack), bounds(scene.bounds()), skipped(scene.skipped) {
    const SceneFeatures all(scene);
    features = all.present();
    for (const SceneFeatures::Absent& absent : all.absent()) skipped.emplace_back(absent.name, absent.why);
}

PreparedScene::~PreparedScene() = default;

PreparedScene& SceneCache::prepare(const Scene& scene, const std::optional<Environment>& environment,
                                   const PackOptions& pack) {
    const SceneIdentity identity = identify(scene, environment);
    if (prepared_ && identity == identity_ && pack.tree == pack_.tree &&
        pack.sampleSurfaces == pack_.sampleSurfaces) {
        return *prepared_;
    }
    prepared_.reset();  // before the new one: both need not fit the device
    const bool same = environment.has_value() == scene.environment.has_value() &&
                      (!environment || (environment->radiance == scene.environment->radiance &&
                                        environment->image == scene.environment->image));
    if (same) {
        prepared_ = std::make_unique<PreparedScene>(device_, scene, pack);
    } else {
        Scene lit = scene;
        lit.environment = environment;
        prepared_ = std::make_unique<PreparedScene>(device_, lit, pack);
    }
    identity_ = identity;
    pack_ = pack;
    ++builds_;
    return *prepared_;
}

View chooseView(const Scene& scene, const std::string& nameOrIndex, double aspect) {
    const auto viewOf = [](const Scene& from, const PlacedCamera& placed) {
        return View{from.cameras[std::size_t(placed.camera)], placed.transform};
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
    for (Node& node : bare.nodes) node.mesh = node.light = -1;
    const PlacedCamera placed = chooseCamera(bare, nameOrIndex, aspect);
    return viewOf(bare, placed);
}

}  // namespace helio
