// Scenes at the ends of what numbers can say, each with an answer that is known there.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kBelowOne = 0x1.fffffep-1f;

Renderer& renderer() {
    // Closed before the shared device's listener reports, see tests/support/device.hpp.
    static Renderer shared(deviceOptions());
    return shared;
}

RenderOptions options(std::uint32_t size = 8, std::uint32_t samples = 64) {
    RenderOptions result;
    result.size = {size, size};
    result.samples = samples;
    result.sampler = SamplerKind::Independent;
    return result;
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

struct Mean {
    double value = 0, error = 0;
};
Mean mean(const ImageF& image, const char* channel = "R") {
    const std::size_t pixels = std::size_t(image.width) * image.height, stride = image.channels.size();
    const auto x = std::size_t(image.channel(channel));
    const auto v = std::size_t(image.channel(std::string("variance.") + channel));
    Mean result;
    for (std::size_t i = 0; i < pixels; ++i) {
        result.value += image.data[i * stride + x] / double(pixels);
        result.error += image.data[i * stride + v] / double(pixels) / double(pixels);
    }
    result.error = std::sqrt(result.error);
    return result;
}

/** Mean of the picture against the truth: within 4.5 standard errors and 1e-5 of it for rounding. */
void expectMean(const Scene& scene, const RenderOptions& settings, double truth, const std::string& what,
                double largestError = 0.02) {
    const Mean m = mean(rendered(scene, settings).image);
    EXPECT_LE(std::abs(m.value - truth), 4.5 * m.error + 1e-5 * truth)
        << what << ": " << m.value << " for " << truth << ", standard error " << m.error;
    EXPECT_LE(m.error, largestError * truth) << what << ": too noisy to tell";
}

/** A white patch at the origin that faces +z, seen so that the picture is its irradiance over pi. */
void addReceiver(SceneBuilder& b, float half) {
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.camera({3 * half, 0.5f * half, 0.4f * half}, {0, 0, 0}, 2e-3f, {0, 0, 1});
}

TEST(Extremes, LightsFromTinyToEndless) {
    for (const int power : {-20, -10, 0, 10, 20}) {  // sides of 1e-6 to 1e6, one unit away
        const float side = std::ldexp(1.0f, power);
        SceneBuilder b;
        addReceiver(b, 1e-3f);
        const float h = side / 2;
        // Constant flux while it is small, constant radiance once it is large.
        const float radiance = side < 1 ? 1 / (side * side) : 1;
        b.quad({-h, -h, 1}, {-h, h, 1}, {h, h, 1}, {h, -h, 1},
               b.material(glm::vec3(0.0f), glm::vec3(radiance)));
        const double truth = verify::irradianceCentredRectangle(side, side, 1) * radiance / kPi;
        expectMean(b.scene, options(8, power > 10 ? 1024 : 256), truth,
                   fmt::format("light of side 2^{}", power), 0.05);
    }
}

TEST(Extremes, AlbedoUpToOne) {
    // Under a sky of 1 a white surface is 1, whatever happens between its parts.
    for (const float albedo : {0.0f, 0.5f, 0.999f, kBelowOne}) {
        SceneBuilder b;
        b.sphere({0, 0, 0}, 1, 3, false, b.material(glm::vec3(albedo)));
        b.camera({0, 0, 0.9999f}, {0, 0, 0}, 0.01f);
        b.scene.cameras[0].perspective = false;
        b.scene.cameras[0].ymag = 0.2f;
        b.scene.nodes.back().translation = {0, 0, 3};
        b.scene.environment = Environment{glm::vec3(1.0f), -1};
        expectMean(b.scene, options(), double(albedo), fmt::format("albedo {}", albedo));
    }
    // Closed: 1 / (1 - albedo) times what is emitted, by a thousand reflections and more.
    for (const float albedo : {0.5f, 0.99f, 0.999f}) {
        SceneBuilder b;
        const int wall = b.material(glm::vec3(albedo), glm::vec3(1.0f));
        b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
        b.camera({0.1f, 0.2f, 0.3f}, {0.5f, 0.1f, -1}, 1.0f);
        RenderResult result = rendered(b.scene, options(8, 64));
        EXPECT_EQ(result.truncatedPaths, 0u);
        expectMean(b.scene, options(8, 64), 1 / (1 - double(albedo)),
                   fmt::format("furnace of albedo {}", albedo), 0.06);
    }
}

Scene glassBall(float ior, bool withSky = true) {
    SceneBuilder b;
    const int glass = b.material(glm::vec3(1.0f));
    Scattering dielectric;
    dielectric.model = Scattering::Model::Dielectric;
    dielectric.n = glm::vec3(ior);
    b.scene.materials[std::size_t(glass)].scattering = dielectric;
    b.sphere({0, 0, 0}, 1, 4, false, glass);
    b.camera({0, 0, 5}, {0, 0, 0}, 0.7f);
    if (withSky) b.scene.environment = Environment{glm::vec3(1.0f), -1};
    return b.scene;
}

TEST(Extremes, GlassOfEveryIndexIsWhiteUnderAWhiteSky) {
    for (const float ior : {1.0f, 1.0f + 1e-7f, 1.0001f, 1.5f, 3.0f, 10.0f})
        expectMean(glassBall(ior), options(16, 64), 1, fmt::format("index {}", ior));
}

TEST(Extremes, GlassOfIndexOneIsNotThere) {
    // Behind the ball a wall with a step of brightness, whose picture must not change.
    for (const float ior : {1.0f, 1.0f + 1e-7f}) {
        Scene scenes[2];
        for (int with = 0; with < 2; ++with) {
            SceneBuilder b;
            b.scene = glassBall(ior, false);
            if (with == 0) b.scene.roots.erase(b.scene.roots.begin());
            const int dark = b.material(glm::vec3(0.0f), glm::vec3(0.25f));
            const int light = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
            b.quad({-5, -5, -2}, {0, -5, -2}, {0, 5, -2}, {-5, 5, -2}, dark);
            b.quad({0, -5, -2}, {5, -5, -2}, {5, 5, -2}, {0, 5, -2}, light);
            scenes[with] = b.scene;
        }
        const ImageF without = rendered(scenes[0], options(16, 4)).image;
        const ImageF with = rendered(scenes[1], options(16, 4)).image;
        EXPECT_LT(compareImages(with, without).relmse, 1e-4) << ior;
    }
}

TEST(Extremes, CamerasInsideAndOnSurfaces) {
    for (const float z : {1.0f, kBelowOne, 0x1.000002p+0f, 0.0f}) {
        Scene scene = glassBall(1.5f);
        scene.nodes.back().translation = {0, 0, z};
        expectMean(scene, options(16, 64), 1, fmt::format("camera in glass at {}", z), 0.1);
        if (z > 1) continue;
        SceneBuilder b;  // in a wall's plane, looking into the room
        const int wall = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
        b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
        b.camera({0.1f, 0.2f, z}, {0.1f, 0.2f, -1}, 1.0f);
        expectMean(b.scene, options(), 2, fmt::format("camera in a wall at {}", z));
    }
}

TEST(Extremes, SliversAndNeedles) {
    // A white plane made of triangles ten million times as long as wide, under a sky of 1.
    SceneBuilder b;
    std::vector<glm::vec3> corners;
    constexpr float length = 10, width = 1e-6f;
    for (int i = -2000; i < 2000; ++i) {
        const float x = float(i) * width, y = float(i + 1) * width;
        for (const glm::vec3& p :
             {glm::vec3(x, -length / 2, 0), glm::vec3(y, -length / 2, 0), glm::vec3(y, length / 2, 0),
              glm::vec3(x, -length / 2, 0), glm::vec3(y, length / 2, 0), glm::vec3(x, length / 2, 0)})
            corners.push_back(p);
    }
    b.triangles(corners, b.material(glm::vec3(0.5f)));
    b.camera({0, 0, 1e-3f}, {0, 0, 0}, 1.0f);
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        RenderOptions settings = options(32, 16);
        settings.pipeline = pipeline;
        const ImageF image = rendered(b.scene, settings).image;
        // No light leaks in. A ray that leaves an edge may meet the neighbour that shares it, once in
        // thousands.
        double sum = 0;
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 32; ++x) {
                ASSERT_LT(image.at(x, y, 0), 0.50001f) << x << ", " << y;
                sum += image.at(x, y, 0) / (32.0 * 32.0);
            }
        EXPECT_GT(sum, pipeline == Pipeline::Path ? 0.49 : 0.49999);
    }
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
    // A white metal reflects at most the sky; single scattering loses light as it gets rough.
    for (const float roughness : {0.0f, 1e-4f, 0.03f, 0.5f, 1.0f}) {
        SceneBuilder b;
        const int metal = b.material(glm::vec3(1.0f));
        Material& material = b.scene.materials[std::size_t(metal)];
        material.metallic = 1;
        material.specular = 1;
        material.roughness = roughness;
        b.sphere({0, 0, 0}, 1, 4, false, metal);
        b.camera({0, 0, 5}, {0, 0, 0}, 0.35f);
        b.scene.environment = Environment{glm::vec3(1.0f), -1};
        const Mean m = mean(rendered(b.scene, options(16, 64)).image);
        EXPECT_LT(m.value, 1 + 4.5 * m.error + 1e-5) << roughness;
        EXPECT_GT(m.value, roughness < 0.1f ? 0.99 : 0.4) << roughness;
    }
}

}  // namespace
}  // namespace helio::test
