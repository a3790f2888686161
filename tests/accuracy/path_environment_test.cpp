// Light from latitude-longitude images: what is seen, how directions are drawn, irradiance in closed form.
#include "passes/scene/packed_scene.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>
#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/** The image of a sky given as a function of the direction, sampled at texel centres. */
TextureImage sky(std::uint32_t width, std::uint32_t height,
                 const std::function<glm::vec3(const glm::dvec3&)>& radiance) {
    TextureImage image{"sky", width, height, std::vector<float>()};
    auto& texels = std::get<std::vector<float>>(image.texels);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double turn = 2 * kPi * (0.5 - (x + 0.5) / width), angle = kPi * (y + 0.5) / height;
            const glm::vec3 value = radiance(
                {std::sin(angle) * std::sin(turn), std::cos(angle), std::sin(angle) * std::cos(turn)});
            for (float v : {value.x, value.y, value.z, 1.0f}) texels.push_back(v);
        }
    return image;
}

/** Bilinear lookup, in double, from the convention alone. */
glm::dvec3 lookUp(const TextureImage& image, const glm::dvec3& d) {
    const auto& texels = std::get<std::vector<float>>(image.texels);
    const auto texel = [&](int x, int y) {
        const int w = int(image.width), h = int(image.height);
        const std::size_t i =
            (std::size_t(std::clamp(y, 0, h - 1)) * image.width + std::size_t((x + w) % w)) * 4;
        return glm::dvec3(texels[i], texels[i + 1], texels[i + 2]);
    };
    const double u = (0.5 - std::atan2(d.x, d.z) / (2 * kPi)) * image.width - 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi * image.height - 0.5;
    const double x = std::floor(u), y = std::floor(v);
    const glm::dvec3 upper = glm::mix(texel(int(x), int(y)), texel(int(x) + 1, int(y)), u - x);
    const glm::dvec3 lower = glm::mix(texel(int(x), int(y) + 1), texel(int(x) + 1, int(y) + 1), u - x);
    return glm::mix(upper, lower, v - y);
}

/** Integral over directions of f(direction, radiance), midpoint rule: `fine` points a texel and axis. */
double integrate(const TextureImage& image, int fine,
                 const std::function<double(const glm::dvec3&, double)>& f) {
    double sum = 0;
    const int rows = int(image.height) * fine, columns = int(image.width) * fine;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const double turn = 2 * kPi * (x + 0.5) / columns, angle = kPi * (y + 0.5) / rows;
            const glm::dvec3 d(std::sin(angle) * std::sin(turn), std::cos(angle),
                               std::sin(angle) * std::cos(turn));
            sum += f(d, lookUp(image, d).x) * std::sin(angle);
        }
    return sum * 2 * kPi / columns * kPi / rows;
}

/** A small white square that faces `normal`, under the image; what it shows is irradiance over pi. */
SceneBuilder receiver(const glm::vec3& normal, TextureImage image, const glm::quat& rotation = {1, 0, 0, 0}) {
    SceneBuilder b;
    const glm::vec3 n = glm::normalize(normal);
    const glm::vec3 t =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 s = glm::cross(n, t);
    b.quad(-t - s, t - s, t + s, -t + s, b.material(glm::vec3(1.0f)));
    b.camera(3.0f * n + 0.5f * t, {0, 0, 0}, 0.05f, s);
    b.scene.images.push_back(std::move(image));
    b.scene.environment = Environment{glm::vec3(1.0f), 0, rotation};
    return b;
}

PathTraceOptions options(std::uint32_t size) {
    PathTraceOptions o;
    o.size = {size, size};
    o.sampler = SamplerKind::Independent;
    return o;
}

void expectMean(const Traced& image, double truth, double tolerance, const std::string& what) {
    const Estimate e = estimate(image, 0, [](std::size_t) { return true; });
    const double z = (e.mean - truth) / e.error;
    fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", what, e.mean, e.error, truth, z);
    EXPECT_LT(std::abs(z), 4.0) << what;
    EXPECT_LT(e.error, tolerance * truth) << what;
    EXPECT_EQ(image.rejected, 0u);
}

/** cos^n about +Y: irradiance 2 pi / (n + 2) on a surface that faces the lobe. */
TextureImage lobe(std::uint32_t width, int n) {
    return sky(width, width / 2,
               [n](const glm::dvec3& d) { return glm::vec3(float(std::pow(std::max(d.y, 0.0), n))); });
}

TEST(PathEnvironment, IrradianceOfCosineLobes) {
    for (int n : {1, 4, 16})
        for (const std::string how : {"sampled", "sampled four times", "met by chance", "sampled alone",
                                      "sampled four times alone"}) {
            PathTraceOptions o = options(16);
            if (how.find("four times") != std::string::npos) o.lightSamples = 4;
            o.nextEventEstimation = how != "met by chance";
            o.whitted = how.ends_with("alone");
            const double truth = 2.0 / (n + 2);
            const Traced image =
                trace(receiver({0, 1, 0}, lobe(1024, n)).scene, o, o.nextEventEstimation ? 256 : 1024);
            expectMean(image, truth, 0.004, fmt::format("cos^{} {}", n, how));
        }
}

/** The same lobe turned to where the surface faces: nothing but the turned density can tell. */
TEST(PathEnvironment, RotationDoesNotMatter) {
    for (const glm::vec3& axis :
         {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(-0.3f, 0.2f, 0.7f), glm::vec3(0, -1, 0)}) {
        const glm::vec3 n = glm::normalize(axis);
        const glm::quat turn = n.y < -0.9f ? glm::quat(0, 1, 0, 0) : glm::quat(glm::vec3(0, 1, 0), n);
        const Traced image = trace(receiver(n, lobe(512, 4), turn).scene, options(16), 128);
        expectMean(image, 2.0 / 6.0, 0.005, fmt::format("towards ({:.2f}, {:.2f}, {:.2f})", n.x, n.y, n.z));
    }
}

/** One bright texel in a dim sky, high up, on the horizon, beside the seam and at a pole. */
TEST(PathEnvironment, SunOfOneTexel) {
    struct Case {
        std::uint32_t x, y;
    };
    for (const Case& c : {Case{40, 13}, Case{90, 30}, Case{127, 20}, Case{5, 0}}) {
        TextureImage image = sky(128, 64, [](const glm::dvec3&) { return glm::vec3(0.25f); });
        auto& texels = std::get<std::vector<float>>(image.texels);
        for (std::size_t k = 0; k < 3; ++k) texels[(std::size_t(c.y) * 128 + c.x) * 4 + k] = 1e6f;
        const glm::dvec3 up = glm::normalize(glm::dvec3(0.1, 1.0, 0.3));
        const double truth =
            integrate(image, 64,
                      [&](const glm::dvec3& d, double l) { return l * std::max(0.0, glm::dot(d, up)); }) /
            kPi;
        const Traced traced = trace(receiver(glm::vec3(up), image).scene, options(16), 1024);
        expectMean(traced, truth, 0.01, fmt::format("sun at texel ({}, {})", c.x, c.y));
    }
}

/** A constant image is the constant environment: to the last bit where light is only met, and a furnace by
 * any estimator. */
TEST(PathEnvironment, ConstantImageIsAConstantEnvironment) {
    SceneBuilder b;
    b.sphere({0, 0, 0}, 1.0f, 3, false, b.material(glm::vec3(0.5f, 0.7f, 0.2f)));
    b.sphere({1.5f, 0.5f, 0}, 0.7f, 3, false, b.material(glm::vec3(0.9f)));
    b.camera({0, 0, 4}, {0, 0, 0}, 0.9f);
    b.scene.environment = Environment{glm::vec3(0.3f, 0.2f, 0.7f), -1};
    PathTraceOptions o = options(48);
    o.nextEventEstimation = false;
    const Traced plain = trace(b.scene, o, 16);
    b.scene.images.push_back(sky(31, 17, [](const glm::dvec3&) { return glm::vec3(1.0f); }));
    b.scene.environment->image = 0;
    const Traced image = trace(b.scene, o, 16);
    EXPECT_EQ(image.mean, plain.mean);
    o.nextEventEstimation = true;
    const Traced sampled = trace(b.scene, o, 256), longer = trace(
                                                       b.scene,
                                                       [&] {
                                                           PathTraceOptions other = o;
                                                           other.seed = 9;
                                                           other.nextEventEstimation = false;
                                                           return other;
                                                       }(),
                                                       256);
    const auto all = [](std::size_t) { return true; };
    for (int c = 0; c < 3; ++c) {
        const Estimate a = estimate(sampled, c, all), e = estimate(longer, c, all);
        EXPECT_LT(std::abs(a.mean - e.mean) / std::hypot(a.error, e.error), 4.0) << c;
        EXPECT_LT(a.error, 2e-3 * a.mean);
    }
}

/** A kernel that draws directions, and looks each up again. */
struct Drawn {
    std::vector<glm::vec4> direction;  ///< w: density as drawn
    std::vector<glm::vec4> found;      ///< radiance and density as looked up
};
Drawn draw(const TextureImage& image, const glm::quat& rotation, bool rays, std::uint32_t count) {
    SceneBuilder b = receiver({0, 1, 0}, image, rotation);
    DeviceScene scene(device(), b.scene, {.raysFindEnvironment = rays});
    const Kernel kernel = compileKernel("draw", R"(#version 460
#extension GL_GOOGLE_include_directive : require
#define ENVIRONMENT_IMAGE 1
#include "shaders/scene/environment.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer uDirection { vec4 drawn[]; };
layout(set = 0, binding = 1, std430) writeonly buffer uFound { vec4 found[]; };
void main() {
    const uint i = gl_GlobalInvocationID.x;
    vec3 direction;
    const EnvironmentRadiance from = sampleEnvironment(uvec2(hashUint(i * 2u), hashUint(i * 2u + 0x85ebca6bu)), direction);
    const EnvironmentRadiance at = environmentAt(direction);
    drawn[i] = vec4(direction, from.density);
    found[i] = vec4(at.radiance, at.density);
})");
    Graph graph(device());
    const Buffer drawn = graph.buffer("drawn", {std::uint64_t(count) * 16}),
                 found = graph.buffer("found", {std::uint64_t(count) * 16});
    graph.compute("draw", kernel, {.spec = scene.environmentConstants()})
        .reads(scene.bindings(graph, {"uEnvironmentMap"}))
        .overwrites({{"uDirection", drawn}, {"uFound", found}})
        .record([count](Commands& c) { c.dispatchInvocations(count); });
    const auto readDrawn = graph.readback<glm::vec4>(drawn);
    const auto readFound = graph.readback<glm::vec4>(found);
    Plan plan = graph.compile();
    const Execution execution = plan.execute();
    return {readDrawn.wait(execution), readFound.wait(execution)};
}

/** What is above `dim` of an image. */
TextureImage above(const TextureImage& image, double dim) {
    TextureImage result = image;
    for (float& value : std::get<std::vector<float>>(result.texels))
        value = float(std::max(value - dim, 0.0));
    return result;
}

TEST(PathEnvironment, DirectionsFollowTheDensity) {
    // Uneven, dark in places, with a bright spot near a pole and one on the seam.
    const TextureImage image = sky(40, 21, [](const glm::dvec3& d) {
        const double spot = std::exp(40 * (glm::dot(d, glm::normalize(glm::dvec3(0.1, 1, 0.05))) - 1)) * 30;
        const double seam = std::exp(90 * (glm::dot(d, glm::normalize(glm::dvec3(0.02, -0.2, -1))) - 1)) * 20;
        return glm::vec3(float(d.x > 0.3 && d.y < 0 ? 0.0 : 0.2 + 0.1 * d.z + spot + seam));
    });
    constexpr std::uint32_t count = 1 << 20;
    constexpr int rows = 24, columns = 48, fine = 40;
    const double mean = integrate(image, 96, [](const glm::dvec3&, double l) { return l; }) / (4 * kPi);
    struct Case {
        glm::quat turn;
        bool rays;  ///< they find the image's dim part
    };
    for (const Case& c :
         {Case{{1, 0, 0, 0}, false}, Case{glm::normalize(glm::quat(0.3f, 0.5f, -0.4f, 0.7f)), false},
          Case{{1, 0, 0, 0}, true}}) {
        const TextureImage followed = above(image, c.rays ? 0.75 * mean : 0.0);
        const double total = integrate(followed, 96, [](const glm::dvec3&, double l) { return l; });
        const Drawn drawn = draw(image, c.turn, c.rays, count);
        // Chances of the cells of a grid that no texel boundary follows. The density is bilinear in the
        // cosine where the radiance is in the angle; at this size they differ by less than the test resolves
        // but in the rows at the poles, so the density's own integral is taken, by the densities that the
        // device looks up.
        std::vector<double> counted(rows * columns), expected(rows * columns);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 d = glm::inverse(glm::dquat(c.turn)) * glm::dvec3(drawn.direction[i]);
            ASSERT_NEAR(glm::length(d), 1.0, 1e-6);
            const int row = std::min(rows - 1, int((1 - d.y) / 2 * rows));
            const int column = std::min(columns - 1, int((std::atan2(d.x, d.z) / (2 * kPi) + 0.5) * columns));
            counted[std::size_t(row * columns + column)] += 1;
            if (d.x * d.x + d.z * d.z < 1e-6) continue;  // the longitude of the pole is anything
            // What was drawn is what is found there.
            ASSERT_NEAR(drawn.found[i].w / drawn.direction[i].w, 1.0, 2e-3) << i;
            const double radiance = lookUp(image, d).x;
            ASSERT_NEAR(drawn.found[i].x, radiance, 2e-5 * 30) << i;
        }
        // Expected counts by the bilinear density, in double: fine midpoint rule over each cell.
        const auto& texels = std::get<std::vector<float>>(followed.texels);
        const int w = int(image.width), h = int(image.height);
        const auto texel = [&](int x, int y) {
            return double(texels[(std::size_t(std::clamp(y, 0, h - 1) * w + (x + w) % w)) * 4]);
        };
        double normal = 0;
        for (int row = 0; row < rows * fine; ++row) {
            const double cosine = 1 - 2 * (row + 0.5) / (rows * fine), v = std::acos(cosine) / kPi * h + 0.5;
            const int y = int(v);
            const double upper = std::cos(kPi * std::max(0.0, y - 0.5) / h),
                         lower = std::cos(kPi * std::min(double(h), y + 0.5) / h);
            const double t = (upper - cosine) / (upper - lower);
            for (int column = 0; column < columns * fine; ++column) {
                const double turnAt = (column + 0.5) / (columns * fine) - 0.5;
                const double u = (0.5 - turnAt) * w - 0.5;
                const int x = int(std::floor(u));
                const double s = u - x;
                const double density = (texel(x, y - 1) * (1 - s) + texel(x + 1, y - 1) * s) * (1 - t) +
                                       (texel(x, y) * (1 - s) + texel(x + 1, y) * s) * t;
                expected[std::size_t(row / fine * columns + column / fine)] += density;
                normal += density;
            }
        }
        // A cell whose corner alone has light may fall between the rule's points.
        for (double& e : expected) e = e * count / normal + 1e-3;
        const verify::ChiSquaredResult result = verify::chiSquaredTest(counted, expected);
        fmt::print("chi-squared {:.1f} at {} degrees: p = {:.3f}\n", result.statistic, result.degrees,
                   result.pValue);
        EXPECT_GT(result.pValue, 1e-3);
        // The density's scale: its mean over uniform directions is 1 / 4 pi, of L / density over those drawn
        // the total.
        verify::RunningStatistics power;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 d = glm::inverse(glm::dquat(c.turn)) * glm::dvec3(drawn.direction[i]);
            power.add((c.rays ? lookUp(followed, d).x : double(drawn.found[i].x)) / drawn.direction[i].w);
        }
        const verify::ZResult z = verify::zTest(power, total);
        fmt::print("power {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", z.mean, z.standardError, total, z.z);
        EXPECT_LT(std::abs(z.z), 4.0);
    }
}

/** Both pipelines show the image behind the scene as the convention says. */
TEST(PathEnvironment, BackgroundOfBothPipelines) {
    Scene scene;
    scene.name = "sky";
    scene.cameras.emplace_back().yfov = 1.5f;
    Node eye;
    eye.camera = 0;
    eye.rotation = glm::normalize(glm::quat(0.8f, 0.3f, -0.4f, 0.2f));
    scene.nodes.push_back(eye);
    scene.roots = {0};
    scene.images.push_back(sky(64, 32, [](const glm::dvec3& d) {
        return glm::vec3(float(1 + d.x), float(1 + d.y * d.z), float(std::exp(d.y)));
    }));
    RenderOptions o;
    o.size = {33, 17};
    o.environment =
        Environment{glm::vec3(1.0f, 2.0f, 0.5f), 0, glm::normalize(glm::quat(0.5f, 0.1f, 0.7f, 0.0f))};
    Renderer renderer({.validation = true});
    o.pipeline = Pipeline::Raster;
    const RenderResult raster = renderer.render(scene, o);
    o.pipeline = Pipeline::Path;
    o.samples = 64;
    const RenderResult path = renderer.render(scene, o);
    EXPECT_TRUE(renderer.device().validationMessages().empty());
    double worst = 0, mean = 0;
    for (std::uint32_t y = 0; y < 17; ++y)
        for (std::uint32_t x = 0; x < 33; ++x) {
            const double half = std::tan(0.75);
            const glm::dvec3 local = glm::normalize(
                glm::dvec3((2 * (x + 0.5) / 33 - 1) * half * 33 / 17, (1 - 2 * (y + 0.5) / 17) * half, -1));
            const glm::dvec3 world = glm::dquat(eye.rotation) * local;
            const glm::dvec3 truth =
                glm::dvec3(o.environment->radiance) *
                lookUp(scene.images[0], glm::inverse(glm::dquat(o.environment->rotation)) * world);
            for (std::size_t c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(raster.image.at(x, y, c) - truth[glm::length_t(c)]));
                EXPECT_NEAR(path.image.at(x, y, c), truth[glm::length_t(c)], 0.1) << x << ' ' << y;
                mean += path.image.at(x, y, c) - truth[glm::length_t(c)];
            }
        }
    fmt::print("raster's background differs by at most {:.2g}\n", worst);
    EXPECT_LT(worst, 2e-5);
    EXPECT_LT(std::abs(mean) / (33 * 17 * 3), 1e-3);  // centres against means over pixels
}

TEST(PathEnvironment, NoImageNoBufferNoCode) {
    SceneBuilder b = receiver({0, 1, 0}, lobe(8, 1));
    EXPECT_TRUE(DeviceScene(device(), b.scene, {}).hasEnvironmentImage());
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    DeviceScene constant(device(), b.scene, {});
    EXPECT_FALSE(constant.hasEnvironmentImage());
    EXPECT_TRUE(constant.environmentConstants().empty());
    EXPECT_EQ(constant.info().environmentMap.size(), 0u);
    EXPECT_EQ(constant.info().lightCount, 0u);
}

/** Values that are no radiance are replaced, said so, and reach no pixel. */
TEST(PathEnvironment, BadTexelsAreCleaned) {
    TextureImage image = sky(16, 8, [](const glm::dvec3& d) { return glm::vec3(float(1.5 + d.y)); });
    auto& texels = std::get<std::vector<float>>(image.texels);
    texels[0] = std::nanf("");
    texels[21] = -3;
    texels[42] = std::numeric_limits<float>::infinity();
    SceneBuilder b = receiver({0, 1, 0}, image);
    const PackedScene packed = packScene(b.scene);
    ASSERT_EQ(packed.warnings.size(), 1u);
    EXPECT_NE(packed.warnings[0].find("no radiance (1 not a number, 1 negative, 1 infinite)"),
              std::string::npos)
        << packed.warnings[0];
    EXPECT_EQ(trace(b.scene, options(8), 64).rejected, 0u);
    // A black image gives no light and is no light.
    b.scene.images[0] = sky(4, 2, [](const glm::dvec3&) { return glm::vec3(0.0f); });
    EXPECT_EQ(packScene(b.scene).lightCount, 0u);
    EXPECT_FALSE(DeviceScene(device(), b.scene, {}).hasEnvironmentImage());
    // One texel is a constant.
    b.scene.images[0] = sky(1, 1, [](const glm::dvec3&) { return glm::vec3(2.0f); });
    expectMean(trace(b.scene, options(8), 64), 2.0, 0.02, "one texel");
}

TEST(PathEnvironment, FilesWithNanAndInfinity) {
    const std::filesystem::path folder = std::filesystem::path(HELIOGRAPH_SHARED_DIR) / "assets";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "left out: there is no " << folder;
    Scene scene = load("sample:cornell");
    scene.images.push_back(loadTextureImage(folder / "openexr" / "BrightRingsNanInf.exr"));
    scene.images.push_back(loadTextureImage(folder / "hdri" / "studio.exr"));
    RenderOptions o;
    o.size = {32, 32};
    o.samples = 16;
    for (int image : {0, 1}) {
        o.environment = Environment{glm::vec3(1.0f), image};
        Renderer renderer;
        const RenderResult result = renderer.render(scene, o);
        EXPECT_EQ(result.nanCount, 0u);
        for (const std::string& warning : result.warnings) fmt::print("{}\n", warning);
        EXPECT_FALSE(result.warnings.empty());  // both hold values that are no radiance
        double sum = 0;
        for (float v : result.image.data) {
            ASSERT_TRUE(std::isfinite(v));
            sum += v;
        }
        EXPECT_GT(sum, 0);
    }
}

}  // namespace
}  // namespace helio::test
