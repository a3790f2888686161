/** @file Rows A8 and A9: frames mixed over time, against the samples that they are made of. */
#include "passes/temporal/temporal.hpp"

#include "tests/support/renderer.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace helio {
namespace {

using test::renderer;

/** A glowing rectangle in pixels of an orthographic view of `size` (x to the right, y up, from the middle).
 */
void addPlate(Scene& scene, glm::vec2 from, glm::vec2 to, float z, float radiance, int texture = -1) {
    Material material;
    material.baseColor = {0, 0, 0, 1};
    material.emission = glm::vec3(radiance);
    material.emissiveTexture.texture = texture;
    Primitive plate;
    plate.positions = {{from.x, from.y, z}, {to.x, from.y, z}, {to.x, to.y, z}, {from.x, to.y, z}};
    plate.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    plate.indices = {0, 1, 2, 0, 2, 3};
    plate.material = int(scene.materials.size());
    scene.materials.push_back(material);
    Node node;
    node.mesh = int(scene.meshes.size());
    scene.meshes.push_back({"", {plate}});
    scene.roots.push_back(int(scene.nodes.size()));
    scene.nodes.push_back(node);
}

/** An orthographic camera, a pixel a unit. */
void addCamera(Scene& scene, std::uint32_t height) {
    Camera camera;
    camera.perspective = false;
    camera.ymag = 0.5f * float(height);
    camera.znear = 0.1f;
    camera.zfar = 100;
    scene.cameras = {camera};
    Node eye;
    eye.camera = 0;
    scene.roots.push_back(int(scene.nodes.size()));
    scene.nodes.push_back(eye);
}

/** The last node goes by `step` a frame, `frames` in all, and is at 0 at the time 0. */
void moveLast(Scene& scene, glm::vec3 step, std::uint32_t frames, int node) {
    AnimationChannel channel;
    channel.node = node;
    const auto last = float(frames - 1);
    channel.times = {-last / 64, 0};
    channel.values = {-last * step.x, -last * step.y, -last * step.z, 0, 0, 0};
    scene.animations = {{"", {channel}}};
}

RenderOptions optionsOf(std::array<std::uint32_t, 2> size, const Antialiasing& how) {
    RenderOptions options;
    options.size = size;
    options.pipeline = Pipeline::Raster;
    options.samples = 1;
    options.environment = Environment{};
    options.antialiasing = how;
    options.antialiasing.temporal.frameSeconds = 1.0 / 64;
    options.auxiliary = false;
    return options;
}

ImageF draw(const Scene& scene, std::array<std::uint32_t, 2> size, const Antialiasing& how) {
    return renderer().render(scene, optionsOf(size, how)).image;
}

/** The picture of one sample a pixel, at position k. */
ImageF sampleImage(const Scene& scene, std::array<std::uint32_t, 2> size, const Antialiasing& how,
                   std::size_t k) {
    Antialiasing one;
    one.kind = Antialiasing::Kind::Supersampling;
    one.positions = {how.positions[k % how.positions.size()]};
    return draw(scene, size, one);
}

/** Mixes by the law that is promised: the first 1/blend samples weigh the same, then each new one `blend`. */
std::vector<double> mixed(const Scene& scene, std::array<std::uint32_t, 2> size, const Antialiasing& how) {
    std::vector<ImageF> images;
    for (std::size_t k = 0; k < how.positions.size(); ++k) images.push_back(sampleImage(scene, size, how, k));
    std::vector<double> sum(images[0].data.size(), 0.0);
    double past = 0;
    for (std::uint32_t frame = 0; frame < how.temporal.frames; ++frame) {
        const ImageF& image = images[frame % images.size()];
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (double(image.data[i]) - sum[i]) / (past + 1);
        past = std::min(past + 1, 1 / how.temporal.blend - 1);
    }
    return sum;
}

TEST(Temporal, AStillSceneIsTheMeanOfItsSamples) {
    constexpr std::array<std::uint32_t, 2> size = {40, 32};
    Scene scene;
    addPlate(scene, {-9.3f, -11.7f}, {7.9f, 6.4f}, -5, 1);
    addPlate(scene, {2.1f, -30.0f}, {2.6f, 30.0f}, -4, 3);  // thinner than a pixel
    addPlate(scene, {-30.0f, -3.0f}, {30.0f, -2.7f}, -3, 2);
    addCamera(scene, size[1]);
    Antialiasing how = antialiasing("taa");
    ASSERT_EQ(how.positions.size(), 16u);
    how.temporal.blend = 1.0 / 16;
    Antialiasing all = how;
    all.kind = Antialiasing::Kind::Supersampling;
    for (const std::uint32_t frames : {1u, 16u, 70u}) {
        how.temporal.frames = frames;
        const ImageF image = draw(scene, size, how);
        const std::vector<double> expected = mixed(scene, size, how);
        double worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            worst = std::max(worst, std::abs(double(image.data[i]) - expected[i]));
        fmt::print("{} frames: {:.1e} from their mixture\n", frames, worst);
        EXPECT_LT(worst, 3e-6) << frames;
        if (frames != 16) continue;
        const ImageF supersampled = draw(scene, size, all);
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_NEAR(image.data[i], supersampled.data[i], 3e-6f) << i;
    }
}

/** Noise of variance 1 goes down to blend / (2 - blend). */
TEST(Temporal, NoiseThatIsLeftIsTheBlendOverTwoLessIt) {
    constexpr std::uint32_t side = 96;
    const double blend = 0.1;
    TemporalHistory history(test::device(), {side, side}, 1, 0);
    DeviceBuffer color(test::device(), "noise", side * side * 16),
        keys(test::device(), "keys", side * side * 8),
        triangle = makeBuffer(test::device(), "triangle", std::vector<glm::uvec4>(3, glm::uvec4(0)));
    keys.upload(std::vector<std::uint64_t>(side * side, 0).data(), side * side * 8);
    auto view = std::make_shared<RasterView>();
    view->rowX = {side, 0, 0.5 * side};
    view->rowY = {0, side, 0.5 * side};
    view->rowW = {0, 0, 1};
    view->depthOffset = 0.1;
    view->width = view->height = side;
    Graph graph(test::device());
    const Buffer picture =
        history.declare(graph, {graph.import(keys), graph.import(color), graph.import(triangle)}, view);
    const Readback<glm::vec4> result = graph.readback<glm::vec4>(picture);
    Plan plan = graph.compile({.executionsInFlight = 1});
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    double sum = 0, squares = 0;
    std::size_t count = 0;
    for (int frame = 0; frame < 180; ++frame) {
        std::vector<glm::vec4> noise;
        for (std::uint32_t i = 0; i < side * side; ++i)
            noise.emplace_back(normal(random), normal(random), 0.5f, 1.0f);
        color.upload(noise.data(), noise.size() * 16);
        history.beginFrame(*view, {0.5f, 0.5f}, blend, false);
        const Execution done = plan.execute();
        const std::vector<glm::vec4> image = result.wait(done);
        if (frame % 40 != 59 % 40 || frame < 59) continue;  // apart enough to be independent
        for (const glm::vec4& pixel : image) {
            ASSERT_EQ(pixel.z, 0.5f);  // what does not change keeps its bits
            for (const float value : {pixel.x, pixel.y}) {
                sum += value;
                squares += double(value) * value;
                ++count;
            }
        }
    }
    const double mean = sum / double(count), variance = squares / double(count) - mean * mean;
    const double expected = blend / (2 - blend), error = expected * std::sqrt(2.0 / double(count));
    fmt::print("variance {:.6f}, expected 1/19 = {:.6f}, z {:+.2f} of {} values\n", variance, expected,
               (variance - expected) / error, count);
    EXPECT_NEAR(variance, expected, 0.05 * expected);
    EXPECT_LT(std::abs(variance - expected) / error, 5);
}

constexpr std::uint32_t kPeriod = 16;  // pixels of the plane's stripes

/** A plane of smooth stripes that the camera passes by `step` pixels a frame. */
Scene pannedPlane(float step, std::uint32_t frames, std::uint32_t height) {
    Scene scene;
    constexpr std::uint32_t texels = 1024;
    std::vector<float> image;
    for (std::uint32_t x = 0; x < texels; ++x) {
        const auto value = float(0.5 + 0.4 * std::sin(2 * M_PI * (x + 0.5) / kPeriod));
        image.insert(image.end(), {value, value, value, 1.0f});
    }
    scene.images = {{"stripes", texels, 1, std::move(image)}};
    scene.textures.resize(1);
    scene.textures[0].image = 0;
    addPlate(scene, {-512, -512}, {512, 512}, -5, 1, 0);
    addCamera(scene, height);
    moveLast(scene, {step, 0, 0}, frames, 1);
    return scene;
}

/** Interpolation by Catmull and Rom's cubic at a fraction between texels: what a wave of this angle a texel
 * becomes. */
std::complex<double> cubicGain(double t, double angle) {
    const double w[4] = {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (1.5 * t - 2.5),
                         t * (0.5 + t * (2 - 1.5 * t)), t * t * (0.5 * t - 0.5)};
    std::complex<double> sum = 0;
    for (int k = 0; k < 4; ++k) sum += w[k] * std::polar(1.0, angle * (k - 1 - t));
    return sum;
}

TEST(Temporal, APanOverAPlaneLeavesNoGhost) {
    constexpr std::array<std::uint32_t, 2> size = {112, 4};
    constexpr std::uint32_t frames = 24;
    Antialiasing how = antialiasing("taa");
    how.temporal.frames = frames;
    for (const float step : {0.0f, 1.0f, 2.0f, 1.25f, 0.5f}) {
        const Scene scene = pannedPlane(step, frames, size[1]);
        const ImageF image = draw(scene, size, how);
        const std::vector<double> expected = mixed(scene, size, how);  // all seen from the last place
        // A frame's interpolation changes the wave by 1 - g; of the frames before, 1 - blend, it goes on.
        const double blend = how.temporal.blend, fraction = double(step) - std::floor(double(step));
        const std::complex<double> g = cubicGain(fraction, 2 * M_PI / kPeriod);
        const double bound = 0.4 * std::abs(1.0 - blend / (1.0 - (1.0 - blend) * g));
        const std::uint32_t entered = std::uint32_t(std::ceil(step * frames)) + 2;
        double worst = 0;
        for (std::uint32_t x = 2; x + 2 < size[0] - entered; ++x)
            worst = std::max(worst, std::abs(image.at(x, 1, 0) - expected[(size[0] + x) * 3]));
        fmt::print("{} pixels a frame: {:.2e} off, interpolation {:.2e}\n", step, worst, bound);
        EXPECT_LT(worst, 1.05 * bound + (fraction > 0 ? 5e-4 : 5e-6));  // and a linear texture's error
    }
}

TEST(Temporal, WhatAMovingSurfaceUncoversShowsNoTraceOfIt) {
    constexpr std::array<std::uint32_t, 2> size = {64, 32};
    constexpr std::uint32_t frames = 12;
    Scene scene;
    addPlate(scene, {-100, -100}, {100, 100}, -9, 0.25f);
    addPlate(scene, {2.3f, -8.4f}, {14.6f, 7.2f}, -3, 1);
    addCamera(scene, size[1]);
    moveLast(scene, {2.7f, 0, 0}, frames, 1);
    Antialiasing how = antialiasing("taa");
    how.temporal.frames = frames;
    const ImageF image = draw(scene, size, how);
    double worst = 0;
    int looked = 0;
    for (std::uint32_t y = 0; y < size[1]; ++y)
        for (std::uint32_t x = 0; x < size[0]; ++x) {
            const double px = x + 0.5 - 32, py = 16 - (y + 0.5);
            const double outside = std::max({2.3 - px, px - 14.6, -8.4 - py, py - 7.2});
            if (std::abs(outside) < 2) continue;  // near its outline colours around are of both
            worst = std::max(worst, std::abs(image.at(x, y, 0) - (outside > 0 ? 0.25 : 1.0)));
            ++looked;
        }
    fmt::print("{} pixels, {:.1e} off at most\n", looked, worst);
    EXPECT_GT(looked, 1500);
    EXPECT_LT(worst, 1e-6);
    // The same from a camera that goes along with the surface: the background moves.
    moveLast(scene, {2.7f, 0, 0}, frames, 2);
    const ImageF passed = draw(scene, size, how);
    for (std::uint32_t x = 0; x < size[0]; ++x)
        if (x < 31 || x > 50) {
            ASSERT_NEAR(passed.at(x, 16, 0), 0.25f, 1e-6f) << x;
        }
}

TEST(Upscaler, AConstantStaysOne) {
    constexpr std::array<std::uint32_t, 2> size = {48, 24};
    Scene scene;
    addPlate(scene, {-100, -100}, {100, 100}, -9, 0.3f);
    addCamera(scene, size[1]);
    moveLast(scene, {1.3f, 0.4f, 0}, 9, 1);
    for (const char* name : {"taa", "taau2", "taau3", "taau4"}) {
        Antialiasing how = antialiasing(name);
        how.temporal.frames = 9;
        const ImageF image = draw(scene, size, how);
        for (std::size_t i = 0; i < image.data.size(); ++i) ASSERT_EQ(image.data[i], 0.3f) << name << i;
    }
}

/** Half as many pixels each way, brought to full size by a kernel of its distance in those pixels. */
std::vector<double> enlarge(const ImageF& small, std::array<std::uint32_t, 2> size, int reach,
                            const std::function<double(double)>& kernel) {
    std::vector<double> result;
    const double scale = double(small.width) / size[0];
    for (std::uint32_t y = 0; y < size[1]; ++y)
        for (std::uint32_t x = 0; x < size[0]; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const double u = (x + 0.5) * scale - 0.5, v = (y + 0.5) * scale - 0.5;
                double sum = 0;
                for (int j = int(std::floor(v)) + 1 - reach; j <= int(std::floor(v)) + reach; ++j)
                    for (int i = int(std::floor(u)) + 1 - reach; i <= int(std::floor(u)) + reach; ++i)
                        sum += kernel(u - i) * kernel(v - j) *
                               double(small.at(std::uint32_t(std::clamp(i, 0, int(small.width) - 1)),
                                               std::uint32_t(std::clamp(j, 0, int(small.height) - 1)), c));
                result.push_back(sum);
            }
    return result;
}

double linear(double x) {
    return std::max(0.0, 1 - std::abs(x));
}
double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
    return x < 2 ? 2 + x * (-4 + x * (2.5 - 0.5 * x)) : 0;
}

/** Peak signal to noise of pictures as they are displayed: 0 to 1, roughly by a display's curve. */
template <typename Image>
double psnr(const Image& image, const std::vector<float>& truth) {
    double sum = 0;
    const auto shown = [](double x) { return std::sqrt(std::clamp(x, 0.0, 1.0)); };
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error = shown(double(image[i])) - shown(double(truth[i]));
        sum += error * error;
    }
    return -10 * std::log10(sum / double(truth.size()));
}

/** Structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment", 2004) of the same
 * displayed values: the mean over all windows of 11 x 11 with their Gaussian of 1.5 pixels, and over R, G and
 * B. */
template <typename Image>
double ssim(const Image& image, const std::vector<float>& truth, std::size_t width) {
    constexpr int reach = 5;
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const auto shown = [](double x) { return std::sqrt(std::clamp(x, 0.0, 1.0)); };
    const std::size_t height = truth.size() / 3 / width;
    double weights[2 * reach + 1], whole = 0, sum = 0;
    for (int i = -reach; i <= reach; ++i) whole += weights[i + reach] = std::exp(-i * i / (2 * 1.5 * 1.5));
    std::size_t windows = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t y = reach; y + reach < height; ++y)
            for (std::size_t x = reach; x + reach < width; ++x, ++windows) {
                double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
                for (int j = -reach; j <= reach; ++j)
                    for (int i = -reach; i <= reach; ++i) {
                        const std::size_t at = ((y + std::size_t(reach + j) - reach) * width + x +
                                                std::size_t(reach + i) - reach) *
                                                   3 +
                                               c;
                        const double w = weights[i + reach] * weights[j + reach] / (whole * whole);
                        const double u = shown(double(image[at])), v = shown(double(truth[at]));
                        a += w * u;
                        b += w * v;
                        aa += w * u * u;
                        bb += w * v * v;
                        ab += w * u * v;
                    }
                sum += (2 * a * b + c1) * (2 * (ab - a * b) + c2) /
                       ((a * a + b * b + c1) * (aa - a * a + bb - b * b + c2));
            }
    return sum / double(windows);
}

TEST(Upscaler, SimilarityIsThatOfItsFormula) {
    // Of a plane of values and the same times k, plus d, the formula can be written down for every window.
    constexpr std::size_t width = 32;
    std::vector<float> truth(width * 24 * 3), scaled(truth.size());
    std::mt19937 random(4);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double v = 0.2 + 0.2 * (random() / 4294967296.0);
        truth[i] = float(v * v);
        scaled[i] = float((0.5 + v) * (0.5 + v));  // displayed: 0.5 more
    }
    EXPECT_NEAR(ssim(truth, truth, width), 1, 1e-12);
    // Structure is kept: only means differ, of about 0.3 and 0.8.
    EXPECT_NEAR(ssim(scaled, truth, width), (2 * 0.3 * 0.8 + 1e-4) / (0.3 * 0.3 + 0.8 * 0.8 + 1e-4), 0.003);
    for (float& v : scaled) v = 0.04f;
    EXPECT_LT(ssim(scaled, truth, width), 0.25);  // no structure at all
}

/** Scenes that its constants were not set on, at rest and with a camera that moves. */
TEST(Upscaler, BeatsBilinearAndBicubicEverywhere) {
    constexpr std::array<std::uint32_t, 2> size = {96, 64}, half = {48, 32};
    for (const char* name : {"sample:shading", "sample:instances", "sample:gallery"})
        for (const bool moves : {false, true}) {
            Scene scene = load(name);
            if (moves) {
                for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
                    if (scene.nodes[i].camera != 0) continue;
                    const glm::vec3 end = scene.nodes[i].translation;
                    const glm::vec3 begin = end + 0.05f * glm::length(end) * glm::vec3(1, 0.3f, 0.2f);
                    AnimationChannel channel;
                    channel.node = int(i);
                    channel.times = {-0.5f, 0};
                    channel.values = {begin.x, begin.y, begin.z, end.x, end.y, end.z};
                    scene.animations = {{"", {channel}}};
                }
                if (scene.animations.empty()) continue;
            }
            const auto pictureOf = [&](std::array<std::uint32_t, 2> of, const char* how) {
                RenderOptions options = optionsOf(of, antialiasing(how));
                options.environment.reset();
                options.shadows.resolution = 256;
                return renderer().render(scene, options).image;
            };
            const ImageF truth = pictureOf(size, "ssaa16"), small = pictureOf(half, "none"),
                         upscaled = pictureOf(size, "taau2");
            const double bilinear = psnr(enlarge(small, size, 1, linear), truth.data),
                         bicubic = psnr(enlarge(small, size, 2, catmullRom), truth.data),
                         temporal = psnr(upscaled.data, truth.data);
            const double bilinearSsim = ssim(enlarge(small, size, 1, linear), truth.data, size[0]),
                         bicubicSsim = ssim(enlarge(small, size, 2, catmullRom), truth.data, size[0]),
                         temporalSsim = ssim(upscaled.data, truth.data, size[0]);
            fmt::print(
                "{:18}{:8}: bilinear {:.2f}, bicubic {:.2f}, temporal {:.2f} dB; SSIM {:.3f} {:.3f} {:.3f}\n",
                name, moves ? " moving" : "", bilinear, bicubic, temporal, bilinearSsim, bicubicSsim,
                temporalSsim);
            EXPECT_GT(temporal, std::max(bilinear, bicubic)) << name;
            EXPECT_GT(temporalSsim, std::max(bilinearSsim, bicubicSsim)) << name;
        }
}

}  // namespace
}  // namespace helio
