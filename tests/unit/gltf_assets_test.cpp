#include "tests/unit/gltf_support.hpp"

#include <cmath>
#include <set>

namespace helio::test {
namespace {

/** The assets are not part of the repository. Where their folder is not there the tests are left out and say
 * so; where it is, every asset must be in it. */
class GltfAssets : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(HELIOGRAPH_SHARED_DIR))
            GTEST_SKIP() << "left out: there is no " HELIOGRAPH_SHARED_DIR;
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
    EXPECT_EQ(scene.images.size(), 1u);
    std::set<std::string> skipped;
    for (const auto& [what, why] : scene.skipped) skipped.insert(what);
    EXPECT_TRUE(skipped.contains("skins"));
    EXPECT_TRUE(skipped.contains("animations"));
}

TEST_F(GltfAssets, MorphStressTest) {
    const Scene scene = load("MorphStressTest.gltf");
    expectSound(scene);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].primitives.size(), 2u);
    EXPECT_EQ(scene.triangleCount(), 2412u);
    EXPECT_EQ(scene.images.size(), 3u);
    EXPECT_EQ(scene.meshes[0].primitives[0].texcoords.size(), 2u);
    EXPECT_FALSE(scene.skipped.empty());
}

}  // namespace
}  // namespace helio::test
