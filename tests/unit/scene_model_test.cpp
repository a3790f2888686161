#include <heliograph/error.hpp>
#include <heliograph/features.hpp>
#include <heliograph/scene.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace helio {
namespace {

Mesh triangleMesh(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    Primitive primitive;
    primitive.positions = {a, b, c};
    primitive.indices = {0, 1, 2};
    return {"triangle", {primitive}};
}

Scene oneTriangle(float scale = 1, glm::vec3 offset = {}) {
    Scene scene;
    scene.meshes.push_back(
        triangleMesh(offset, offset + glm::vec3(scale, 0, 0), offset + glm::vec3(0, scale, 0)));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.roots = {0};
    return scene;
}

/** The largest |x| / z and |y| / z of the corners of the scene's bounds seen from the camera; > tan(fov / 2)
 * is outside. Negative when a corner lies behind. */
double extentInView(const Scene& scene, const PlacedCamera& placed) {
    const Scene::Bounds bounds = scene.bounds();
    const glm::dmat4 toCamera = glm::inverse(placed.transform);
    double extent = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(toCamera * glm::dvec4(corner & 1 ? bounds.upper.x : bounds.lower.x,
                                                 corner & 2 ? bounds.upper.y : bounds.lower.y,
                                                 corner & 4 ? bounds.upper.z : bounds.lower.z, 1));
        if (p.z >= 0) return -1;
        extent = std::max({extent, std::abs(p.x / p.z), std::abs(p.y / p.z)});
    }
    return extent;
}

TEST(SceneModel, ComposesTransformsInDouble) {
    Scene scene = oneTriangle();
    scene.nodes[0].translation = {1, 2, 3};
    Node parent;
    parent.children = {0};
    parent.translation = {1e7f, 0, 0};
    parent.rotation = glm::angleAxis(float(M_PI / 2), glm::vec3(0, 0, 1));
    parent.scale = {2, 3, 4};
    scene.nodes.push_back(parent);
    scene.roots = {1};
    const auto placed = scene.instances();
    ASSERT_EQ(placed.size(), 1u);
    EXPECT_EQ(placed[0].node, 0);
    const glm::dvec3 origin(placed[0].transform[3]);
    EXPECT_NEAR(origin.x, 1e7 - 6, 1e-6);  // single precision could not hold this at 1e7
    EXPECT_NEAR(origin.y, 2, 1e-6);
    EXPECT_NEAR(origin.z, 12, 1e-12);
}

TEST(SceneModel, RotationIsRigidThoughTheQuaternionIsRounded) {
    Node node;
    node.rotation = glm::quat(0.5f, 0.5f, 0.70710677f, 0.1f);
    const glm::dmat3 m(node.localTransform());
    const glm::dmat3 product = glm::transpose(m) * m;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(product[c][r], c == r ? 1 : 0, 4e-16);
    }
}

TEST(SceneModel, MatrixWinsOverItsParts) {
    Node node;
    node.translation = {5, 5, 5};
    node.matrix = glm::translate(glm::mat4(1), glm::vec3(1, 2, 3));
    EXPECT_EQ(glm::dvec3(node.localTransform()[3]), glm::dvec3(1, 2, 3));
}

TEST(SceneModel, OrdersInstancesDepthFirst) {
    Scene scene = oneTriangle();
    scene.nodes.assign(5, Node{});
    for (Node& node : scene.nodes) node.mesh = 0;
    scene.nodes[0].children = {3, 1};
    scene.nodes[3].children = {4};
    scene.roots = {2, 0};
    std::vector<int> order;
    for (const Instance& instance : scene.instances()) order.push_back(instance.node);
    EXPECT_EQ(order, (std::vector<int>{2, 0, 3, 4, 1}));
    EXPECT_EQ(scene.triangleCount(), 5u);
}

TEST(SceneModel, RefusesCycles) {
    Scene scene = oneTriangle();
    scene.nodes.resize(2);
    scene.nodes[0].children = {1};
    scene.nodes[1].children = {0};
    EXPECT_THROW(scene.instances(), InputError);
    scene.nodes[1].children = {1};
    EXPECT_THROW(scene.placedCameras(), InputError);
    scene.nodes[1].children = {};
    scene.roots = {0, 1};
    EXPECT_THROW(scene.placedLights(), InputError) << "a node with two parents";
}

TEST(SceneModel, RefusesIndicesOutOfRange) {
    for (int wrong : {1, 1000}) {
        Scene scene = oneTriangle();
        scene.nodes[0].mesh = wrong;
        EXPECT_THROW(scene.instances(), InputError);
        scene = oneTriangle();
        scene.nodes[0].camera = wrong;
        EXPECT_THROW(scene.placedCameras(), InputError);
        scene = oneTriangle();
        scene.nodes[0].light = wrong;
        EXPECT_THROW(scene.placedLights(), InputError);
        scene = oneTriangle();
        scene.nodes[0].children = {wrong};
        EXPECT_THROW(scene.instances(), InputError);
        scene = oneTriangle();
        scene.roots = {wrong};
        EXPECT_THROW(scene.bounds(), InputError);
    }
}

TEST(SceneModel, DeepChainsDoNotOverflowTheStack) {
    Scene scene = oneTriangle();
    scene.nodes.assign(1000000, Node{});
    for (int i = 0; i + 1 < int(scene.nodes.size()); ++i) scene.nodes[std::size_t(i)].children = {i + 1};
    scene.nodes.back().mesh = 0;
    EXPECT_EQ(scene.instances().size(), 1u);
}

TEST(SceneModel, BoundsAreTightUnderRotationAndSkipWhatIsNotUsed) {
    Scene scene = oneTriangle();
    scene.nodes[0].rotation = glm::angleAxis(float(M_PI / 4), glm::vec3(0, 0, 1));
    auto& positions = scene.meshes[0].primitives[0].positions;
    positions.push_back({100, 100, 100});  // no index uses it
    positions.push_back({NAN, 0, 0});
    auto& indices = scene.meshes[0].primitives[0].indices;
    indices.insert(indices.end(), {0, 1, 4});
    const Scene::Bounds bounds = scene.bounds();
    EXPECT_NEAR(bounds.lower.x, -std::sqrt(0.5), 1e-7);
    EXPECT_NEAR(bounds.upper.x, std::sqrt(0.5), 1e-7);
    EXPECT_NEAR(bounds.lower.y, 0, 1e-7);
    EXPECT_NEAR(bounds.upper.y, std::sqrt(0.5), 1e-7) << "the box's corners would give sqrt(2)";
    EXPECT_EQ(bounds.lower.z, 0);
    EXPECT_TRUE(Scene{}.bounds().empty());
}

TEST(ChooseCamera, FramesAnySceneWhole) {
    const double limit = std::tan(M_PI / 8) * (1 + 1e-6);
    for (float scale : {1e-30f, 1e-3f, 1.0f, 1e3f, 1e30f}) {
        for (double aspect : {1.0, 16.0 / 9, 0.25}) {
            Scene scene = oneTriangle(scale, glm::vec3(scale, -scale, 2 * scale));
            const PlacedCamera placed = chooseCamera(scene, "", aspect);
            EXPECT_EQ(placed.node, -1);
            const double extent = extentInView(scene, placed);
            EXPECT_GT(extent, 0.03) << scale;
            EXPECT_LE(extent, limit * std::min(aspect, 1.0)) << scale << " aspect " << aspect;
            EXPECT_GT(scene.cameras[std::size_t(placed.camera)].znear, 0);
            EXPECT_NEAR(glm::determinant(glm::dmat3(placed.transform)), 1, 1e-12);
        }
    }
}

TEST(ChooseCamera, TheBoundingSphereTouchesTheImage) {
    Scene scene = oneTriangle();  // bounds (0,0,0) to (1,1,0): radius sqrt(1/2) about (1/2, 1/2, 0)
    const PlacedCamera placed = chooseCamera(scene, "");
    const double distance = std::sqrt(0.5) / std::sin(M_PI / 8);
    const glm::dvec3 eye(placed.transform[3]);
    EXPECT_NEAR(eye.x, 0.5, 1e-12);
    EXPECT_NEAR(eye.y, 0.5 + distance * 0.5 / std::sqrt(1.25), 1e-12);
    EXPECT_NEAR(eye.z, distance / std::sqrt(1.25), 1e-12);
    EXPECT_NEAR(scene.cameras[std::size_t(placed.camera)].yfov, M_PI / 4, 1e-7);
}

TEST(ChooseCamera, IsNeverDegenerate) {
    Scene point = oneTriangle(0);
    Scene farPoint = oneTriangle(0, glm::vec3(1e6f));
    Scene empty;
    for (Scene* scene : {&point, &farPoint, &empty}) {
        const PlacedCamera placed = chooseCamera(*scene, "");
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(placed.transform[c][r]));
        }
        const Scene::Bounds bounds = scene->bounds();
        const glm::dvec3 target = bounds.empty() ? glm::dvec3(0) : bounds.lower;
        EXPECT_GT(glm::distance(glm::dvec3(placed.transform[3]), target), 1e-7 * glm::length(target));
        EXPECT_NE(glm::dvec3(placed.transform[3]), target);
    }
}

TEST(ChooseCamera, FramingAgainAddsNoSecondCamera) {
    Scene scene = oneTriangle();
    EXPECT_EQ(chooseCamera(scene, "").camera, chooseCamera(scene, "").camera);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST(ChooseCamera, FindsByNameThenByIndex) {
    Scene scene = oneTriangle();
    scene.cameras.resize(2);
    scene.cameras[0].name = "left";
    scene.cameras[1].name = "0";
    for (int i = 0; i < 2; ++i) {
        Node node;
        node.name = i == 0 ? "tripod" : "";
        node.camera = i;
        scene.nodes.push_back(node);
        scene.roots.push_back(i + 1);
    }
    EXPECT_EQ(chooseCamera(scene, "").camera, 0);
    EXPECT_EQ(chooseCamera(scene, "left").camera, 0);
    EXPECT_EQ(chooseCamera(scene, "tripod").camera, 0);
    EXPECT_EQ(chooseCamera(scene, "0").camera, 1) << "a name wins over an index";
    EXPECT_EQ(chooseCamera(scene, "1").camera, 1);
    for (const char* wrong : {"2", "-1", "right", "1x", "99999999999999999999"}) {
        EXPECT_THROW(chooseCamera(scene, wrong), InputError) << wrong;
    }
    Scene without = oneTriangle();
    EXPECT_THROW(chooseCamera(without, "left"), InputError);
}

const RegisterFeature testOnly{{"test.bigMesh", "no mesh has two triangles", [](const Scene& scene) {
                                    return !scene.meshes.empty() && scene.triangleCount() > 1;
                                }}};

TEST(SceneFeatures, ComeFromRegisteredRules) {
    Scene scene = oneTriangle();
    EXPECT_FALSE(SceneFeatures(scene).has("test.bigMesh"));
    bool isListed = false;
    for (const auto& absent : SceneFeatures(scene).absent()) {
        isListed |= absent.name == "test.bigMesh" && absent.why == "no mesh has two triangles";
    }
    EXPECT_TRUE(isListed);
    scene.nodes.push_back(scene.nodes[0]);
    scene.roots = {0, 1};
    EXPECT_TRUE(SceneFeatures(scene).has("test.bigMesh"));
    const auto present = SceneFeatures(scene).present();
    EXPECT_TRUE(std::is_sorted(present.begin(), present.end()));
}

}  // namespace
}  // namespace helio
