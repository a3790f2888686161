/** @file
 * Embeds the engine: builds a scene in code, renders it while watching the progress, renders it again after
 * moving the camera, and cancels a third render. Prints every result's error and time.
 *   embedding [OUTPUT.exr]
 */
#include <heliograph/heliograph.hpp>

#include <cstdio>
#include <exception>

namespace {

/** A floor and a small square lamp above it. */
helio::Scene makeScene() {
    using namespace helio;
    Scene scene;
    scene.name = "embedding";

    Material paper;
    paper.baseColor = {0.7f, 0.6f, 0.5f, 1.0f};
    paper.metallic = 0;
    paper.specular = 0;
    Material lamp;
    lamp.baseColor = {0, 0, 0, 1};
    lamp.metallic = 0;
    lamp.specular = 0;
    lamp.emission = {20, 20, 20};
    scene.materials = {paper, lamp};

    const auto square = [](float half, float height, bool facingUp, int material) {
        Primitive primitive;
        primitive.positions = {
            {-half, height, -half}, {half, height, -half}, {half, height, half}, {-half, height, half}};
        primitive.indices = facingUp ? std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}
                                     : std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3};
        primitive.material = material;
        return primitive;
    };
    scene.meshes.push_back({"room", {square(2, 0, true, 0), square(0.3f, 2, false, 1)}});
    scene.cameras.push_back({.name = "front", .yfov = 0.8f});

    Node room;
    room.mesh = 0;
    Node camera;
    camera.camera = 0;
    camera.translation = {0, 1, 5};
    scene.nodes = {room, camera};
    scene.roots = {0, 1};
    return scene;
}

void report(const char* what, const helio::RenderResult& result) {
    std::printf("%s: %u spp, %.3f s, relMSE %.3g [%.3g, %.3g]%s\n", what, result.samples, result.seconds,
                result.error.relmse, result.error.low, result.error.high,
                result.cancelled ? ", cancelled" : "");
}

}  // namespace

int main(int argc, char** argv) try {
    helio::Scene scene = makeScene();
    helio::Renderer renderer;

    int calls = 0;
    helio::RenderOptions options;
    options.size = {160, 120};
    options.progress = [&](const helio::Progress& progress) {
        ++calls;
        std::printf("%s %3.0f %%\n", progress.stage.c_str(), progress.fraction * 100);
        return true;
    };
    const helio::RenderResult first = renderer.render(scene, options);
    report("first", first);
    if (argc > 1) helio::save(argv[1], first);

    scene.nodes[1].translation.x = 0.5f;
    report("moved camera", renderer.render(scene, options));

    options.samples = 1u << 20;
    options.progress = [](const helio::Progress& progress) { return progress.samples < 16; };
    const helio::RenderResult cancelled = renderer.render(scene, options);
    report("cancelled", cancelled);
    return calls > 0 && cancelled.cancelled && cancelled.samples < options.samples ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "embedding: %s\n", error.what());
    return 1;
}
