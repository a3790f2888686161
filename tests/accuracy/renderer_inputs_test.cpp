// What a scene may hold and how both pipelines meet it: cameras, texture coordinate sets, extents.
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace helio {
namespace {

Renderer& renderer() {
    // Closed before the shared device's listener reports, see tests/support/device.hpp.
    static Renderer shared(test::deviceOptions());
    return shared;
}

RenderOptions small(Pipeline pipeline) {
    RenderOptions options;
    options.pipeline = pipeline;
    options.size = {16, 16};
    options.samples = 4;
    return options;
}

constexpr Pipeline kBoth[] = {Pipeline::Path, Pipeline::Raster};

/** A black square that emits 0.5, before a camera of its own that sees nothing else, all `scale` times as
 * large as at the origin's 10 units. */
Scene glowingSquare(double scale = 1) {
    Scene scene;
    scene.name = "square";
    Material glow;
    glow.baseColor = {0, 0, 0, 1};
    glow.emission = glm::vec3(0.5f);
    scene.materials = {glow};
    Primitive square;
    for (const glm::dvec3& p :
         {glm::dvec3(-5, -5, -2), glm::dvec3(5, -5, -2), glm::dvec3(5, 5, -2), glm::dvec3(-5, 5, -2)})
        square.positions.emplace_back(p * scale);
    square.indices = {0, 1, 2, 0, 2, 3};
    square.material = 0;
    scene.meshes = {{"square", {square}}};
    scene.cameras = {Camera{}};
    Node object, camera;
    object.mesh = 0;
    camera.camera = 0;
    camera.name = "eye";
    scene.nodes = {object, camera};
    scene.roots = {0, 1};
    return scene;
}

TEST(RendererInputs, ASingularCameraIsRefusedByBothPipelines) {
    for (const Pipeline pipeline : kBoth) {
        for (const glm::vec3& scale : {glm::vec3(0), glm::vec3(1, 0, 1), glm::vec3(1, 1, 0)}) {
            Scene scene = glowingSquare();
            scene.nodes[1].scale = scale;
            try {
                renderer().render(scene, small(pipeline));
                ADD_FAILURE() << "accepted scale " << scale.x << " " << scale.y << " " << scale.z;
            } catch (const InputError& error) {
                EXPECT_EQ(error.place, "node 1 'eye' (camera 0)") << error.what();
                EXPECT_NE(error.fault.find("singular"), std::string::npos) << error.what();
            }
        }
        // Axes of any length but 0 will do.
        Scene scene = glowingSquare();
        scene.nodes[1].scale = {1e-30f, -1e-30f, 1e30f};
        EXPECT_EQ(renderer().render(scene, small(pipeline)).image.at(8, 8, 0), 0.5f);
    }
}

TEST(RendererInputs, LightBeyondWhatAPictureHoldsIsRefused) {
    for (const Pipeline pipeline : kBoth) {
        Scene scene = glowingSquare();
        scene.materials[0].emission = glm::vec3(0x1p100f);
        EXPECT_EQ(renderer().render(scene, small(pipeline)).image.at(8, 8, 0), 0x1p100f);
        scene.materials[0].emission.g = 0x1.000002p100f;
        EXPECT_THROW(renderer().render(scene, small(pipeline)), InputError);
        RenderOptions options = small(pipeline);
        options.environment = Environment{glm::vec3(0x1.000002p100f), -1};
        EXPECT_THROW(renderer().render(glowingSquare(), options), InputError);
    }
}

}  // namespace
}  // namespace helio
