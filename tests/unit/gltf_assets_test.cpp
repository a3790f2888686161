#include "tests/unit/gltf_support.hpp"

#include <heliograph/pose.hpp>

#include <cmath>

namespace helio::test {
namespace {

/** The assets are not part of the repository. Where their folder is not there the tests are left out and say
 * so; where it is, every asset must be in it. */
class GltfAssets : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(HELIOGRAPH_SHARED_DIR "/assets"))
            GTEST_SKIP() << "left out: there is no " HELIOGRAPH_SHARED_DIR "/assets";
    }
    /** Loads an asset; a missing one is load()'s refusal, which fails the test. */
    static Scene load(const std::string& name) {
        return helio::load((fs::path(HELIOGRAPH_SHARED_DIR) / "assets" / "gltf" / name).string());
    }
};

void expectSound(const Scene& scene) {
    EXPECT_NO_THROW(scene.validate());
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) {
            const std::size_t size = primitive.positions.size();
            for (std::uint32_t index : primitive.indices) ASSERT_LT(index, size);
            for (const glm::vec3& normal : primitive.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-5);
            EXPECT_TRUE(primitive.normals.empty() || primitive.normals.size() == size);
            for (const auto& set : primitive.texcoords) EXPECT_EQ(set.size(), size);
        }
    }
    for (const TextureImage& image : scene.images) {
        EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.texels).size(),
                  std::size_t(image.width) * image.height * 4);
    }
}

TEST_F(GltfAssets, FlightHelmet) {
    const Scene scene = load("FlightHelmet/FlightHelmet.gltf");
    expectSound(scene);
    EXPECT_EQ(scene.meshes.size(), 6u);
    EXPECT_EQ(scene.materials.size(), 6u);
    EXPECT_EQ(scene.images.size(), 15u);
    EXPECT_EQ(scene.instances().size(), 6u);
    EXPECT_EQ(scene.triangleCount(), 94722u);
    EXPECT_TRUE(scene.skipped.empty());
}

TEST_F(GltfAssets, Fox) {
    const Scene scene = load("Fox.glb");
    expectSound(scene);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.triangleCount(), 576u);
    EXPECT_EQ(scene.meshes[0].primitives[0].positions.size(), 1728u);  // as in the file, which shares none
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_TRUE(scene.skipped.empty());
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_EQ(scene.skins[0].joints.size(), 24u);
    ASSERT_EQ(scene.animations.size(), 3u);
    EXPECT_EQ(scene.animations[0].name, "Survey");
    EXPECT_EQ(scene.animations[2].name, "Run");
    expectSound(posed(scene, 0.5));
}

TEST_F(GltfAssets, MorphStressTest) {
    const Scene scene = load("MorphStressTest.gltf");
    expectSound(scene);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].primitives.size(), 2u);
    EXPECT_EQ(scene.triangleCount(), 2412u);
    EXPECT_EQ(scene.images.size(), 3u);
    EXPECT_EQ(scene.meshes[0].primitives[0].texcoords.size(), 2u);
    EXPECT_TRUE(scene.skipped.empty());
    ASSERT_EQ(scene.meshes[0].primitives[0].targets.size(), 8u);
    ASSERT_EQ(scene.animations.size(), 3u);
    // Every vertex by hand, from what the file says of it and the weights between two keys.
    const AnimationChannel& channel = scene.animations[0].channels.at(0);
    ASSERT_EQ(channel.interpolation, Interpolation::Linear);
    for (double time : {0.0, 0.3, 1.45, 2.0}) {
        const Scene still = posed(scene, time);
        expectSound(still);
        std::size_t key = 0;
        while (key + 2 < channel.times.size() && channel.times[key + 1] <= time) ++key;
        const double s = (time - channel.times[key]) / (channel.times[key + 1] - channel.times[key]);
        for (std::size_t p = 0; p < 2; ++p) {
            const Primitive& from = scene.meshes[0].primitives[p];
            const auto mesh = std::size_t(still.instances().at(0).mesh);
            const auto& positions = still.meshes[mesh].primitives[p].positions;
            ASSERT_EQ(positions.size(), from.positions.size());
            for (std::size_t v = 0; v < positions.size(); ++v) {
                glm::dvec3 expected = from.positions[v];
                for (std::size_t t = 0; t < 8; ++t) {
                    const double weight =
                        (1 - s) * channel.values[key * 8 + t] + s * channel.values[key * 8 + 8 + t];
                    expected += weight * glm::dvec3(from.targets[t].positions.at(v));
                }
                ASSERT_LT(glm::distance(expected, glm::dvec3(positions[v])), 1e-6) << time << " " << v;
            }
        }
    }
}

}  // namespace
}  // namespace helio::test
