// What a scene may hold and how both pipelines meet it: cameras, texture coordinate sets, extents.

#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

using test::renderer;

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

/** Two texels, red and green, left and right. */
void addTexture(Scene& scene) {
    scene.images.push_back({"two", 2, 1, std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}});
    Texture texture;
    texture.image = 0;
    texture.magFilter = texture.minFilter = Filter::Nearest;
    texture.useMipmaps = false;
    scene.textures = {texture};
}

TEST(RendererInputs, TexturesReadTheCoordinateSetTheyName) {
    for (const Pipeline pipeline : kBoth) {
        for (int set = 0; set < 5; ++set) {
            Scene scene = glowingSquare();
            addTexture(scene);
            // Set 3 is the green half, the others are the red one.
            auto& sets = scene.meshes[0].primitives[0].texcoords;
            for (int s = 0; s < 4; ++s) sets.emplace_back(4, glm::vec2(s == 3 ? 0.75f : 0.25f, 0.5f));
            Material& material = scene.materials[0];
            material.emissiveTexture = {0, set, glm::mat3(1.0f)};
            const auto warned = [](const RenderResult& result) { return !result.warnings.empty(); };
            const RenderResult emitted = renderer().render(scene, small(pipeline));
            EXPECT_NEAR(emitted.image.at(8, 8, 0), set == 3 ? 0.0f : 0.5f, 1e-6) << "set " << set;
            EXPECT_NEAR(emitted.image.at(8, 8, 1), set == 3 ? 0.5f : 0.0f, 1e-6) << "set " << set;
            EXPECT_EQ(warned(emitted), set == 4) << "set " << set;
            // The albedo channel is the base colour, here of another set than the emission.
            material.baseColor = glm::vec4(1.0f);
            material.baseColorTexture = {0, set, glm::mat3(1.0f)};
            material.emissiveTexture.texcoord = 2;
            const RenderResult both = renderer().render(scene, small(pipeline));
            const std::size_t albedo = std::size_t(both.image.channel("albedo.R"));
            EXPECT_NEAR(both.image.at(8, 8, albedo), set == 3 ? 0.0f : 1.0f, 1e-6) << "set " << set;
            EXPECT_NEAR(both.image.at(8, 8, albedo + 1), set == 3 ? 1.0f : 0.0f, 1e-6) << "set " << set;
            EXPECT_EQ(warned(both), set == 4);
            if (set != 4) continue;
            ASSERT_EQ(both.warnings.size(), 1u);
            EXPECT_EQ(both.warnings[0],
                      "mesh 0 primitive 0 has no texture coordinate set 4, which material 0 names: it is "
                      "taken as 0, 0");
        }
    }
}

TEST(RendererInputs, MovingScenesAreShownAsTheyStandAtTheFramesTime) {
    Scene scene = glowingSquare();
    scene.animations = {
        {"leave",
         {{0, AnimationPath::Translation, Interpolation::Linear, {0, 1, 2}, {0, 0, 0, 0, 0, 0, 100, 0, 0}}}}};
    for (const Pipeline pipeline : kBoth) {
        RenderOptions options = small(pipeline);
        options.environment = Environment{};
        const auto middle = [&](double time, const char* animation = "") {
            options.frameTime = time;
            options.animation = animation;
            return renderer().render(scene, options).image.data.at(0);
        };
        EXPECT_EQ(middle(0), 0.5f);
        const std::uint64_t builds = renderer().sceneBuilds();
        EXPECT_EQ(middle(1), 0.5f);
        EXPECT_EQ(renderer().sceneBuilds(), builds) << "the same pose is the same scene";
        EXPECT_EQ(middle(2), 0);
        EXPECT_EQ(middle(2, "none"), 0.5f);
        EXPECT_THROW(middle(0, "walk"), InputError);
        EXPECT_THROW(middle(std::nan("")), InputError);
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

/** A scene with all its distances times 2^power; pictures must not change. */
Scene scaled(Scene scene, int power) {
    Node root;
    root.scale = glm::vec3(std::ldexp(1.0f, power));
    root.children = scene.roots;
    scene.nodes.push_back(root);
    scene.roots = {int(scene.nodes.size()) - 1};
    return scene;
}

TEST(RendererInputs, PicturesAreRightAtEveryScaleThatIsNotWarnedOf) {
    const Scene scene = load("sample:cornell");
    const Scene::Bounds bounds = scene.bounds();
    const glm::dvec3 size = bounds.upper - bounds.lower;
    const double extent = std::max({size.x, size.y, size.z});
    const glm::dvec3 far = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    const glm::dvec3 eye = glm::abs(glm::dvec3(scene.placedCameras().at(0).transform[3]));
    const double reach = std::max({far.x, far.y, far.z, eye.x, eye.y, eye.z});
    const int smallest = int(std::ceil(std::log2(1e-9 / extent)));
    const int largest = int(std::floor(std::log2(1e11 / reach)));
    for (const Pipeline pipeline : kBoth) {
        const RenderResult truth = renderer().render(scene, small(pipeline));
        for (const int power : {smallest, -10, 10, largest}) {
            const RenderResult result = renderer().render(scaled(scene, power), small(pipeline));
            EXPECT_LT(compareImages(result.image, truth.image).relmse, 1e-9) << "2^" << power;
            EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
        }
        for (const int power : {smallest - 1, largest + 1}) {
            const RenderResult result = renderer().render(scaled(scene, power), small(pipeline));
            EXPECT_EQ(result.warnings.size(), 1u) << "2^" << power;
            if (result.warnings.empty()) continue;
            EXPECT_NE(result.warnings[0].find("scale the scene"), std::string::npos) << result.warnings[0];
        }
    }
}

TEST(RendererInputs, VerticesTooFarFromTheirOriginAreWarnedOf) {
    for (const float distance : {1e6f, 1e5f}) {
        Scene scene = glowingSquare();
        for (glm::vec3& p : scene.meshes[0].primitives[0].positions) p.x += distance;
        scene.nodes[0].translation.x = -distance;
        const RenderResult result = renderer().render(scene, small(Pipeline::Raster));
        EXPECT_EQ(result.image.at(8, 8, 0), 0.5f);
        ASSERT_EQ(result.warnings.size(), distance > 5e5f ? 1u : 0u);
        if (!result.warnings.empty()) {
            EXPECT_NE(result.warnings[0].find("mesh 0"), std::string::npos) << result.warnings[0];
        }
    }
}

TEST(RendererInputs, ACameraInASurfaceIsWarnedOf) {
    struct Case {
        glm::vec3 eye;
        bool near;
    };
    // A square of 10 by 10 at z = -2, turned: the limit is some 1.2e-6, to its face, edges and corners.
    for (const auto& [eye, near] : {Case{{1, 2, -2 + 2.5e-7f}, true},
                                    {{3, -1, -2}, true},
                                    {{5, 1, -2}, true},
                                    {{5, 5, -2}, true},
                                    {{1, 2, -2 + 3e-6f}, false},
                                    {{5 + 3e-6f, 1, -2}, false},
                                    {{0, 0, 1}, false}}) {
        Scene scene = glowingSquare();
        const glm::quat turn = glm::normalize(glm::quat(0.8f, 0.3f, -0.4f, 0.2f));
        for (Node& node : scene.nodes) node.rotation = turn;
        // The camera turns with the square, about the origin.
        scene.nodes[1].translation = turn * eye;
        const std::vector<std::string> said = renderer().render(scene, small(Pipeline::Raster)).warnings;
        ASSERT_EQ(said.size(), near ? 1u : 0u) << eye.x << " " << eye.y << " " << eye.z;
        if (near) {
            EXPECT_NE(said[0].find("from a triangle of mesh 0"), std::string::npos) << said[0];
        }
    }
}

TEST(RendererInputs, TrianglesAndMeshesOutOfProportionAreWarnedOf) {
    const auto warnings = [](const Scene& scene) {
        return renderer().render(scene, small(Pipeline::Raster)).warnings;
    };
    for (const float width : {1e-5f, 1e-6f}) {  // times as long as wide: 1e6, 1e7
        Scene scene = glowingSquare();
        for (glm::vec3& p : scene.meshes[0].primitives[0].positions) p.y *= 0.1f * width;
        const std::vector<std::string> said = warnings(scene);
        ASSERT_EQ(said.size(), width < 5e-6f ? 1u : 0u) << width;
        if (!said.empty()) {
            EXPECT_NE(said[0].find("2 triangles are more than"), std::string::npos) << said[0];
        }
    }
    for (const float size : {1e8f, 1e10f}) {
        Scene scene = glowingSquare();
        Node large = scene.nodes[0];
        large.scale = glm::vec3(size);
        scene.nodes.push_back(large);
        scene.roots.push_back(2);
        const std::vector<std::string> said = warnings(scene);
        ASSERT_EQ(said.size(), size > 1e9f ? 1u : 0u) << size;
        if (!said.empty()) {
            EXPECT_NE(said[0].find("times as large as the smallest mesh"), std::string::npos) << said[0];
        }
    }
}

/** A camera's exposure is for the light of the scene: what has none is not shown black. */
TEST(RendererInputs, TheDefaultLightIsNotExposed) {
    Scene scene = glowingSquare();
    const Exposure exposure{16, 0.01f, 100};
    scene.cameras[0].exposure = exposure;
    for (const Pipeline pipeline : kBoth) {
        RenderOptions options = small(pipeline);
        EXPECT_EQ(renderer().render(scene, options).exposure, exposureStops(exposure));
        Scene dark = scene;
        dark.materials[0].emission = glm::vec3(0.0f);
        const RenderResult shown = renderer().render(dark, options);
        EXPECT_EQ(shown.exposure, 0.0);
        EXPECT_TRUE(std::ranges::any_of(shown.warnings, [](const std::string& warning) {
            return warning.find("exposure is left out") != std::string::npos;
        }));
        options.environment = Environment{glm::vec3(2.0f)};
        EXPECT_EQ(renderer().render(dark, options).exposure, exposureStops(exposure));
    }
}

}  // namespace
}  // namespace helio
