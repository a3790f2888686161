#include <heliograph/error.hpp>
#include <heliograph/pose.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace helio {
namespace {

AnimationChannel rotationKeys(std::vector<float> times, std::vector<glm::quat> keys) {
    AnimationChannel channel{0, AnimationPath::Rotation, Interpolation::Linear, std::move(times), {}};
    for (const glm::quat& q : keys) channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
    return channel;
}

glm::dquat quaternionAt(const AnimationChannel& channel, double time) {
    const std::vector<double> v = valueAt(channel, time);
    return {v[3], v[0], v[1], v[2]};
}

glm::quat turn(double angle, const glm::vec3& axis) {
    return glm::angleAxis(float(angle), glm::normalize(axis));
}

TEST(ValueAt, HoldsBeforeAndAfterAndSteps) {
    AnimationChannel channel{0, AnimationPath::Translation, Interpolation::Linear, {1, 2, 4}, {}};
    channel.values = {1, 2, 3, 5, 6, 7, -1, -2, -3};
    using Values = std::vector<double>;
    EXPECT_EQ(valueAt(channel, -5), (Values{1, 2, 3}));
    EXPECT_EQ(valueAt(channel, 1), (Values{1, 2, 3}));
    EXPECT_EQ(valueAt(channel, 1.25), (Values{2, 3, 4}));
    EXPECT_EQ(valueAt(channel, 2), (Values{5, 6, 7}));
    EXPECT_EQ(valueAt(channel, 3), (Values{2, 2, 2}));
    EXPECT_EQ(valueAt(channel, 1e30), (Values{-1, -2, -3}));
    channel.interpolation = Interpolation::Step;
    EXPECT_EQ(valueAt(channel, 0), (Values{1, 2, 3}));
    EXPECT_EQ(valueAt(channel, 1.999), (Values{1, 2, 3}));
    EXPECT_EQ(valueAt(channel, 2), (Values{5, 6, 7}));
    EXPECT_EQ(valueAt(channel, 4), (Values{-1, -2, -3}));
}

TEST(ValueAt, TimesThatCoincideTakeTheLater) {
    AnimationChannel channel{0, AnimationPath::Translation, Interpolation::Linear, {0, 1, 1, 2}, {}};
    channel.values = {0, 0, 0, 1, 1, 1, 5, 5, 5, 6, 6, 6};
    EXPECT_EQ(valueAt(channel, 1)[0], 5);
    EXPECT_EQ(valueAt(channel, 0.5)[0], 0.5);
    EXPECT_EQ(valueAt(channel, 1.5)[0], 5.5);
}

/** A Hermite spline with the derivatives of a cubic polynomial at its keys is that polynomial. */
TEST(ValueAt, CubicSplinesReproduceCubics) {
    const auto value = [](double t) { return 0.5 * t * t * t - 2 * t * t + 3 * t - 7; };
    const auto slope = [](double t) { return 1.5 * t * t - 4 * t + 3; };
    AnimationChannel channel{0, AnimationPath::Translation, Interpolation::CubicSpline, {0, 1, 3.5f}, {}};
    for (double t : {0.0, 1.0, 3.5}) {
        for (double part : {slope(t), value(t), slope(t)})
            for (int c = 1; c <= 3; ++c) channel.values.push_back(float(part * c));
    }
    for (double t = 0; t <= 3.5; t += 0.01) {
        const std::vector<double> at = valueAt(channel, t);
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(at[c], value(t) * double(c + 1), 2e-5) << t;
    }
}

TEST(ValueAt, CubicSplinesOfRotationsAreUnit) {
    AnimationChannel channel = rotationKeys({0, 2}, {});
    channel.interpolation = Interpolation::CubicSpline;
    channel.values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    for (double t = 0; t <= 2; t += 0.125) EXPECT_NEAR(glm::length(quaternionAt(channel, t)), 1, 1e-15) << t;
    // s = 1/2: half of each value, an eighth of 2 s times the difference of the tangents.
    const glm::dquat expected = glm::normalize(glm::dquat(0.5, 0, 0.5 + 0.125 * 2 * (0.5 - 0.5), 0));
    EXPECT_NEAR(std::abs(glm::dot(quaternionAt(channel, 1), expected)), 1, 1e-12);
}

TEST(ValueAt, RotationsTurnEvenlyByTheShorterWay) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    for (double angle : {1e-9, 1e-6, 1e-3, 0.5, 1.57, 3.0, 3.1415926}) {
        for (int trial = 0; trial < 20; ++trial) {
            const glm::vec3 axis(number(random), number(random), number(random));
            const glm::quat start = turn(3 * number(random), {number(random), number(random), 0.5});
            glm::quat end = turn(angle, axis) * start;
            if (trial % 2 != 0) end = -end;  // the same rotation
            const AnimationChannel channel = rotationKeys({0, 1}, {start, end});
            const glm::dquat a = glm::normalize(glm::dquat(start));
            glm::dquat b = glm::normalize(glm::dquat(end));
            if (glm::dot(a, b) < 0) b = -b;
            const double whole = 4 * std::atan2(glm::length(a - b), glm::length(a + b));
            for (double s : {0.0, 0.1, 0.5, 0.9, 1.0}) {
                const glm::dquat q = quaternionAt(channel, s);
                ASSERT_NEAR(glm::length(q), 1, 1e-14);
                glm::dquat from = glm::dot(a, q) < 0 ? -a : a;
                EXPECT_NEAR(4 * std::atan2(glm::length(q - from), glm::length(q + from)), s * whole, 1e-12)
                    << angle << " " << s;
            }
        }
    }
}

TEST(ValueAt, OppositeAndZeroRotationsStayFinite) {
    const AnimationChannel opposite = rotationKeys({0, 1}, {glm::quat(1, 0, 0, 0), glm::quat(0, 1, 0, 0)});
    EXPECT_NEAR(glm::length(quaternionAt(opposite, 0.5)), 1, 1e-15);
    const AnimationChannel zero = rotationKeys({0, 1}, {glm::quat(0, 0, 0, 0), turn(1, {0, 1, 0})});
    EXPECT_NEAR(glm::length(quaternionAt(zero, 0.0)), 1, 1e-15);
    EXPECT_NEAR(glm::length(quaternionAt(zero, 0.5)), 1, 1e-15);
}

/** A column of `rings` squares around +Y from 0 to 1, skinned to joints 0 (y = 0) and 1 (y = 1). */
Scene column(int rings = 3) {
    Scene scene;
    scene.name = "built";
    Primitive primitive;
    std::vector<glm::u16vec4> joints;
    std::vector<glm::vec4> weights;
    for (int r = 0; r < rings; ++r) {
        const float y = float(r) / float(rings - 1);
        for (const glm::vec2& at : {glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(-1, 0), glm::vec2(0, -1)}) {
            primitive.positions.emplace_back(at.x, y, at.y);
            primitive.normals.emplace_back(at.x, 0, at.y);
            primitive.tangents.emplace_back(0, 1, 0, 1);
            joints.emplace_back(0, 1, 0, 0);
            weights.emplace_back(1 - y, y, 0, 0);
        }
    }
    for (std::uint32_t r = 0; r + 1 < std::uint32_t(rings); ++r) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t a = r * 4 + k, b = r * 4 + (k + 1) % 4;
            primitive.indices.insert(primitive.indices.end(), {a, a + 4, b, b, a + 4, b + 4});
        }
    }
    primitive.joints = {joints};
    primitive.weights = {weights};
    scene.meshes.push_back({"column", {primitive}});
    scene.nodes.resize(4);  // 0 the mesh, 1 and 2 the joints, 3 their parent
    scene.nodes[0].mesh = scene.nodes[0].skin = 0;
    scene.nodes[3].children = {1, 2};
    scene.nodes[2].translation = {0, 1, 0};
    Skin skin{"skin", {1, 2}, {glm::mat4(1), glm::translate(glm::mat4(1), {0, -1, 0})}};
    scene.skins.push_back(skin);
    scene.roots = {0, 3};
    return scene;
}

/** World positions of an instance's vertices. */
std::vector<glm::dvec3> world(const Scene& scene, std::size_t instance = 0) {
    const Instance placed = scene.instances().at(instance);
    std::vector<glm::dvec3> points;
    for (const Primitive& primitive : scene.meshes[std::size_t(placed.mesh)].primitives) {
        for (const glm::vec3& p : primitive.positions)
            points.emplace_back(placed.transform * glm::dvec4(p, 1.0));
    }
    return points;
}

TEST(Skin, StandsAsModelledInItsBindPose) {
    const Scene scene = column();
    EXPECT_TRUE(needsPose(scene));
    const Scene still = posed(scene);
    EXPECT_FALSE(needsPose(still));
    EXPECT_NO_THROW(still.validate());
    const auto before = world(scene), after = world(still);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT(glm::distance(before[i], after[i]), 1e-7);
}

TEST(Skin, RigidMotionOfAllJointsIsRigidMotionOfTheMesh) {
    Scene scene = column();
    const auto before = world(scene);
    scene.nodes[3].rotation = turn(1.2, {1, 2, 3});
    scene.nodes[3].translation = {1000, 20, -3};
    const glm::dmat4 motion = scene.nodes[3].localTransform();
    // The mesh's own node counts for nothing, be it singular.
    scene.nodes[0].scale = {0, 0, 0};
    scene.nodes[0].translation = {7, 7, 7};
    const Scene still = posed(scene);
    const auto after = world(still);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_LT(glm::distance(glm::dvec3(motion * glm::dvec4(before[i], 1)), after[i]), 2e-7);
        const glm::dvec3 normal = glm::dmat3(motion) * glm::dvec3(scene.meshes[0].primitives[0].normals[i]);
        const Primitive& moved = still.meshes[std::size_t(still.instances()[0].mesh)].primitives[0];
        EXPECT_LT(glm::distance(normal, glm::dvec3(moved.normals[i])), 1e-6);
    }
}

/** Equal weights of a turn by theta and none scale the cross-section by cos(theta / 2): at 180 degrees a
 * linearly blended skin collapses there (the candy wrapper). */
TEST(Skin, BlendsLinearly) {
    for (double theta : {0.5, M_PI / 2, 3.0, M_PI}) {
        Scene scene = column();
        scene.nodes[2].rotation = turn(theta, {0, 1, 0});
        const auto points = world(posed(scene));
        for (std::size_t i = 4; i < 8; ++i) {
            EXPECT_NEAR(std::hypot(points[i].x, points[i].z), std::cos(theta / 2), 1e-6) << theta;
            EXPECT_NEAR(points[i].y, 0.5, 1e-6);
        }
    }
}

/** Two links of lengths 2 and 1.5 in a plane, turning as an animation says. */
TEST(Skin, ForwardKinematicsOfTwoLinks) {
    Scene scene;
    scene.nodes.resize(3);
    scene.nodes[0].children = {1};
    scene.nodes[1].children = {2};
    scene.nodes[1].translation = {2, 0, 0};
    scene.nodes[2].translation = {1.5f, 0, 0};
    scene.nodes[2].camera = 0;
    scene.cameras.push_back({});
    scene.roots = {0};
    AnimationChannel first = rotationKeys({0, 1}, {turn(0, {0, 0, 1}), turn(2.5, {0, 0, 1})}), second = first;
    second = rotationKeys({0, 2}, {turn(-0.5, {0, 0, 1}), turn(-2, {0, 0, 1})});
    second.node = 1;
    scene.animations.push_back({"bend", {first, second}});
    for (double t = 0; t <= 2; t += 0.1) {
        const double a = 2.5 * std::min(t, 1.0), b = -0.5 - 0.75 * t;
        const glm::dvec3 expected(2 * std::cos(a) + 1.5 * std::cos(a + b),
                                  2 * std::sin(a) + 1.5 * std::sin(a + b), 0);
        const glm::dvec3 tip(posed(scene, t).placedCameras()[0].transform[3]);
        EXPECT_LT(glm::distance(tip, expected), 1e-6) << t;
    }
}

TEST(Skin, NormalsTurnByTheInverseTranspose) {
    Scene scene = column();
    scene.nodes[1].scale = scene.nodes[2].scale = {2, 1, 5};
    const Scene still = posed(scene);
    const Primitive& moved = still.meshes[std::size_t(still.instances()[0].mesh)].primitives[0];
    const Primitive& original = scene.meshes[0].primitives[0];
    for (std::size_t i = 0; i < moved.normals.size(); ++i) {
        const glm::vec3 n = original.normals[i];
        EXPECT_LT(glm::distance(moved.normals[i], glm::normalize(glm::vec3(n.x / 2, n.y, n.z / 5))), 1e-6f);
        EXPECT_LT(glm::distance(glm::vec3(moved.tangents[i]), glm::vec3(0, 1, 0)), 1e-6f);
    }
}

TEST(Skin, MirroredTrianglesKeepTheirFront) {
    for (float x : {1.0f, -1.0f}) {
        Scene scene = column();
        scene.nodes[3].scale = {x, 1, 1};
        const Scene still = posed(scene);
        const Primitive& p = still.meshes[std::size_t(still.instances()[0].mesh)].primitives[0];
        for (std::size_t t = 0; t < p.indices.size(); t += 3) {
            const glm::vec3 a = p.positions[p.indices[t]];
            const glm::vec3 front =
                glm::cross(p.positions[p.indices[t + 1]] - a, p.positions[p.indices[t + 2]] - a);
            EXPECT_GT(glm::dot(front, p.normals[p.indices[t]]), 0) << x;
        }
        EXPECT_EQ(p.tangents[0].w, x);
    }
}

TEST(Skin, WeightsAreDividedByTheirSum) {
    Scene scene = column();
    scene.nodes[2].translation = {0, 3, 0};
    const auto expected = world(posed(scene));
    Primitive& primitive = scene.meshes[0].primitives[0];
    for (glm::vec4& weight : primitive.weights[0]) weight *= 0.3f;
    const auto scaled = world(posed(scene));
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT(glm::distance(expected[i], scaled[i]), 1e-6) << i;
    for (glm::vec4& weight : primitive.weights[0]) weight = glm::vec4(0);
    const auto unweighted = world(posed(scene));
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT(glm::distance(glm::dvec3(primitive.positions[i]), unweighted[i]), 1e-6) << i;
}

TEST(Skin, MoreThanFourInfluencesCount) {
    Scene scene = column();
    scene.nodes[2].translation = {0, 3, 0};
    const auto expected = world(posed(scene));
    Primitive& primitive = scene.meshes[0].primitives[0];
    primitive.joints.push_back(primitive.joints[0]);
    primitive.weights.push_back(primitive.weights[0]);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        primitive.weights[0][i].y = 0;
        primitive.weights[1][i].x = 0;
    }
    const auto split = world(posed(scene));
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT(glm::distance(expected[i], split[i]), 1e-6);
}

TEST(Skin, KeepsItsDetailFarFromTheOrigin) {
    Scene scene = column();
    scene.nodes[3].translation = {1e7f, 0, -1e7f};
    const auto points = world(posed(scene));
    EXPECT_NEAR(points[0].x - points[2].x, 2, 1e-6);
    EXPECT_NEAR(points[0].x, 1e7 + 1, 1e-6);
}

/** A triangle with two targets. */
Scene face() {
    Scene scene;
    scene.name = "built";
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, {0, 0, 1});
    primitive.tangents.assign(3, {1, 0, 0, -1});
    primitive.indices = {0, 1, 2};
    primitive.targets.resize(2);
    primitive.targets[0].positions = {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
    primitive.targets[1].positions = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    primitive.targets[1].normals.assign(3, {1, 0, 0});
    primitive.targets[1].tangents.assign(3, {0, 1, 0});
    scene.meshes.push_back({"face", {primitive}});
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.roots = {0};
    return scene;
}

TEST(Morph, TargetsAddUpByTheirWeights) {
    Scene scene = face();
    EXPECT_EQ(world(posed(scene))[1], glm::dvec3(1, 0, 0)) << "no weights are zeros";
    scene.meshes[0].weights = {0.5f, 2};
    const Scene still = posed(scene);
    EXPECT_EQ(world(still)[0], glm::dvec3(2, 0, 0.5));
    EXPECT_EQ(world(still)[1], glm::dvec3(3, 0, 1));
    EXPECT_EQ(world(still)[2], glm::dvec3(2, 1, 1.5));
    const Primitive& p = still.meshes[std::size_t(still.instances()[0].mesh)].primitives[0];
    EXPECT_LT(glm::distance(p.normals[0], glm::normalize(glm::vec3(2, 0, 1))), 1e-7f);
    EXPECT_LT(glm::distance(glm::vec3(p.tangents[0]), glm::normalize(glm::vec3(1, 2, 0))), 1e-7f);
    EXPECT_EQ(p.tangents[0].w, -1);
    scene.nodes[0].weights = {-1, 0};
    EXPECT_EQ(world(posed(scene))[2], glm::dvec3(0, 1, -3)) << "the node's weights win";
}

TEST(Morph, AnimatesWeightsPerNodeAndSharesWhatIsEqual) {
    Scene scene = face();
    scene.nodes.assign(3, scene.nodes[0]);
    scene.roots = {0, 1, 2};
    AnimationChannel channel{0, AnimationPath::Weights, Interpolation::Linear, {0, 2}, {0, 0, 1, 4}};
    scene.animations = {{"still", {}}, {"talk", {channel}}};
    scene.animations[1].channels.push_back(channel);
    scene.animations[1].channels[1].node = 2;
    const Scene still = posed(scene, 0.5, "talk");
    EXPECT_EQ(world(still, 0)[0], glm::dvec3(1, 0, 0.25));
    EXPECT_EQ(world(still, 1)[0], glm::dvec3(0, 0, 0));
    const auto placed = still.instances();
    ASSERT_EQ(placed.size(), 3u);
    EXPECT_EQ(placed[0].mesh, placed[2].mesh);
    EXPECT_NE(placed[0].mesh, placed[1].mesh);
    EXPECT_TRUE(still.meshes[std::size_t(placed[1].mesh)].primitives[0].targets.empty());
    EXPECT_EQ(world(posed(scene, 0.5), 0)[0], glm::dvec3(0)) << "the first animation is the default";
    EXPECT_EQ(world(posed(scene, 0.5, "1"), 0)[0], glm::dvec3(1, 0, 0.25));
    EXPECT_EQ(world(posed(scene, 0.5, "none"), 0)[0], glm::dvec3(0));
}

TEST(Morph, ComesBeforeTheSkin) {
    Scene scene = column();
    Primitive& primitive = scene.meshes[0].primitives[0];
    primitive.targets.resize(1);
    primitive.targets[0].positions.assign(primitive.positions.size(), {1, 0, 0});
    scene.meshes[0].weights = {2};
    scene.nodes[3].rotation = turn(M_PI / 2, {0, 0, 1});
    const glm::dvec3 first = world(posed(scene))[0];  // (1, 0, 0) + (2, 0, 0), turned
    EXPECT_LT(glm::distance(first, glm::dvec3(0, 3, 0)), 1e-6);
}

TEST(Posed, RefusesWhatItCannotShow) {
    const auto expectRefused = [](const Scene& scene, double time, const std::string& animation,
                                  const std::string& expected) {
        try {
            posed(scene, time, animation);
            ADD_FAILURE() << "accepted: " << expected;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
        }
    };
    Scene scene = face();
    expectRefused(scene, std::numeric_limits<double>::quiet_NaN(), "", "frame time");
    expectRefused(scene, 0, "walk", "the scene has none");
    scene.animations = {{"run", {}}};
    expectRefused(scene, 0, "walk", "0 (run)");
    expectRefused(scene, 0, "1", "0 (run)");
    scene.meshes[0].weights = {3e38f, 0};
    expectRefused(scene, 0, "", "no float holds");
    Scene cyclic = column();
    cyclic.nodes.resize(6);
    cyclic.nodes[4].children = {5};
    cyclic.nodes[5].children = {4};
    expectRefused(cyclic, 0, "", "cycle");
}

TEST(Posed, LeavesStillScenesAsTheyAre) {
    for (const std::string& sample : sampleNames())
        EXPECT_EQ(needsPose(load("sample:" + sample)), sample == "wheel") << sample;
}

}  // namespace
}  // namespace helio
