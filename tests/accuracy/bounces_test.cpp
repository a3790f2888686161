// Light by how often it scattered: the terms E, K E, K^2 E, ... of the rendering equation's series.
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace helio::test {
namespace {

/** A closed room that emits 1. */
Scene furnace(float albedo) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(albedo), glm::vec3(1.0f));
    b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
    b.camera({0.1f, 0.2f, 0.3f}, {0.4f, 0.1f, -1}, 1.2f);
    return b.scene;
}

RenderOptions options(std::uint32_t size, std::uint32_t samples, int bounces) {
    RenderOptions o;
    o.size = {size, size};
    o.samples = samples;
    o.bounces = bounces;
    o.sampler = SamplerKind::Independent;
    return o;
}

std::string layer(int k, int bounces) {
    return k <= bounces ? fmt::format("bounce.{}.R", k) : "bounce.rest.R";
}

/** Mean over the pixels, which are independent, and its standard error. */
struct Mean {
    double value = 0, error = 0;
};
Mean mean(const ImageF& image, const std::string& channel) {
    const auto c = std::size_t(image.channel(channel));
    double sum = 0, squares = 0;
    const double n = double(image.width) * image.height;
    for (std::size_t i = 0; i < std::size_t(n); ++i) {
        const double value = image.data[i * image.channels.size() + c];
        sum += value;
        squares += value * value;
    }
    return {sum / n, std::sqrt(std::max(squares / n - sum * sum / n / n, 0.0) / n)};
}

/** The largest difference, relative to the pixel, between a picture and the sum of its layers. */
double worstSum(const ImageF& image, int bounces) {
    double worst = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            double sum = 0;
            for (int k = 0; k <= bounces + 1; ++k)
                sum += double(image.at(x, y, std::size_t(image.channel(layer(k, bounces)))));
            const double whole = double(image.at(x, y, 0));
            worst = std::max(worst, std::abs(sum - whole) / std::max(std::abs(whole), 1e-6));
        }
    return worst;
}

/** Truth: after k reflections rho^k of the light is left, and after N all that remains is rho^(N+1) / (1 -
 * rho). */
TEST(Bounces, FurnaceHoldsThePowersOfItsAlbedo) {
    for (const float albedo : {0.5f, 0.8f})
        for (const bool nextEvent : {true, false}) {
            RenderOptions o = options(32, 128, 6);
            o.nextEventEstimation = nextEvent;
            const RenderResult result = renderer().render(furnace(albedo), o);
            for (int k = 0; k <= 7; ++k) {
                const double power = std::pow(double(albedo), k);
                const double truth = k <= 6 ? power : power / (1 - double(albedo));
                const Mean e = mean(result.image, layer(k, 6));
                const double z = (e.value - truth) / std::max(e.error, 1e-6 * truth);
                fmt::print("albedo {} next event {} {}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", albedo,
                           nextEvent, layer(k, 6), e.value, e.error, truth, z);
                EXPECT_LT(std::abs(z), 4.0);
                EXPECT_LT(e.error, k <= 6 ? 0.001 : 0.03 * truth);
                // Without roulette, which spares the first scatterings, nor a choice of ways nothing is
                // random.
                if (!nextEvent && (k < 2 || 3 * power > 1.0 + 1e-3) && k <= 6) {
                    EXPECT_NEAR(e.value, truth, 2e-6 * truth);
                }
            }
            EXPECT_LT(worstSum(result.image, 6), 1e-5);
        }
}

/** Terms of a picture are what cutting paths leaves between one depth and the next: path by path, since
 * random numbers do not depend on where paths are cut. */
TEST(Bounces, LayersAreWhatDepthsDifferBy) {
    const Scene scene = load("sample:cornell");
    RenderOptions o = options(24, 32, 2);
    const RenderResult split = renderer().render(scene, o);
    EXPECT_LT(worstSum(split.image, 2), 1e-5);
    o.bounces = -1;
    const RenderResult whole = renderer().render(scene, o);
    o.maxDepth = 1;
    const RenderResult direct = renderer().render(scene, o);
    const auto emitted = std::size_t(split.image.channel("bounce.0.R")),
               once = std::size_t(split.image.channel("bounce.1.R"));
    for (std::uint32_t y = 0; y < 24; ++y)
        for (std::uint32_t x = 0; x < 24; ++x) {
            const auto at = [&](const RenderResult& r, std::size_t c) { return double(r.image.at(x, y, c)); };
            EXPECT_NEAR(at(split, 0), at(whole, 0), 1e-5 * at(whole, 0)) << x << "," << y;
            EXPECT_NEAR(at(split, emitted) + at(split, once), at(direct, 0), 1e-5 * at(direct, 0) + 1e-7)
                << x << "," << y;
        }
    EXPECT_EQ(whole.image.channel("bounce.0.R"), -1);
}

/** Layers of an image so wide that they lie in several rows. */
TEST(Bounces, LayersOfAWideImage) {
    RenderOptions o = options(8, 2, 4);
    o.size = {4096, 2};
    o.maxDepth = 8;
    o.auxiliary = false;
    const RenderResult result = renderer().render(furnace(0.8f), o);
    EXPECT_LT(worstSum(result.image, 4), 1e-5);
    for (int k = 0; k <= 4; ++k) {
        const Mean e = mean(result.image, layer(k, 4));
        EXPECT_NEAR(e.value, std::pow(0.8, k), 4 * e.error + 1e-5) << k;
    }
}

/** A film that stops within a batch has the pixels that were through with it: so have the layers. */
TEST(Bounces, AStopWithinABatchLeavesWhatTheFilmHas) {
    Scene scene = furnace(0.8f);
    PathTraceOptions o;
    o.size = {32, 32};
    o.bounces = 1;
    o.turnBudget = 40;
    const PlacedCamera placed = chooseCamera(scene, "", 1.0);
    DeviceScene uploaded(device(), scene, PathTracer::packOptions(scene, o));
    Film film(device(), 32, 32);
    {
        Graph graph(device());
        declareFilmClear(graph, film, film.import(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    PathTracer tracer(device(), uploaded, scene.cameras[std::size_t(placed.camera)], placed.transform, o,
                      film);
    while (!tracer.advance(4)) {
    }
    for (int i = 0; i < 2; ++i) ASSERT_FALSE(tracer.advance(12));  // some pixels are there, others are not
    Graph graph(device());
    const ResolvedFilm resolved = declareFilmResolve(graph, film, film.import(graph));
    const auto read = graph.readback<float>(resolved.mean);
    Plan plan = graph.compile();
    const std::vector<float> mean = read.wait(plan.execute());
    const std::vector<std::vector<float>> layers = tracer.bounceLayers(mean);
    ASSERT_EQ(layers.size(), 3u);
    std::size_t early = 0, late = 0;
    for (std::size_t i = 0; i < mean.size() / 4; ++i) {
        (mean[4 * i + 3] > 4 ? late : early) += 1;
        const double sum = double(layers[0][3 * i]) + layers[1][3 * i] + layers[2][3 * i];
        EXPECT_NEAR(sum, double(mean[4 * i]), 1e-5 * double(mean[4 * i])) << i;
    }
    fmt::print("{} pixels through with the batch, {} not\n", late, early);
    EXPECT_GT(early, 0u);
    EXPECT_GT(late, 0u);
}

TEST(Bounces, WhatCannotBeIsRefused) {
    const Scene scene = furnace(0.5f);
    const auto refused = [&](const RenderOptions& o, const std::string& what) {
        try {
            renderer().render(scene, o);
            ADD_FAILURE() << what;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    RenderOptions o = options(16, 1, 65);
    refused(o, "give at most 64");
    o.bounces = 9;
    o.size = {4096, 4096};
    refused(o, "give at most 6");
    o = options(16, 1, 1);
    o.checkpoint = scratchFolder() / "checkpoint";
    refused(o, "checkpoint");
    o = options(16, 1, 1);
    o.pipeline = Pipeline::Raster;
    refused(o, "raster");
}

}  // namespace
}  // namespace helio::test
