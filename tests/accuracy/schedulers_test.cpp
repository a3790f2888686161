// The megakernel and the wavefront give the same picture, bit for bit, and trace the same rays.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace helio::test {
namespace {

/** Shadows through alpha, a mirror, surroundings by an image, a punctual light, a tree, and a meter. */
Scene everything() {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.7f, 0.6f, 0.5f)), glow = b.material({}, glm::vec3(3, 2, 1));
    const int veil = b.material(glm::vec3(0.2f, 0.4f, 0.8f)), mirror = b.material(glm::vec3(0.9f));
    b.scene.materials[std::size_t(veil)].baseColor.a = 0.4f;
    b.scene.materials[std::size_t(veil)].alphaMode = AlphaMode::Blend;
    b.scene.materials[std::size_t(mirror)].scattering = Scattering{.model = Scattering::Model::Mirror};
    b.quad({-2, -1, -2}, {-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, wall);
    b.quad({-0.5f, 1.5f, -0.5f}, {0.5f, 1.5f, -0.5f}, {0.5f, 1.5f, 0.5f}, {-0.5f, 1.5f, 0.5f}, glow);
    b.quad({-1, -1, 0.6f}, {0, -1, 0.6f}, {0, 1, 0.6f}, {-1, 1, 0.6f}, veil);
    b.sphere({0.4f, -0.4f, -0.2f}, 0.5f, 3, false, mirror);
    b.sphere({-0.6f, -0.5f, 0}, 0.4f, 2, false, wall);
    b.whiteImageAround();
    b.pointLight({1.5f, 1, 1}, glm::vec3(2));
    b.camera({0, 0.2f, 3}, {0, -0.2f, 0}, 0.9f);
    b.scene.meters.push_back({.name = "floor"});
    Node node;
    node.meter = 0;
    node.translation = {0, -0.9f, 0};
    b.scene.nodes.push_back(node);
    b.scene.roots.push_back(int(b.scene.nodes.size()) - 1);
    return b.scene;
}

RenderOptions smallPicture(std::uint32_t samples) {
    RenderOptions o;
    o.size = {37, 21};  // no multiple of a tile
    o.samples = samples;
    o.seed = 3;
    return o;
}

void expectSame(const RenderResult& a, const RenderResult& b) {
    ASSERT_EQ(a.image.data.size(), b.image.data.size());
    EXPECT_EQ(std::memcmp(a.image.data.data(), b.image.data.data(), a.image.data.size() * sizeof(float)), 0);
    EXPECT_EQ(a.rays.camera, b.rays.camera);
    EXPECT_EQ(a.rays.bounce, b.rays.bounce);
    EXPECT_EQ(a.rays.shadow, b.rays.shadow);
    EXPECT_EQ(a.truncatedPaths, b.truncatedPaths);
    EXPECT_EQ(a.error.relmse, b.error.relmse);
    ASSERT_EQ(a.meters.size(), b.meters.size());
    for (std::size_t i = 0; i < a.meters.size(); ++i) EXPECT_EQ(a.meters[i].value, b.meters[i].value);
}

void expectAgreement(const Scene& scene, RenderOptions o) {
    o.scheduler = Scheduler::Megakernel;
    const RenderResult megakernel = renderer().render(scene, o);
    o.scheduler = Scheduler::Wavefront;
    expectSame(renderer().render(scene, o), megakernel);
    EXPECT_GT(megakernel.rays.bounce, megakernel.rays.camera / 100);
}

TEST(Schedulers, AgreeOnASceneWrittenOut) {
    const Scene cornell = load("sample:cornell");
    RenderOptions o = smallPicture(40);
    o.adaptive = true;
    o.bounces = 2;
    expectAgreement(cornell, o);
    o = smallPicture(4);
    o.sampler = SamplerKind::SobolBlue;
    o.maxDepth = 3;
    expectAgreement(cornell, o);
}

TEST(Schedulers, AgreeOnMaterialsAlphaSurroundingsAndMeters) {
    expectAgreement(everything(), smallPicture(6));
}

/** A ball that crosses a lit floor while the shutter is open. */
TEST(Schedulers, AgreeOnWhatMoves) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.7f, 0.6f, 0.5f));
    b.quad({-2, -1, -2}, {-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, wall);
    const int ball = b.sphere({0, -0.4f, 0}, 0.5f, 2, false, wall);
    b.pointLight({1.5f, 1, 1}, glm::vec3(2));
    b.camera({0, 0.2f, 3}, {0, -0.2f, 0}, 0.9f);
    AnimationChannel crossing;
    crossing.node = b.scene.instances()[std::size_t(ball)].node;
    crossing.path = AnimationPath::Translation;
    crossing.times = {0, 1};
    crossing.values = {-1, 0, 0, 1, 0, 0};
    b.scene.animations.emplace_back().channels.push_back(crossing);
    RenderOptions o = smallPicture(6);
    o.shutter = {0.0, 1.0};
    expectAgreement(b.scene, o);
}

/** However many rounds a call makes, and whatever was done at its end. */
TEST(Schedulers, WavefrontsCanPauseAnywhere) {
    PathTraceOptions o;
    o.size = {21, 17};
    o.seed = 9;
    const Scene scene = everything();
    const Traced whole = trace(scene, o, 12, 12);
    o.scheduler = Scheduler::Wavefront;
    for (const std::uint32_t budget : {1u, 3000u}) {
        o.turnBudget = budget;
        const Traced parts = trace(scene, o, 12, 5);
        EXPECT_EQ(parts.counters.bounceRays, whole.counters.bounceRays);
        EXPECT_EQ(parts.counters.cameraRays, whole.counters.cameraRays);
        // Film sums are merged at the end of every step: the last bits differ from those of one step.
        for (std::size_t i = 0; i < whole.mean.size(); ++i)
            EXPECT_LT(glm::length(parts.mean[i] - whole.mean[i]), 1e-6 * (1 + glm::length(whole.mean[i])));
    }
}

/** The state between dispatches is the same: one scheduler goes on from the other's checkpoint. */
TEST(Schedulers, GoOnFromEachOthersCheckpoints) {
    const Scene scene = load("sample:cornell");
    for (const Scheduler first : {Scheduler::Megakernel, Scheduler::Wavefront}) {
        RenderOptions o = smallPicture(150);
        o.checkpointSeconds = 0;
        o.scheduler = first;
        const RenderResult whole = renderer().render(scene, o);
        o.checkpoint = std::filesystem::temp_directory_path() /
                       fmt::format("heliograph_schedulers_{}.checkpoint", getpid());
        std::filesystem::remove(o.checkpoint);
        o.progress = [](const Progress& p) { return p.stage != "render" || p.fraction < 0.1; };
        const RenderResult part = renderer().render(scene, o);
        EXPECT_LT(part.rays.camera, whole.rays.camera);
        o.progress = {};
        o.resume = true;
        o.scheduler = first == Scheduler::Wavefront ? Scheduler::Megakernel : Scheduler::Wavefront;
        expectSame(renderer().render(scene, o), whole);
        std::filesystem::remove(o.checkpoint);
    }
}

TEST(Schedulers, WavefrontsRefuseWhatIsTooLarge) {
    RenderOptions o;
    const std::uint64_t rows = renderer().device().info().maxStorageBufferRange / 48 / 2048 + 1;
    o.size = {2048, std::uint32_t(std::min<std::uint64_t>(rows, 4096))};
    o.scheduler = Scheduler::Wavefront;
    EXPECT_THROW(renderer().render(load("sample:cornell"), o), InputError);
}

}  // namespace
}  // namespace helio::test
