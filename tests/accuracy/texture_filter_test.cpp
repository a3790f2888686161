/** @file Rows X1 to X3 and X5 to X8: texture filters on the device against exact values and the footprint's
 * integral. */
#include "passes/mip/mip_chain.hpp"
#include "passes/scene/device_scene.hpp"
#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/kernel.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

const char* const kKernel = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/texture/filters.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform samplerBuffer uQueries;
layout(set = 0, binding = 1, std430) writeonly buffer uResults { vec4 results[]; };
layout(push_constant, std430) uniform Push { uint count; } push;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= int(push.count)) return;
    vec4 uv = texelFetch(uQueries, 2 * i), d = texelFetch(uQueries, 2 * i + 1);
    results[i] = sampleFiltered(int(uv.z), uv.xy, d.xy, d.zw);
}
)";

struct Query {
    glm::vec2 uv{0.0f}, texture{0.0f}, dx{0.0f}, dy{0.0f};
};

/** A texture of one channel (in all four), its values by texel. */
struct TestTexture {
    std::uint32_t width, height;
    std::function<double(int, int)> value;
    Wrap wrap = Wrap::Repeat;

    double texel(int x, int y) const {
        const auto wrapped = [&](int i, int size) {
            if (wrap == Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
            const int period = wrap == Wrap::MirroredRepeat ? 2 * size : size;
            const int r = ((i % period) + period) % period;
            return r < size ? r : period - 1 - r;
        };
        return value(wrapped(x, int(width)), wrapped(y, int(height)));
    }
    /** Bilinear between texels, at texel coordinates. */
    double bilinear(glm::dvec2 p) const {
        p -= 0.5;
        const double x = std::floor(p.x), y = std::floor(p.y), fx = p.x - x, fy = p.y - y;
        const int i = int(x), j = int(y);
        return (texel(i, j) * (1 - fx) + texel(i + 1, j) * fx) * (1 - fy) +
               (texel(i, j + 1) * (1 - fx) + texel(i + 1, j + 1) * fx) * fy;
    }
};

struct Sampled {
    std::vector<glm::vec4> values;
    double nanoseconds = 0;  ///< per sample, device time
};

Sampled sample(const Scene& scene, TextureFilter filter, const std::vector<Query>& queries) {
    DeviceScene deviceScene(device(), scene, {.tree = false});
    MipChains mips(device(), deviceScene.info().textures, filter == TextureFilter::Ripmap);
    {
        Graph graph(device());
        mips.declare(graph, deviceScene.bindings(graph, {"uTextures", "uTexels8", "uTexelsFloat"}),
                     deviceScene.constants({"HAS_FLOAT_TEXTURES"}));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    static const Kernel kernel = compileKernel("test/filters", kKernel);
    DeviceBuffer input = makeBuffer(device(), "queries", queries);
    Graph graph(device());
    const Buffer results = graph.buffer("results", {queries.size() * 16});
    SpecConstants spec = deviceScene.constants({"HAS_FLOAT_TEXTURES"});
    spec["TEXTURE_FILTER"] = std::int32_t(filter);
    graph.compute("filter", kernel, {.spec = spec})
        .reads(deviceScene.bindings(graph, {"uTextures", "uTexels8", "uTexelsFloat"}))
        .reads(mips.bindings(graph))
        .reads({{"uQueries", graph.import(input), Format::RGBA32F}})
        .overwrites({{"uResults", results}})
        .record([count = std::uint32_t(queries.size())](Commands& c) {
            c.push(count).dispatchInvocations(count);
        });
    const auto read = graph.readback<glm::vec4>(results);
    Plan plan = graph.compile({.executionsInFlight = 1});
    plan.wait(plan.execute());  // compiles
    const Execution done = plan.execute();
    return {read.wait(done), plan.timings(done).at(0).milliseconds * 1e6 / double(queries.size())};
}

Sampled sample(const TestTexture& texture, TextureFilter filter, const std::vector<Query>& queries) {
    Scene scene;
    TextureImage image;
    image.width = texture.width;
    image.height = texture.height;
    std::vector<float> texels;
    for (int y = 0; y < int(texture.height); ++y)
        for (int x = 0; x < int(texture.width); ++x)
            texels.insert(texels.end(), 4, float(texture.value(x, y)));
    image.texels = texels;
    scene.images = {image};
    Texture use;
    use.image = 0;
    use.wrapU = use.wrapV = texture.wrap;
    scene.textures = {use};
    Material material;
    material.emission = glm::vec3(1.0f);  // whose textures may be brighter than 1
    material.emissiveTexture.texture = 0;
    scene.materials = {material};
    Primitive triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.texcoords = {{{0, 0}, {1, 0}, {0, 1}}};
    triangle.indices = {0, 1, 2};
    triangle.material = 0;
    scene.meshes = {{"", {triangle}}};
    Node node;
    node.mesh = 0;
    scene.nodes = {node};
    scene.roots = {0};

    return sample(scene, filter, queries);
}

const TextureFilter kAll[] = {TextureFilter::Nearest, TextureFilter::Bilinear,  TextureFilter::CatmullRom,
                              TextureFilter::BSpline, TextureFilter::Trilinear, TextureFilter::Anisotropic,
                              TextureFilter::Ewa,     TextureFilter::Ripmap};
const char* const kNames[] = {"nearest",   "bilinear",    "bicubic", "bspline",
                              "trilinear", "anisotropic", "ewa",     "ripmap"};

class Uniform {
public:
    explicit Uniform(std::uint32_t seed) : random_(seed) {}
    double operator()(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }

private:
    std::mt19937 random_;
};

/** Footprints of every size, shape and direction. */
std::vector<Query> footprints(std::uint32_t count, double texels, std::uint32_t seed) {
    Uniform uniform(seed);
    std::vector<Query> queries(count);
    for (Query& q : queries) {
        const double a = uniform(0, 2 * kPi), b = uniform(0, 2 * kPi);
        const double l = std::pow(2.0, uniform(-2, 5)) / texels, s = l * std::pow(2.0, uniform(-4, 0));
        q.uv = glm::vec2(uniform(-3, 3), uniform(-3, 3));
        // Derivatives whose ellipse has the axes l at angle a and s across, parametrised from angle b.
        const glm::dvec2 m(std::cos(a), std::sin(a)), n(-m.y, m.x);
        q.dx = glm::vec2(l * std::cos(b) * m + s * std::sin(b) * n);
        q.dy = glm::vec2(-l * std::sin(b) * m + s * std::cos(b) * n);
    }
    return queries;
}

TEST(TextureFilter, ConstantsStayConstant) {
    const std::vector<Query> queries = footprints(2000, 37, 1);
    for (const Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge})
        for (const TextureFilter filter : kAll) {
            double worst = 0;
            for (const glm::vec4& v :
                 sample({37, 21, [](int, int) { return 0.7; }, wrap}, filter, queries).values)
                worst = std::max(worst, std::abs(v.g / 0.7f - 1.0));
            EXPECT_LT(worst, 2e-6) << kNames[int(filter)];
        }
}

TEST(TextureFilter, NearestIsTheFloorInEveryWrapMode) {
    Uniform uniform(2);
    std::vector<Query> queries(20000);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        // Centres and edges of texels on purpose; sizes are powers of two, so that their coordinates are
        // exact.
        const bool exact = i % 3 == 0;
        queries[i].uv = exact
                            ? glm::vec2(std::floor(uniform(-64, 64)) / 32, std::floor(uniform(-64, 64)) / 16)
                            : glm::vec2(uniform(-2, 2), uniform(-2, 2));
    }
    for (const Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
        const TestTexture texture{16, 8, [](int x, int y) { return x + 100.0 * y; }, wrap};
        const std::vector<glm::vec4> got = sample(texture, TextureFilter::Nearest, queries).values;
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const glm::dvec2 p = glm::dvec2(queries[i].uv) * glm::dvec2(16, 8);
            wrong += got[i].r != float(texture.texel(int(std::floor(p.x)), int(std::floor(p.y))));
        }
        EXPECT_EQ(wrong, 0u) << int(wrap);
    }
}

TEST(TextureFilter, WhatEachReproducesExactly) {
    // Away from the borders of a clamped texture, in texel coordinates p - 1/2.
    Uniform uniform(3);
    std::vector<Query> queries(5000);
    for (Query& q : queries) q.uv = glm::vec2(uniform(0.1, 0.9), uniform(0.1, 0.9));
    const auto lines = [](double x, double y) { return 1.3 + 0.011 * x - 0.007 * y; };
    const auto product = [](double x, double y) { return 1.3 + 0.011 * x - 0.007 * y + 0.0002 * x * y; };
    const auto quadratic = [](double x, double y) {
        return 1.2 + 0.01 * x + 0.0003 * x * x - 0.0002 * y * y + 0.0001 * x * y;
    };
    const auto worst = [&](TextureFilter filter, const std::function<double(double, double)>& f) {
        const std::vector<glm::vec4> got =
            sample({64, 64, [&](int x, int y) { return f(x, y); }, Wrap::ClampToEdge}, filter, queries)
                .values;
        double error = 0;
        for (std::size_t i = 0; i < queries.size(); ++i)
            error = std::max(
                error, std::abs(got[i].r - f(queries[i].uv.x * 64.0 - 0.5, queries[i].uv.y * 64.0 - 0.5)));
        return error;
    };
    EXPECT_LT(worst(TextureFilter::Bilinear, product), 3e-6);
    EXPECT_LT(worst(TextureFilter::CatmullRom, quadratic), 3e-6);
    EXPECT_LT(worst(TextureFilter::BSpline, lines), 3e-6);
    EXPECT_GT(worst(TextureFilter::Bilinear, quadratic), 3e-5);
    EXPECT_GT(worst(TextureFilter::BSpline, quadratic), 3e-5) << "the B-spline smooths";
}

TEST(TextureFilter, OrderOfErrorOfTheBicubics) {
    // Of sin(2 pi x / n) sampled by n texels: bilinear and B-spline h^2, Catmull-Rom h^3.
    Uniform uniform(4);
    std::vector<Query> queries(4000);
    for (Query& q : queries) q.uv = glm::vec2(uniform(0, 1), 0.5);
    for (const auto& [filter, order] :
         {std::pair{TextureFilter::CatmullRom, 3.0}, std::pair{TextureFilter::BSpline, 2.0},
          std::pair{TextureFilter::Bilinear, 2.0}}) {
        std::vector<double> errors;
        for (const std::uint32_t n : {16u, 32u, 64u}) {
            const auto f = [&](double p) { return 1 + std::sin(2 * kPi * p / n); };
            const std::vector<glm::vec4> got =
                sample({n, 2, [&](int x, int) { return f(x + 0.5); }}, filter, queries).values;
            double worst = 0;
            for (std::size_t i = 0; i < queries.size(); ++i)
                worst = std::max(worst, std::abs(got[i].r - f(double(queries[i].uv.x) * n)));
            errors.push_back(worst);
        }
        const double slope = 0.5 * std::log2(errors[0] / errors[2]);
        std::printf("             %s: h^%.2f\n", kNames[int(filter)], slope);
        EXPECT_NEAR(slope, order, 0.15) << kNames[int(filter)];
    }
}

TEST(TextureFilter, AnyNumberOfTexturesOfAnySize) {
    // 2,000 textures of as many sizes, one of them 16,384 texels long, without indexed descriptors: every
    // corner texel, and the mean on the last level.
    constexpr int count = 2000;
    Scene scene;
    Primitive triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.texcoords = {{{0, 0}, {1, 0}, {0, 1}}};
    triangle.indices = {0, 1, 2};
    std::mt19937 random(11);
    std::vector<Query> corners, whole;
    std::vector<float> first;
    std::vector<double> means;
    for (int t = 0; t < count; ++t) {
        TextureImage image;
        image.width = t == 1234 ? 16384u : 1u + std::uint32_t(t) % 43;
        image.height = t == 1234 ? 1u : 1u + std::uint32_t(t) / 43;
        std::vector<float> texels;
        double sum = 0;
        for (std::uint32_t i = 0; i < image.width * image.height; ++i) {
            texels.insert(texels.end(), 4, float(random() / 4294967296.0));
            sum += double(texels.back());
        }
        means.push_back(sum / (image.width * image.height));
        first.push_back(texels[texels.size() - 4]);
        image.texels = std::move(texels);
        const glm::vec2 last((image.width - 0.5f) / image.width, (image.height - 0.5f) / image.height);
        corners.push_back({last, glm::vec2(float(t), 0.0f)});
        whole.push_back({last, glm::vec2(float(t), 0.0f), {4.0f, 0.0f}, {0.0f, 4.0f}});
        scene.images.push_back(std::move(image));
        Texture use;
        use.image = t;
        scene.textures.push_back(use);
        Material material;
        material.emission = glm::vec3(1.0f);
        material.emissiveTexture.texture = t;
        scene.materials.push_back(material);
        triangle.material = t;
        scene.meshes.push_back({"", {triangle}});
        Node node;
        node.mesh = t;
        scene.nodes.push_back(node);
        scene.roots.push_back(t);
    }
    const std::vector<glm::vec4> texels = sample(scene, TextureFilter::Nearest, corners).values,
                                 levels = sample(scene, TextureFilter::Trilinear, whole).values;
    int wrong = 0;
    double worst = 0;
    for (std::size_t t = 0; t < count; ++t) {
        wrong += texels[t].r != first[t];
        worst = std::max(worst, std::abs(double(levels[t].r) / means[t] - 1));
    }
    std::printf("             2,000 textures: %d wrong texels, worst mean %.1e\n", wrong, worst);
    EXPECT_EQ(wrong, 0);
    EXPECT_LT(worst, 3e-6);
}

/** Mean of a texture (bilinear between its texels) over the parallelogram of a pixel. */
double integral(const TestTexture& texture, const Query& q) {
    const glm::dvec2 size(texture.width, texture.height);
    constexpr int n = 100;
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            sum += texture.bilinear((glm::dvec2(q.uv) + ((x + 0.5) / n - 0.5) * glm::dvec2(q.dx) +
                                     ((y + 0.5) / n - 0.5) * glm::dvec2(q.dy)) *
                                    size);
    return sum / (n * n);
}

double rms(const std::vector<double>& exact, const std::vector<glm::vec4>& got) {
    double sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double error = got[i].r - exact[i];
        sum += error * error;
    }
    return std::sqrt(sum / double(exact.size()));
}

/** A plane in perspective, pixel by pixel: footprints up to 16 times as long as wide. The camera is rolled by
 * `roll`: at 45 degrees footprints lie along the pixels' diagonals, and so they do in the texture. */
std::vector<Query> tiltedPlane(double roll, double texels) {
    std::vector<Query> queries;
    const glm::dvec2 right(std::cos(roll), std::sin(roll)), away(-right.y, right.x);
    Uniform uniform(6);
    for (int i = 0; i < 600; ++i) {
        // Height 1 above the plane; the ray through image row v below the horizon meets it at distance 1 / v.
        const double v = uniform(0.09, 0.8), u = uniform(-0.5, 0.5), pixel = 1.0 / 60, scale = 24 / texels;
        Query q;
        q.uv = glm::vec2(scale * (u / v * right + 1 / v * away) + glm::dvec2(0.37, 0.11));
        const glm::dvec2 du = scale * pixel / v * right,
                         dv = scale * pixel * (-u / (v * v) * right - 1 / (v * v) * away);
        q.dx = glm::vec2(std::cos(roll) * du + std::sin(roll) * dv);
        q.dy = glm::vec2(-std::sin(roll) * du + std::cos(roll) * dv);
        queries.push_back(q);
    }
    return queries;
}

/** A checkerboard and octaves of noise whose power falls as 1/f^2, as in photographs: 128 texels each way. */
std::array<TestTexture, 2> qualityTextures() {
    std::mt19937 random(9);
    std::vector<double> noise(128 * 128);
    for (double& v : noise) v = random() / 4294967296.0;
    const auto photograph = [noise](int x, int y) {
        double sum = 0;
        for (int k = 0; k < 6; ++k)
            sum += noise[std::size_t((y >> k) % 128 * 128 + (x >> k) % 128)] * std::exp2(k - 6);
        return sum;
    };
    return {TestTexture{128, 128, [](int x, int y) { return double((x / 4 + y / 4) & 1); }},
            TestTexture{128, 128, photograph}};
}

TEST(TextureFilter, RipmapsFilterFootprintsAlongTheAxes) {
    // Rectangles of 1 to 32 texels each way, wide or high: levels of powers of two have the very mean but for
    // where their texels begin.
    Uniform uniform(12);
    std::vector<Query> queries(600);
    for (Query& q : queries) {
        q.uv = glm::vec2(uniform(0, 1), uniform(0, 1));
        q.dx.x = float(std::exp2(uniform(0, 5)) / 128);
        q.dy.y = float(std::exp2(uniform(0, 5)) / 128);
    }
    for (const TestTexture& texture : qualityTextures()) {
        std::vector<double> exact;
        for (const Query& q : queries) exact.push_back(integral(texture, q));
        const double trilinear = rms(exact, sample(texture, TextureFilter::Trilinear, queries).values),
                     ripmap = rms(exact, sample(texture, TextureFilter::Ripmap, queries).values);
        std::printf("             along the axes: ripmap %.4f, trilinear %.4f\n", ripmap, trilinear);
        EXPECT_LT(ripmap, 0.75 * trilinear);
    }
}

TEST(TextureFilter, ErrorAgainstTheFootprintsIntegral) {
    const std::array<TestTexture, 2> textures = qualityTextures();
    std::printf("             | texture | direction | filter | RMS error | ns a sample |\n");
    for (int t = 0; t < 2; ++t)
        for (const bool diagonal : {false, true}) {
            const std::vector<Query> queries = tiltedPlane(diagonal ? kPi / 4 : 0.0, 128);
            std::vector<double> exact;
            for (const Query& q : queries) exact.push_back(integral(textures[t], q));
            double errors[8];
            for (const TextureFilter filter : kAll) {
                const Sampled got = sample(textures[t], filter, queries);
                errors[int(filter)] = rms(exact, got.values);
                std::printf("             | %s | %s | %s | %.4f | %.0f |\n",
                            t == 0 ? "checkerboard" : "photograph-like", diagonal ? "diagonal" : "along",
                            kNames[int(filter)], errors[int(filter)], got.nanoseconds);
            }
            const auto error = [&](TextureFilter f) { return errors[int(f)]; };
            EXPECT_LT(error(TextureFilter::Trilinear), error(TextureFilter::Bilinear));
            EXPECT_LT(error(TextureFilter::Anisotropic), error(TextureFilter::Trilinear));
            if (!diagonal) {
                EXPECT_LT(error(TextureFilter::Ripmap), error(TextureFilter::Trilinear));
            }
            if (diagonal) {
                EXPECT_LT(error(TextureFilter::Ewa), error(TextureFilter::Anisotropic));
            }
        }
}

/** Row X6: what a wave is between levels whose boxes weaken it by the product of their cosines, with no step
 * where one pair of levels ends and the next begins. */
TEST(TextureFilter, TrilinearGoesFromLevelToLevelWithoutAStep) {
    const int size = 256, waves = 11, levels = 9;
    const double f = double(waves) / size;
    const TestTexture texture{std::uint32_t(size), std::uint32_t(size),
                              [&](int x, int) { return 0.5 + 0.5 * std::cos(2 * kPi * f * (x + 0.5)); }};
    const auto levelAt = [&](int level, double x) {
        double amplitude = 0.5;
        for (int k = 0; k < level; ++k) amplitude *= std::cos(kPi * f * std::exp2(k));
        const double width = std::exp2(level), p = x / width - 0.5, i = std::floor(p), s = p - i;
        const auto texel = [&](double at) { return amplitude * std::cos(2 * kPi * f * (at + 0.5) * width); };
        return 0.5 + texel(i) * (1 - s) + texel(i + 1) * s;
    };
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<Query> queries;
    std::vector<double> exact;
    const auto ask = [&](float u, double level) {
        Query q;
        q.uv = {u, 0.3f};
        q.dx = {float(std::exp2(level) / size), 0.0f};
        queries.push_back(q);
        const double real = std::clamp(std::log2(double(q.dx.x) * size), 0.0, double(levels - 1));
        const int fine = std::min(int(real), levels - 2);
        const double x = double(u) * size, t = real - fine;
        exact.push_back(levelAt(fine, x) * (1 - t) + levelAt(fine + 1, x) * t);
    };
    // Pairs 4e-6 of a level apart, across every level where one could step.
    constexpr int pairs = 512;
    for (int i = 0; i < pairs; ++i) {
        const float u = uniform(random);
        for (const double side : {-2e-6, 2e-6}) ask(u, i % levels + side);
    }
    for (int i = 0; i < 2048; ++i) ask(uniform(random), uniform(random) * 9.5 - 0.5);
    const std::vector<glm::vec4> got = sample(texture, TextureFilter::Trilinear, queries).values;
    double step = 0, off = 0;
    for (int i = 0; i < pairs; ++i)
        step = std::max(step,
                        std::abs(double(got[2 * std::size_t(i)].r) - double(got[2 * std::size_t(i) + 1].r)));
    for (std::size_t i = 0; i < queries.size(); ++i)
        off = std::max(off, std::abs(double(got[i].r) - exact[i]));
    std::printf("             trilinear: largest step between levels %.1e, off the boxes' product %.1e\n",
                step, off);
    EXPECT_LT(step, 1e-5);
    EXPECT_LT(off, 1e-5);
}

TEST(TextureFilter, EwaFollowsTheGaussiansLaw) {
    // A wave of f periods a texel is weakened to exp(-2 pi^2 f^T S f), S = J J^T/12 + 1/6 of a texel squared.
    const int size = 256;
    double worst = 0;
    for (const int waves : {1, 2, 4, 6})
        for (const double ratio : {1.0, 2.0, 5.0})
            for (const double angle : {0.0, 0.5, kPi / 4, 1.3}) {
                const TestTexture texture{std::uint32_t(size), std::uint32_t(size), [&](int x, int) {
                                              return 1 + std::cos(2 * kPi * waves * (x + 0.5) / size);
                                          }};
                const double l = 40.0 / size, s = l / ratio;
                Query q;
                q.uv = glm::vec2(0.0f, 0.3f);  // a crest
                q.dx = glm::vec2(l * std::cos(angle), l * std::sin(angle));
                q.dy = glm::vec2(-s * std::sin(angle), s * std::cos(angle));
                const double along =
                    ((double(q.dx.x) * q.dx.x + double(q.dy.x) * q.dy.x) / 12 + 1.0 / (6.0 * size * size)) *
                    waves * waves;
                const double expected = std::exp(-2 * kPi * kPi * along);
                const double got = sample(texture, TextureFilter::Ewa, {q}).values[0].r - 1.0;
                worst = std::max(worst, std::abs(got / expected - 1.0));
            }
    std::printf("             worst deviation %.2f %%\n", 100 * worst);
    EXPECT_LT(worst, 0.01);
}

}  // namespace
}  // namespace helio::test
