// Scenes at the ends of what numbers can say, each with an answer that is known there.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/stability/measure.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace helio::test {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

RenderOptions options(std::uint32_t size = 8, std::uint32_t samples = 64) {
    return independentSamples(size, samples);
}

RenderResult rendered(const Scene& scene, const RenderOptions& settings) {
    RenderResult result = renderer().render(scene, settings);
    EXPECT_EQ(result.nanCount, 0u);
    for (const float value : result.image.data) {
        if (std::isnan(value)) {
            ADD_FAILURE() << "NaN in the picture";
            break;
        }
    }
    return result;
}

/** Mean of the picture against the truth: within 4.5 standard errors and 1e-5 of it for rounding. */
void expectMean(const Scene& scene, const RenderOptions& settings, double truth, const std::string& what,
                double largestError = 0.02) {
    const Mean m = meanOf(rendered(scene, settings).image);
    EXPECT_LE(std::abs(m.value - truth), 4.5 * m.error + 1e-5 * truth)
        << what << ": " << m.value << " for " << truth << ", standard error " << m.error;
    EXPECT_LE(m.error, largestError * truth) << what << ": too noisy to tell";
}

void expectMean(const KnownScene& known, const RenderOptions& settings, const std::string& what,
                double largestError = 0.02) {
    expectMean(known.scene, settings, known.truth, what, largestError);
}

TEST(Extremes, LightsFromTinyToEndless) {
    for (const int power : {-20, -10, 0, 10, 20})  // sides of 1e-6 to 1e6, one unit away
        expectMean(squareLight(std::ldexp(1.0f, power)), options(8, power > 10 ? 1024 : 256),
                   fmt::format("light of side 2^{}", power), 0.05);
}

TEST(Extremes, AlbedoUpToOne) {
    // Under a sky of 1 a convex white surface shows its albedo.
    for (const float albedo : {0.0f, 0.5f, 0.999f, kBelowOne}) {
        SceneBuilder b;
        b.sphere({0, 0, 0}, 1, 3, false, b.material(glm::vec3(albedo)));
        b.camera({0, 0, 3}, {0, 0, 0}, 0.01f);
        b.scene.environment = Environment{glm::vec3(1.0f), -1};
        expectMean(b.scene, options(), double(albedo), fmt::format("albedo {}", albedo));
    }
    // By a thousand reflections and more.
    for (const float albedo : {0.5f, 0.99f, 0.999f}) {
        const KnownScene known = furnace(albedo);
        EXPECT_EQ(rendered(known.scene, options()).truncatedPaths, 0u);
        expectMean(known, options(), fmt::format("furnace of albedo {}", albedo), 0.06);
    }
}

TEST(Extremes, GlassOfEveryIndexIsWhiteUnderAWhiteSky) {
    for (const float index : {1.0f, 1.0f + 1e-7f, 1.0001f, 1.5f, 3.0f, 10.0f})
        expectMean(glassBall(index), options(16, 64), fmt::format("index {}", index));
}

TEST(Extremes, GlassOfIndexOneIsNotThere) {
    // Behind the ball a wall with a step of brightness, whose picture must not change.
    for (const float index : {1.0f, 1.0f + 1e-7f}) {
        ImageF images[2];
        for (const bool with : {false, true}) {
            SceneBuilder b;
            b.scene = glassBall(index).scene;
            b.scene.environment.reset();
            if (!with) b.scene.roots.erase(b.scene.roots.begin());
            const int dark = b.material(glm::vec3(0.0f), glm::vec3(0.25f));
            const int light = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
            b.quad({-5, -5, -2}, {0, -5, -2}, {0, 5, -2}, {-5, 5, -2}, dark);
            b.quad({0, -5, -2}, {5, -5, -2}, {5, 5, -2}, {0, 5, -2}, light);
            images[with] = rendered(b.scene, options(16, 4)).image;
        }
        EXPECT_LT(compareImages(images[1], images[0]).relmse, 1e-4) << index;
    }
}

void moveCamera(Scene& scene, const glm::vec3& eye) {
    (*scene.nodes.back().matrix)[3] = glm::vec4(eye, 1);
}

TEST(Extremes, CamerasInsideAndOnSurfaces) {
    Material volume;
    volume.metallic = volume.roughness = 0;
    volume.transmission = volume.thickness = 1;
    for (const bool isGltf : {false, true}) {
        KnownScene glass = glassBall(1.5f);
        if (isGltf) glass.scene.materials[0] = volume;
        const auto seen = [&](float z) {
            moveCamera(glass.scene, {0, 0, z});
            return meanOf(rendered(glass.scene, options(16, 64)).image);
        };
        // In a medium of index n all directions bring n^2 times the light, mirrored at the border or not.
        for (const auto& [z, truth] : {std::pair{1.01f, 1.0}, std::pair{0.5f, 2.25}, std::pair{0.0f, 2.25}}) {
            const Mean mean = seen(z);
            EXPECT_NEAR(mean.value, truth, 4.5 * mean.error + 1e-5)
                << "camera at " << z << ", glTF " << isGltf;
            EXPECT_LT(mean.error, 0.1);
        }
        // In the surface itself it is in or out.
        for (const float z : {1.0f, kBelowOne, 0x1.000002p+0f}) {
            const Mean mean = seen(z);
            EXPECT_GT(mean.value, 1 - 4.5 * mean.error - 1e-5) << z;
            EXPECT_LT(mean.value, 2.25 + 4.5 * mean.error + 1e-5) << z;
        }
    }
    for (const float z : {1.0f, kBelowOne, 0.0f}) {
        KnownScene room = furnace(0.5f);  // in a wall's plane, looking into the room
        moveCamera(room.scene, {0.1f, 0.2f, z});
        expectMean(room, options(), fmt::format("camera in a wall at {}", z));
    }
}

TEST(Extremes, SliversAndNeedles) {
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const ImageF image = rendered(slivers(1e7).scene, independentSamples(32, 16, pipeline)).image;
        // No light leaks in. A ray may meet the neighbour of the sliver it leaves, whose inside is wrong by a
        // third of its width at this aspect, once in fifty.
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 32; ++x) ASSERT_LT(image.at(x, y, 0), 0.50001f) << x << ", " << y;
        EXPECT_GT(meanOf(image).value, pipeline == Pipeline::Path ? 0.49 : 0.49999);
    }
}

/** A plane of triangles as small as a hundred times the rounding of their corners: a ray that leaves one must
 * not meet its neighbours. Every path of the plane's open side brings half of the sky's light. */
TEST(Extremes, NeighboursInAPlaneCastNoShadows) {
    SceneBuilder b;
    const int grey = b.material(glm::vec3(0.5f));
    const glm::dvec3 middle(0.7, 0.9, -0.4), normal = glm::normalize(glm::dvec3(0.3, -0.5, 0.81));
    const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(normal, across);
    constexpr int cells = 64;
    constexpr double cell = 2e-5;
    const auto at = [&](int i, int j) {
        return glm::vec3(middle + cell * (double(i - cells / 2) * across + double(j - cells / 2) * up));
    };
    std::vector<glm::vec3> corners;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (const glm::vec3& p :
                 {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
                corners.push_back(p);
    b.triangles(corners, grey);
    // As far on the other side of the origin, so that the scene's middle is there; behind the plane.
    const glm::vec3 other = -2.0f * glm::vec3(normal) - glm::vec3(middle);
    b.quad(other, other + glm::vec3(across) * 0.1f, other + glm::vec3(across + up) * 0.1f,
           other + glm::vec3(up) * 0.1f, grey);
    b.camera(glm::vec3(middle + 2e-4 * normal), glm::vec3(middle), 1.0f, glm::vec3(up));
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    const Mean mean = meanOf(rendered(b.scene, options(16, 256)).image);
    EXPECT_NEAR(mean.value, 0.5, 2e-4);
}

TEST(Extremes, NearAndFarInOnePicture) {
    // A card a millionth away before one a million away: depths of ratio 1e12.
    SceneBuilder b;
    const int near = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
    const int far = b.material(glm::vec3(0.0f), glm::vec3(2.0f));
    b.quad({-1e-6f, -1e-6f, -1e-6f}, {0, -1e-6f, -1e-6f}, {0, 1e-6f, -1e-6f}, {-1e-6f, 1e-6f, -1e-6f}, near);
    b.quad({-1e6f, -1e6f, -1e6f}, {1e6f, -1e6f, -1e6f}, {1e6f, 1e6f, -1e6f}, {-1e6f, 1e6f, -1e6f}, far);
    b.camera({0, 0, 0}, {0, 0, -1}, 1.5f);
    b.scene.cameras[0].znear = 1e-7f;
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        RenderOptions settings = options(16, 4);
        settings.pipeline = pipeline;
        const ImageF image = rendered(b.scene, settings).image;
        for (std::uint32_t y = 0; y < 16; ++y)
            for (std::uint32_t x = 0; x < 16; ++x)
                EXPECT_EQ(image.at(x, y, 0), x < 8 ? 1.0f : 2.0f) << x << ", " << y;
    }
}

TEST(Extremes, TexturesOfBrokenFloats) {
    // What is no number or no light counts as black or as the largest light; nothing else of the picture
    // changes.
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), infinity, -infinity, 1e38f, -1.0f}) {
        for (const bool emissive : {false, true}) {
            SceneBuilder b;
            const int wall = b.material(glm::vec3(emissive ? 0.5f : 1.0f), glm::vec3(emissive ? 1.0f : 0.0f));
            Material& material = b.scene.materials[std::size_t(wall)];
            TextureImage image{"broken", 2, 1, std::vector<float>{0.5f, 0.5f, 0.5f, 1, bad, bad, bad, 1}};
            b.scene.images = {image};
            b.scene.textures = {Texture{"broken", 0, Wrap::ClampToEdge, Wrap::ClampToEdge, Filter::Nearest,
                                        Filter::Nearest, false}};
            (emissive ? material.emissiveTexture : material.baseColorTexture).texture = 0;
            b.quad({-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, wall);
            b.scene.meshes[0].primitives[0].texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}};
            b.camera({0, 0, 0}, {0, 0, -1}, 1.0f);
            b.scene.environment = Environment{glm::vec3(1.0f), -1};
            for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
                RenderOptions settings = options(8, 16);
                settings.pipeline = pipeline;
                settings.textureFilter = TextureFilter::Nearest;
                try {
                    const ImageF picture = rendered(b.scene, settings).image;
                    for (std::uint32_t y = 0; y < 8; ++y)
                        EXPECT_NEAR(picture.at(1, y, 0), emissive ? 1.0f : 0.5f, 0.2f) << bad << emissive;
                    for (const float value : picture.data) ASSERT_TRUE(std::isfinite(value)) << bad;
                } catch (const InputError& error) {  // as good: said clearly
                    EXPECT_NE(std::string(error.what()).find("broken"), std::string::npos) << error.what();
                }
            }
        }
    }
}

TEST(Extremes, EveryRoughnessKeepsAWhiteFurnace) {
    for (const float roughness : {0.0f, 1e-4f, 0.03f, 0.5f, 1.0f}) {
        const Mean m = meanOf(rendered(metalBall(roughness).scene, options(16, 64)).image);
        EXPECT_LT(m.value, 1 + 4.5 * m.error + 1e-5) << roughness;
        EXPECT_GT(m.value, roughness < 0.1f ? 0.99 : 0.4) << roughness;
    }
}

}  // namespace
}  // namespace helio::test
