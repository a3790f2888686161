// The renderer as an application uses it, on small pictures.

#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace helio {
namespace {

using test::renderer;

RenderOptions small(std::uint32_t samples, std::uint32_t size = 32) {
    RenderOptions options;
    options.size = {size, size};
    options.samples = samples;
    return options;
}

const Scene& cornell() {
    static const Scene scene = load("sample:cornell");
    return scene;
}

/** A gray square seen from the front, with nothing that gives light. */
Scene unlitSquare() {
    Scene scene;
    scene.name = "square";
    Material gray;
    gray.baseColor = {0.5f, 0.5f, 0.5f, 1};
    gray.metallic = 0;
    gray.specular = 0;
    scene.materials = {gray};
    Primitive square;
    square.positions = {{-5, -5, -2}, {5, -5, -2}, {5, 5, -2}, {-5, 5, -2}};
    square.indices = {0, 1, 2, 0, 2, 3};
    square.material = 0;
    scene.meshes = {{"square", {square}}};
    scene.cameras = {Camera{}};
    Node object, camera;
    object.mesh = 0;
    camera.camera = 0;
    scene.nodes = {object, camera};
    scene.roots = {0, 1};
    return scene;
}

double relmse(const ImageF& image, const ImageF& reference) {
    return compareImages(image, reference).relmse;
}

TEST(Renderer, RepeatsTheSameBits) {
    const RenderResult first = renderer().render(cornell(), small(16));
    EXPECT_EQ(first.image.data, renderer().render(cornell(), small(16)).image.data);
    Renderer other(test::deviceOptions());
    EXPECT_EQ(first.image.data, other.render(cornell(), small(16)).image.data);
    EXPECT_GT(first.image.data[0], 0);
    EXPECT_EQ(first.nanCount, 0u);
    EXPECT_EQ(first.samples, 16u);
    EXPECT_EQ(first.rays.camera, 32u * 32 * 16);
}

TEST(Renderer, SeedsAndSamplersDiffer) {
    RenderOptions options = small(16);
    const ImageF zero = renderer().render(cornell(), options).image;
    options.seed = 1;
    const ImageF one = renderer().render(cornell(), options).image;
    EXPECT_NE(zero.data, one.data);
    EXPECT_LT(relmse(zero, one), 1);
    options.sampler = SamplerKind::Independent;
    const ImageF independent = renderer().render(cornell(), options).image;
    EXPECT_NE(one.data, independent.data);
    EXPECT_LT(relmse(independent, one), 1);
}

TEST(Renderer, StatisticsHaveTheContractsKeys) {
    const RenderResult result = renderer().render(cornell(), small(8));
    const nlohmann::json json = nlohmann::json::parse(result.json());
    const auto keys = [](const nlohmann::json& object) {
        std::set<std::string> names;
        for (const auto& [key, value] : object.items()) names.insert(key);
        return names;
    };
    using Keys = std::set<std::string>;
    EXPECT_EQ(keys(json), (Keys{"version", "device", "scene", "seed", "spp", "setup_seconds",
                                "setup_cpu_seconds", "render_seconds", "render_cpu_seconds", "rays", "error",
                                "nan_count", "truncated_paths", "memory", "passes", "features", "skipped"}));
    EXPECT_EQ(keys(json["rays"]), (Keys{"camera", "bounce", "shadow"}));
    EXPECT_EQ(keys(json["error"]), (Keys{"relmse", "low", "high", "reliable"}));
    EXPECT_EQ(keys(json["memory"]), (Keys{"host_bytes", "device_bytes"}));
    EXPECT_EQ(keys(json["passes"].at(0)), (Keys{"name", "ms"}));
    EXPECT_EQ(keys(json["skipped"].at(0)), (Keys{"what", "why"}));
    EXPECT_EQ(json["scene"], "sample:cornell");
    EXPECT_EQ(json["spp"], 8);
    EXPECT_GT(json["render_seconds"], 0.0);
    EXPECT_GT(json["render_cpu_seconds"], 0.0);
    EXPECT_GT(json["setup_seconds"], 0.0);
    EXPECT_GT(json["memory"]["host_bytes"], 1000000);
    EXPECT_GT(json["memory"]["device_bytes"], 1000);
    EXPECT_GT(json["rays"]["bounce"], 0);
    EXPECT_FALSE(json["features"].empty());
    EXPECT_NE(renderer().graphviz().find("digraph"), std::string::npos);
}

TEST(Renderer, HasTheContractsChannels) {
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        RenderOptions options = small(8);
        options.pipeline = pipeline;
        const ImageF image = renderer().render(cornell(), options).image;
        for (const char* name :
             {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z",
              "depth.Z", "variance.R", "variance.G", "variance.B", "samples", "id.instance", "id.triangle"}) {
            EXPECT_GE(image.channel(name), 0) << name;
        }
        EXPECT_EQ(image.at(3, 3, std::size_t(image.channel("samples"))), pipeline == Pipeline::Path ? 8 : 1);
        options.auxiliary = false;
        EXPECT_EQ(renderer().render(cornell(), options).image.channels.size(), 3u);
    }
}

TEST(Renderer, CancelledRendersHoldWholeBatches) {
    RenderOptions options = small(4096);
    std::uint32_t reached = 0;
    options.progress = [&](const Progress& progress) {
        reached = progress.samples;
        return progress.samples < 64;
    };
    const RenderResult cancelled = renderer().render(cornell(), options);
    EXPECT_TRUE(cancelled.cancelled);
    EXPECT_GE(cancelled.samples, 64u);
    EXPECT_LT(cancelled.samples, 4096u);
    EXPECT_EQ(cancelled.samples, reached);
    const RenderResult whole = renderer().render(cornell(), small(cancelled.samples));
    EXPECT_EQ(cancelled.image.data, whole.image.data);
    EXPECT_EQ(cancelled.error.relmse, whole.error.relmse);
    EXPECT_EQ(cancelled.error.reliable, whole.error.reliable);
}

TEST(Renderer, CancelledInTheMiddleOfABatchHoldsTheOnesBefore) {
    RenderOptions options = small(8192, 96);
    Progress last;
    options.progress = [&](const Progress& progress) {
        last = progress;
        return progress.fraction * 8192 <
               progress.samples + 16;  // until paths beyond the last end are traced
    };
    const RenderResult cancelled = renderer().render(cornell(), options);
    EXPECT_TRUE(cancelled.cancelled);
    EXPECT_GT(last.samples, 0u);
    EXPECT_EQ(cancelled.samples, last.samples);
    // Pixels that were through with the batch hold it too, and say so.
    const ImageF whole = renderer().render(cornell(), small(last.samples, 96)).image;
    const auto samples = std::size_t(whole.channel("samples"));
    int unfinished = 0;
    for (std::uint32_t y = 0; y < 96; ++y) {
        for (std::uint32_t x = 0; x < 96; ++x) {
            EXPECT_GE(cancelled.image.at(x, y, samples), last.samples);
            if (cancelled.image.at(x, y, samples) != last.samples) continue;
            ++unfinished;
            for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(cancelled.image.at(x, y, c), whole.at(x, y, c));
        }
    }
    EXPECT_GT(unfinished, 0);
}

TEST(Renderer, CancelledBeforeTheFirstSampleIsBlack) {
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        for (const char* stage : {"load", "compile"}) {
            RenderOptions options = small(8);
            options.pipeline = pipeline;
            std::vector<std::string> stages;
            options.progress = [&](const Progress& progress) {
                stages.push_back(progress.stage);
                return progress.stage != stage;
            };
            const RenderResult result = renderer().render(cornell(), options);
            EXPECT_TRUE(result.cancelled);
            EXPECT_EQ(stages.back(), stage);
            EXPECT_EQ(result.samples, 0u);
            EXPECT_EQ(result.image.data, std::vector<float>(32 * 32 * 3, 0.0f));
        }
    }
}

TEST(Renderer, CancelledWhileKernelsCompileIsBlack) {
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        RenderOptions options = small(8);
        options.pipeline = pipeline;
        int calls = 0;
        options.progress = [&](const Progress& progress) {
            EXPECT_NE(progress.stage, "render");
            return ++calls < 3;  // load, compile, compiled
        };
        const RenderResult result = renderer().render(cornell(), options);
        EXPECT_TRUE(result.cancelled);
        EXPECT_EQ(result.samples, 0u);
        EXPECT_EQ(result.image.data, std::vector<float>(32 * 32 * 3, 0.0f));
    }
}

TEST(Renderer, RefusesMoreSamplesThanTheStateCounts) {
    EXPECT_THROW(renderer().render(cornell(), small(1u << 24)), InputError);
}

TEST(Renderer, ProgressGoesFromLoadToTheEnd) {
    RenderOptions options = small(256);
    std::vector<Progress> seen;
    options.progress = [&](const Progress& progress) {
        seen.push_back(progress);
        return true;
    };
    renderer().render(cornell(), options);
    ASSERT_GE(seen.size(), 5u);
    EXPECT_EQ(seen[0].stage, "load");
    EXPECT_EQ(seen[1].stage, "compile");
    EXPECT_EQ(seen[2].stage, "compile");  // set-up is over
    for (std::size_t i = 3; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i].stage, "render");
        EXPECT_GE(seen[i].samples, seen[i - 1].samples);
        EXPECT_GT(seen[i].raysPerSecond, 0);
    }
    EXPECT_EQ(seen.back().samples, 256u);
    EXPECT_EQ(seen.back().fraction, 1);
}

TEST(Renderer, KeepsTheSceneWhereOnlyTheCameraMoves) {
    Scene scene = cornell();
    const RenderResult before = renderer().render(scene, small(8));
    const std::uint64_t builds = renderer().sceneBuilds();
    for (Node& node : scene.nodes) {
        if (node.camera < 0) continue;
        if (node.matrix) (*node.matrix)[3].x += 20.0f;
        node.translation.x += 20.0f;
    }
    const RenderResult moved = renderer().render(scene, small(8));
    EXPECT_EQ(renderer().sceneBuilds(), builds);
    EXPECT_NE(moved.image.data, before.image.data);
    scene.materials[0].baseColor *= 0.5f;
    renderer().render(scene, small(8));
    EXPECT_EQ(renderer().sceneBuilds(), builds + 1);
    scene.meshes[0].primitives[0].positions[0].y += 1e-3f;
    renderer().render(scene, small(8));
    EXPECT_EQ(renderer().sceneBuilds(), builds + 2);
    RenderOptions sky = small(8);
    sky.environment = Environment{glm::vec3(0.25f), -1};
    renderer().render(scene, sky);
    EXPECT_EQ(renderer().sceneBuilds(), builds + 3);
    renderer().render(scene, sky);
    EXPECT_EQ(renderer().sceneBuilds(), builds + 3);
}

TEST(Renderer, StopsAtTheErrorAskedFor) {
    RenderOptions options = small(1u << 14);
    options.maxError = 0.004;
    const RenderResult result = renderer().render(cornell(), options);
    EXPECT_LT(result.samples, 1u << 14);
    EXPECT_GE(result.samples, 8u);
    EXPECT_LT(result.error.high, 0.004);
    EXPECT_EQ(result.image.data, renderer().render(cornell(), options).image.data);
}

TEST(Renderer, StopsAtTheTimeAskedFor) {
    RenderOptions options = small(1u << 20);
    options.maxSeconds = 0.3;
    const RenderResult result = renderer().render(cornell(), options);
    EXPECT_LT(result.samples, 1u << 20);
    EXPECT_GT(result.samples, 0u);
}

TEST(Renderer, TimeIsKeptToADispatch) {
    RenderOptions options = small(64, 256);
    options.maxSeconds = 1e-9;
    int dispatches = 0;
    options.progress = [&](const Progress& progress) {
        dispatches += progress.stage == "render";
        return true;
    };
    const RenderResult result = renderer().render(load("sample:glass"), options);
    EXPECT_EQ(dispatches, 1);
    EXPECT_FALSE(result.cancelled);
    EXPECT_LE(result.samples, 1u);
    ASSERT_EQ(result.image.width, 256u);
    // What is done is there, and what is not is told.
    double sampled = 0;
    for (std::uint32_t i = 0; i < 256 * 256; ++i) sampled += result.image.at(i % 256, i / 256, 0) > 0;
    EXPECT_GT(sampled, 0);
    const bool told = std::ranges::any_of(result.warnings, [](const std::string& warning) {
        return warning.find("had no sample yet") != std::string::npos;
    });
    EXPECT_EQ(told, result.samples == 0);
}

TEST(Renderer, ErrorIntervalContainsTheTruth) {
    // The truth: 8192 samples, whose own error is under a hundredth of that of the 64 that are judged.
    RenderOptions exact = small(1u << 13);
    exact.seed = 12345;
    const RenderResult truth = renderer().render(cornell(), exact);
    int covered = 0;
    verify::RunningStatistics estimates, errors;
    const int seeds = 20;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        RenderOptions options = small(64);
        options.seed = seed;
        const RenderResult result = renderer().render(cornell(), options);
        const double error = relmse(result.image, truth.image);
        covered += result.error.low <= error && error <= result.error.high;
        estimates.add(result.error.relmse);
        errors.add(error);
    }
    EXPECT_GE(covered, 16) << "of " << seeds;
    EXPECT_LT(truth.error.high, 0.01 * errors.mean());
    EXPECT_NEAR(estimates.mean() / errors.mean(), 1, 0.2);
}

TEST(Renderer, VarianceChannelIsTheVarianceOverSeeds) {
    for (const SamplerKind sampler : {SamplerKind::Sobol, SamplerKind::Independent}) {
        const std::size_t pixels = 32 * 32;
        std::vector<verify::RunningStatistics> values(pixels);
        std::vector<double> told(pixels);
        const int seeds = 40;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            RenderOptions options = small(32);
            options.sampler = sampler;
            options.seed = seed;
            const ImageF image = renderer().render(cornell(), options).image;
            for (std::size_t i = 0; i < pixels; ++i) {
                values[i].add(image.data[i * image.channels.size() + 1]);
                told[i] +=
                    image.data[i * image.channels.size() + std::size_t(image.channel("variance.G"))] / seeds;
            }
        }
        // Weighted as relMSE is, so that the lamp's edge is not all of the sum.
        double measured = 0, claimed = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            const double weight = 1 / (values[i].mean() * values[i].mean() + 0.01);
            measured += weight * values[i].variance();
            claimed += weight * told[i];
        }
        // Under the Sobol sampler it is an estimate from neighbouring pixels.
        EXPECT_NEAR(claimed / measured, 1, sampler == SamplerKind::Sobol ? 0.25 : 0.1);
    }
}

TEST(Renderer, GivesMemoryBack) {
    Renderer own(test::deviceOptions());
    // The staging ring is made at the first large upload and kept.
    makeBuffer(own.device(), "large", std::vector<std::uint32_t>(1u << 22));
    std::vector<std::uint64_t> used, live;
    for (int round = 0; round < 4; ++round) {
        for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
            RenderOptions options = small(4);
            options.pipeline = pipeline;
            own.render(unlitSquare(), options);
            options.size = {64, 48};
            own.render(cornell(), options);
        }
        used.push_back(own.device().memory().usedBytes);
        live.push_back(own.device().memory().allocations);
    }
    // The first round also makes what is kept for good.
    EXPECT_EQ(used[3], used[1]);
    EXPECT_EQ(live[3], live[1]);
}

TEST(Renderer, LightsAnUnlitSceneAndSaysSo) {
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        RenderOptions options = small(16, 8);
        options.pipeline = pipeline;
        options.maxDepth = 1;
        const RenderResult lit = renderer().render(unlitSquare(), options);
        ASSERT_EQ(lit.warnings.size(), 1u);
        EXPECT_NE(lit.warnings[0].find("--environment 0,0,0"), std::string::npos);
        // Albedo 0.5 under radiance 1 from everywhere.
        EXPECT_NEAR(lit.image.at(4, 4, 0), 0.5f, 1e-5f);
        options.environment = Environment{};
        const RenderResult black = renderer().render(unlitSquare(), options);
        ASSERT_EQ(black.warnings.size(), 1u);
        EXPECT_NE(black.warnings[0].find("black"), std::string::npos);
        EXPECT_EQ(black.image.at(4, 4, 0), 0);
        EXPECT_EQ(black.error.relmse, 0);
    }
}

TEST(Renderer, RefusesSenselessOptions) {
    const auto refused = [](const RenderOptions& options) {
        EXPECT_THROW(renderer().render(cornell(), options), InputError);
    };
    refused(small(0));
    refused(small(8, 0));
    RenderOptions options = small(8);
    options.maxError = -1;
    refused(options);
    options = small(8);
    options.maxSeconds = NAN;
    refused(options);
    options = small(8);
    options.environment = Environment{glm::vec3(-1.0f), -1};
    refused(options);
    options = small(8);
    options.camera = "no such camera";
    refused(options);
    options = small(8);
    options.size = {100000, 8};
    refused(options);
}

TEST(Renderer, RefusesScenesThatNothingCanBeComputedFrom) {
    Scene scene = unlitSquare();
    scene.meshes[0].primitives[0].indices[4] = 99;
    try {
        renderer().render(scene, small(1));
        FAIL() << "an index out of range was taken";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("99"), std::string::npos) << error.what();
    }
}

TEST(Renderer, SavedFilesCarryTheMetadata) {
    const RenderResult result = renderer().render(cornell(), small(8));
    const std::filesystem::path file = test::scratchFolder() / "result.exr";
    save(file, result);
    const ImageF loaded = loadImage(file);
    for (const char* key : {"scene", "seed", "samples", "seconds", "error", "device", "version"}) {
        EXPECT_TRUE(loaded.metadata.contains(key)) << key;
    }
    ASSERT_EQ(loaded.channels.size(), result.image.channels.size());
    for (std::size_t c = 0; c < result.image.channels.size(); ++c) {
        const int at = loaded.channel(result.image.channels[c]);
        ASSERT_GE(at, 0) << result.image.channels[c];
        EXPECT_EQ(loaded.at(7, 9, std::size_t(at)), result.image.at(7, 9, c));
    }
}

}  // namespace
}  // namespace helio
