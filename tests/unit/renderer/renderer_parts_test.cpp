// The renderer's parts that need no device.
#include "passes/renderer/frame.hpp"
#include "passes/renderer/lighting.hpp"
#include "passes/renderer/motion.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/process_clock.hpp"
#include "passes/renderer/sample_schedule.hpp"
#include "passes/renderer/scene_identity.hpp"

#include <heliograph/error.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace helio {
namespace {

std::vector<std::uint32_t> ends(const RenderOptions& options) {
    const SampleSchedule schedule(options);
    std::vector<std::uint32_t> result;
    for (std::uint32_t reached = 0;;) {
        const std::uint32_t end = schedule.next(reached, 0);
        if (end == reached) return result;
        result.push_back(reached = end);
    }
}

TEST(SampleSchedule, GrowsToTheSamplesAskedFor) {
    using Ends = std::vector<std::uint32_t>;
    RenderOptions options;
    options.size = {256, 256};
    options.samples = 64;
    EXPECT_EQ(ends(options), Ends{64});
    options.size = {1280, 720};
    EXPECT_EQ(ends(options), (Ends{4, 16, 64}));
    options.samples = 100;
    EXPECT_EQ(ends(options), (Ends{4, 16, 64, 100}));
    options.samples = 1;
    EXPECT_EQ(ends(options), Ends{1});
    options.size = {8000, 5000};
    options.samples = 5;
    EXPECT_EQ(ends(options), (Ends{1, 4, 5}));
}

TEST(SampleSchedule, NeverExceedsWhatTheFilmTakesAtOnce) {
    RenderOptions options;
    options.size = {8, 8};
    options.samples = 1u << 24;
    std::uint32_t before = 0;
    for (const std::uint32_t end : ends(options)) {
        EXPECT_GT(end, before);
        EXPECT_LE(end - before, 1024u);
        before = end;
    }
    EXPECT_EQ(before, 1u << 24);
}

TEST(SampleSchedule, EndsWithin20PercentOfWhatTheErrorLimitNeeds) {
    RenderOptions options;
    options.size = {64, 64};
    options.samples = 1u << 22;
    for (const double slope : {0.9, 1.0, 1.14, 1.25}) {
        for (const double limit : {1e-1, 1e-2, 1.7e-3, 1e-4}) {
            options.maxError = limit;
            const auto high = [&](double n) { return 0.7 * std::pow(n, -slope); };
            SampleSchedule schedule(options);
            std::uint32_t reached = 0, judgements = 0;
            do {
                reached = schedule.next(reached, 0);
                schedule.judged(reached, {0, 0, high(reached), true});
                ++judgements;
            } while (high(reached) >= limit);
            const double least = std::max(8.0, std::pow(0.7 / limit, 1 / slope));
            EXPECT_LE(reached, 1.1 * least + 1) << "N^-" << slope << " to " << limit;
            EXPECT_LE(judgements, 30u) << "N^-" << slope << " to " << limit;
        }
    }
}

TEST(SampleSchedule, GoesOnWhateverTheErrorIs) {
    RenderOptions options;
    options.size = {64, 64};
    options.samples = 1000;
    options.maxError = 1e-3;
    const double inf = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();
    for (const double high : {0.0, 1e-3, inf, nan}) {
        SampleSchedule schedule(options);
        schedule.judged(100, {0, 0, high, false});
        EXPECT_GT(schedule.next(100, 0), 100u) << high;
        // Below the limit and not believed: it may be believed at any number of samples.
        EXPECT_LE(schedule.next(100, 0), high < options.maxError ? 120u : 200u) << high;
    }
}

TEST(SampleSchedule, KeepsBatchesToHalfOfTheTimeLeft) {
    RenderOptions options;
    options.size = {64, 64};
    options.samples = 1u << 20;
    options.maxSeconds = 10;
    const SampleSchedule schedule(options);
    std::uint32_t reached = schedule.next(0, 0);
    EXPECT_EQ(reached, 1u);
    for (;;) {  // a device that takes 10 ms a sample
        const std::uint32_t end = schedule.next(reached, reached * 0.01);
        if (end == reached) break;
        if (end - reached > 1) {
            EXPECT_LE((end - reached) * 0.01, 0.5 * (10 - reached * 0.01) + 1e-9);
        }
        reached = end;
    }
    EXPECT_NEAR(reached, 1000, 2);
}

TEST(TurnBudget, FollowsTheTimeItIsToldAndStaysInItsLimits) {
    RenderOptions options;
    options.size = {256, 256};
    TurnBudget budget(options);
    for (int i = 0; i < 50; ++i) budget.took(budget.turns() * 1e-3);
    EXPECT_NEAR(budget.turns() * 1e-3, 0.26, 0.01);  // 4 microseconds a pixel
    for (int i = 0; i < 50; ++i) budget.took(0);
    EXPECT_EQ(budget.turns(), 30000u);
    for (int i = 0; i < 50; ++i) budget.took(100);
    EXPECT_EQ(budget.turns(), 64u);
}

TEST(SceneIdentity, ChangesWithWhatIsSeenAndNotWithNamesOrCameras) {
    const Scene original = load("sample:cornell");
    const SceneIdentity identity = identify(original, original.environment);
    Scene scene = original;
    EXPECT_EQ(identify(scene, scene.environment), identity);
    scene.name = "other";
    scene.meshes[0].name = scene.materials[0].name = "renamed";
    for (Camera& camera : scene.cameras) camera.yfov *= 0.5f;
    for (Node& node : scene.nodes) {
        if (node.camera >= 0) node.translation.x += 1;
    }
    EXPECT_EQ(identify(scene, scene.environment), identity);

    const auto changed = [&](auto edit) {
        Scene edited = original;
        std::optional<Environment> environment = original.environment;
        edit(edited, environment);
        return identify(edited, environment) != identity;
    };
    using Sky = std::optional<Environment>;
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.meshes[0].primitives[0].positions[1].x += 1e-4f; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) {
        std::swap(s.meshes[0].primitives[0].indices[0], s.meshes[0].primitives[0].indices[1]);
    }));
    EXPECT_TRUE(changed(
        [](Scene& s, Sky&) { s.meshes[0].primitives[0].material = 1 - s.meshes[0].primitives[0].material; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials.back().roughness = 0.123f; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials[0].transmission = 0.5f; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials[0].sheenColor.b = 0.5f; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials[0].iridescenceThicknessTexture.texcoord = 1; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials[0].unsupported = {"X"}; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) { s.materials[0].doubleSided = !s.materials[0].doubleSided; }));
    EXPECT_TRUE(changed([](Scene&, Sky& sky) { sky = Environment{glm::vec3(0.5f), -1}; }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) {
        for (Node& node : s.nodes) {
            if (node.mesh < 0) continue;
            if (node.matrix) (*node.matrix)[3].y += 1;
            node.translation.y += 1;
            return;
        }
    }));
    EXPECT_TRUE(changed([](Scene& s, Sky&) {
        s.lights.push_back({});
        Node node;
        node.light = int(s.lights.size()) - 1;
        s.nodes.push_back(node);
        s.roots.push_back(int(s.nodes.size()) - 1);
    }));
}

TEST(Lighting, FindsLampsLightsAndSkies) {
    Scene scene = load("sample:cornell");
    EXPECT_TRUE(hasLight(scene, {}));
    for (Material& material : scene.materials) material.emission = glm::vec3(0.0f);
    EXPECT_FALSE(hasLight(scene, {}));
    EXPECT_FALSE(hasLight(scene, Environment{}));
    EXPECT_TRUE(hasLight(scene, Environment{glm::vec3(0, 0, 1e-3f), -1}));
    scene.lights.push_back({});
    EXPECT_FALSE(hasLight(scene, {})) << "a light that is not placed gives none";
    Node node;
    node.light = 0;
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
    EXPECT_TRUE(hasLight(scene, {}));
    scene.lights[0].intensity = glm::vec3(0.0f);
    EXPECT_FALSE(hasLight(scene, {}));
}

TEST(Lighting, OptionsReplaceTheScenesEnvironment) {
    Scene scene = load("sample:cornell");
    scene.environment = Environment{glm::vec3(1.0f), -1};
    RenderOptions options;
    std::vector<std::string> warnings;
    EXPECT_EQ(chooseEnvironment(scene, options, warnings)->radiance, glm::vec3(1.0f));
    options.environment = Environment{glm::vec3(2.0f), -1};
    EXPECT_EQ(chooseEnvironment(scene, options, warnings)->radiance, glm::vec3(2.0f));
    EXPECT_TRUE(warnings.empty());
}

TEST(ChooseView, FramesASceneWithoutACameraAndLeavesItAsItWas) {
    Scene scene = load("sample:cornell");
    const View own = chooseView(scene, "", 1);
    EXPECT_EQ(own.camera.yfov, scene.cameras[0].yfov);
    for (Node& node : scene.nodes) node.camera = -1;
    const std::size_t cameras = scene.cameras.size();
    const View framed = chooseView(scene, "", 1);
    EXPECT_EQ(scene.cameras.size(), cameras);
    EXPECT_NE(framed.transform, own.transform);
}

TEST(MotionOf, AnAnimationThatIsNotThereIsRefused) {
    const Scene scene = load("sample:cornell");
    RenderOptions options;
    options.animation = "none";
    EXPECT_FALSE(motionOf(scene, options).first.has_value());
    options.animation = "walk";
    EXPECT_THROW(motionOf(scene, options), InputError);
}

TEST(ChooseView, FramesAFlatPictureFromItsFace) {
    for (int flat = 0; flat < 3; ++flat) {
        Scene scene = load("sample:cornell");
        for (Node& node : scene.nodes) node.camera = -1;
        glm::dmat4 squeezed(1.0);
        squeezed[flat][flat] = 1e-9;
        Node parent;
        parent.matrix = glm::mat4(squeezed);
        parent.children = scene.roots;
        scene.roots = {int(scene.nodes.size())};
        scene.nodes.push_back(parent);
        const glm::dvec3 axis = View(chooseView(scene, "", 1)).transform[2];  // away from what is seen
        EXPECT_GT(std::abs(axis[flat]), 0.4) << flat;
        EXPECT_NEAR(glm::length(axis), 1, 1e-6);
        EXPECT_NEAR(std::abs(axis.y), std::sqrt(0.2), 1e-6);
    }
}

TEST(ProcessClock, KnowsTheProcess) {
    EXPECT_GE(secondsSinceProcessStart(), 0);
    EXPECT_LT(secondsSinceProcessStart(), 3600);
    EXPECT_GT(peakHostBytes(), 1000000u);
    const Stopwatch watch;
    volatile double x = 0;
    while (watch.cpuSeconds() < 0.02) x = x + 1;
    EXPECT_GE(watch.seconds(), 0.005);
    const Stopwatch first = Stopwatch::sinceProcessStartOnce(), second = Stopwatch::sinceProcessStartOnce();
    EXPECT_GT(first.cpuSeconds(), second.cpuSeconds());
}

TEST(Frame, InterleavesChannelsInOrder) {
    Frame frame(2, 1);
    const std::vector<float> rgba = {1, 2, 3, 4, 5, 6, 7, 8}, depth = {9, 10};
    frame.add({"R", "G", "B"}, rgba.data(), 4);
    frame.add({"samples"}, rgba.data(), 4, 3);
    frame.add({"depth.Z"}, depth.data(), 1);
    const ImageF image = frame.image();
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "samples", "depth.Z"}));
    EXPECT_EQ(image.data, (std::vector<float>{1, 2, 3, 4, 9, 5, 6, 7, 8, 10}));
}

TEST(Statistics, SurviveNumbersAndNamesThatJsonHasNoTextFor) {
    RenderResult result;
    result.scene = "broken \xff name";
    result.error.high = std::numeric_limits<double>::infinity();
    const nlohmann::json json = nlohmann::json::parse(result.json());
    EXPECT_TRUE(json["error"]["high"].is_null());
    EXPECT_TRUE(json["scene"].is_string());
}

}  // namespace
}  // namespace helio
