#include "engine/scene/degenerate.hpp"

#include <gtest/gtest.h>

namespace helio::test {
namespace {

/** One triangle on one node. */
Scene sceneOf(const std::vector<glm::vec3>& positions) {
    Scene scene;
    Primitive primitive;
    primitive.positions = positions;
    primitive.indices = {0, 1, 2};
    scene.meshes.emplace_back().primitives.push_back(std::move(primitive));
    scene.nodes.emplace_back().mesh = 0;
    scene.roots = {0};
    return scene;
}

TEST(Degenerate, TrianglesWithoutAreaAreCounted) {
    const auto warnings = [](const std::vector<glm::vec3>& positions) {
        Scene scene = sceneOf(positions);
        warnOfDegenerates(scene);
        return scene.warnings.size();
    };
    EXPECT_EQ(warnings({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 0u);
    EXPECT_EQ(warnings({{0, 0, 0}, {1e-9f, 0, 0}, {0, 1e-9f, 0}}), 0u);
    EXPECT_EQ(warnings({{1e11f, 0, 0}, {1.1e11f, 0, 0}, {0, 1, 0}}), 0u);
    EXPECT_EQ(warnings({{1, 2, 3}, {1, 2, 3}, {0, 1, 0}}), 1u);
    EXPECT_EQ(warnings({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), 1u);
    EXPECT_EQ(warnings({{0, 0, 0}, {1e-40f, 0, 0}, {0, 1e-40f, 0}}), 1u);
}

TEST(Degenerate, FlatTransformsAreNamed) {
    for (const glm::vec3& scale : {glm::vec3(0), glm::vec3(1, 0, 1), glm::vec3(1e-38f)}) {
        Scene scene = sceneOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        scene.nodes[0].scale = scale;
        warnOfDegenerates(scene);
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings[0].find("node 0"), std::string::npos);
    }
    Scene mirrored = sceneOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    mirrored.nodes[0].scale = {-1, 1e-9f, 1e9f};
    warnOfDegenerates(mirrored);
    EXPECT_TRUE(mirrored.warnings.empty());
}

}  // namespace
}  // namespace helio::test
