// Spheres, planes, discs, quads and tori in pictures: their light by closed forms, and that nothing depends
// on what finds them. shape_meetings_test.cpp has their distances.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/** Adds a shape at a node of its own. */
Node& add(SceneBuilder& b, const Shape& shape, const glm::vec3& at, int material) {
    Primitive primitive;
    primitive.shape = shape;
    primitive.material = material;
    Node node;
    node.mesh = int(b.scene.meshes.size());
    node.translation = at;
    b.scene.meshes.push_back({"shape", {primitive}});
    b.scene.roots.push_back(int(b.scene.nodes.size()));
    return b.scene.nodes.emplace_back(node);
}
Shape sphere(float radius) {
    return {.kind = Shape::Kind::Sphere, .radius = radius};
}
Shape disc(float radius) {
    return {.kind = Shape::Kind::Disc, .radius = radius};
}
Shape quad(float width, float height) {
    return {.kind = Shape::Kind::Quad, .width = width, .height = height};
}
/** Turns a flat shape's front from +Z to -Z. */
const glm::quat kTurned(0, 1, 0, 0);

void expectMean(const Traced& image, double truth, const std::string& what, double tolerance = 0.002) {
    const Estimate e = estimate(image, 0, [](std::size_t) { return true; });
    const double z = e.error > 0 ? (e.mean - truth) / e.error : 0.0;
    fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", what, e.mean, e.error, truth, z);
    EXPECT_LT(std::abs(z), 4.0) << what;
    EXPECT_LT(e.error, tolerance * truth) << what;
    if (e.error == 0) {
        EXPECT_NEAR(e.mean, truth, 2e-6 * truth) << what;
    }
}

/** Looks at a small white patch at the origin that faces +z; what it shows is irradiance over pi. */
void addReceiver(SceneBuilder& b, const glm::vec3& eye) {
    constexpr float half = 1e-3f;
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.camera(eye, {0, 0, 0}, 2e-5f, {0, 0, 1});
}

TEST(PathShapes, IrradianceUnderEachKind) {
    const auto lit = [](const Shape& shape, const glm::vec3& at, const glm::quat& turn, double truth,
                        const char* what) {
        SceneBuilder b;
        addReceiver(b, {-3, 0.5f, 0.4f});
        add(b, shape, at, b.material(glm::vec3(0.0f), glm::vec3(1.0f))).rotation = turn;
        expectMean(trace(b.scene, independentOptions(16, 1), 1024), truth / kPi, what, 0.005);
        PathTraceOptions blind = independentOptions(16, 1);
        blind.nextEventEstimation = false;
        expectMean(trace(b.scene, blind, 1024), truth / kPi, fmt::format("{}, found by rays", what), 0.03);
    };
    const glm::quat none(1, 0, 0, 0);
    lit(quad(1, 1), {0, 0, 1}, kTurned, 0.752274688454, "quad");
    lit(disc(1), {0, 0, 2}, kTurned, 0.628318530718, "disc");
    lit(sphere(1), {0, 0, 3}, none, 0.349065850, "sphere");
    lit(sphere(1), {float(3 * std::sin(kPi / 3)), 0, 1.5f}, none, 0.174532925, "sphere at 60 degrees");
    lit(sphere(1), {2, 0, 0}, none, 0.090586073706, "sphere on the horizon");
}

/** Several lights: by power, and by tables, which give spheres and discs a place. */
TEST(PathShapes, LightsOfEveryChoiceAddUp) {
    for (const LightChoice choice : {LightChoice::Power, LightChoice::Uniform, LightChoice::Adaptive}) {
        SceneBuilder b;
        addReceiver(b, {-3, 0.5f, 0.4f});
        const int one = b.material(glm::vec3(0.0f), glm::vec3(1.0f)),
                  two = b.material(glm::vec3(0.0f), glm::vec3(2.0f), true);
        add(b, sphere(1), {0, 0, 3}, one);
        add(b, sphere(1), {2, 0, 0}, two);
        add(b, disc(0.5f), {-1, 0, 1}, one).rotation = kTurned;
        add(b, quad(0.5f, 0.25f), {0, -1.5f, 0.75f}, two).rotation = glm::quat(0.6f, 0.8f, 0, 0);
        PathTraceOptions o = independentOptions(16, 1);
        o.lights = choice;
        const Estimate e = estimate(trace(b.scene, o, 1024), 0, [](std::size_t) { return true; });
        PathTraceOptions blind = independentOptions(16, 1);
        blind.nextEventEstimation = false;
        const Estimate truth =
            estimate(trace(b.scene, blind, 2048, 512), 0, [](std::size_t) { return true; });
        const double z = (e.mean - truth.mean) / std::hypot(e.error, truth.error);
        fmt::print("choice {}: {:.5f} +- {:.5f}, by rays alone {:.5f} +- {:.5f}, z {:+.2f}\n", int(choice),
                   e.mean, e.error, truth.mean, truth.error, z);
        EXPECT_LT(std::abs(z), 4.0);
        EXPECT_LT(e.error, 0.01 * e.mean);
    }
}

TEST(PathShapes, InsideASphereThatEmitsAndReflectsHalf) {
    for (const double placed : {0.0, 1e3}) {
        SceneBuilder b;
        add(b, sphere(1), {float(placed), 0, 0}, b.material(glm::vec3(0.5f), glm::vec3(0.5f), true));
        b.camera({float(placed) + 0.25f, 0.25f, 0.25f}, {float(placed), -1, 0.5f}, 1.2f);
        expectMean(trace(b.scene, independentOptions(16), 4096), 1.0, fmt::format("sphere at {}", placed),
                   0.001);
    }
}

Material glass() {
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.thickness = 1;
    m.ior = 1.5f;
    return m;
}

/** Nothing is lost or gained in glass: the surroundings' 1 is seen everywhere, be they constant or an image.
 */
TEST(PathShapes, GlassInAWhiteFurnace) {
    SceneBuilder b;
    b.scene.materials.push_back(glass());
    add(b, sphere(1), {0, 0, 0}, int(b.scene.materials.size()) - 1);
    add(b, {.kind = Shape::Kind::Torus, .radius = 1.5f, .tubeRadius = 0.3f}, {0, 0, 0},
        int(b.scene.materials.size()) - 1);
    b.whiteImageAround();
    b.camera({0, 0.5f, 4}, {0, 0, 0}, 0.8f);
    for (const glm::dvec3& value : trace(b.scene, independentOptions(16), 64).mean)
        EXPECT_NEAR(value.y, 1.0, 1e-5);
}

/** What light sampling does not find shines as rays find it, though other surfaces of its material are
 * sampled. */
TEST(PathShapes, WhatIsFoundByRaysAloneShinesInFull) {
    SceneBuilder b;
    addReceiver(b, {-3, 0.5f, 0.4f});
    const int one = b.material(glm::vec3(0.0f), glm::vec3(1.0f), true);
    add(b, quad(1, 1), {0, 0, 0.5f}, one).rotation = kTurned;
    add(b, {.kind = Shape::Kind::Plane}, {0, 0, 2}, one).rotation = kTurned;
    add(b, {.kind = Shape::Kind::Torus, .radius = 0.8f, .tubeRadius = 0.1f}, {0, 0, 0.8f}, one);
    expectMean(trace(b.scene, independentOptions(16, 1), 1024), 1.0, "under a quad, a torus and a plane",
               0.005);
}

/** A torus that emits and reflects half is not closed to itself; all it sees of itself and of surroundings of
 * 1 is 1. */
TEST(PathShapes, TorusInAFurnaceOfItsOwnLight) {
    SceneBuilder b;
    const int half = b.material(glm::vec3(0.5f), glm::vec3(0.5f), true);
    add(b, {.kind = Shape::Kind::Torus, .radius = 1, .tubeRadius = 0.45f}, {0, 0, 0}, half).rotation =
        glm::quat(0.8f, 0.6f, 0, 0);
    b.scene.environment = Environment{glm::vec3(1.0f)};
    b.camera({0, 0.5f, 4}, {0, 0, 0}, 0.8f);
    expectMean(trace(b.scene, independentOptions(16), 1024), 1.0, "torus", 0.001);
}

/** A ray along the axis of a ball lens of diameter 2 at the height h crosses a plane behind it at h (1 - d /
 * f): a ramp of emission there tells where. */
TEST(PathShapes, ABallLensHasItsFocalLength) {
    constexpr float h = 0.004f, d = 1.25f, side = 0.02f;
    SceneBuilder b;
    b.scene.materials.push_back(glass());
    add(b, sphere(1), {0, 0, 0}, int(b.scene.materials.size()) - 1);
    TextureImage ramp;
    ramp.width = 1;
    ramp.height = 2;
    ramp.texels =
        std::vector<float>{1, 1, 0, 1, 0, 1, 0, 1};  // red from 0 at the lower texel to 1 at the upper
    b.scene.images.push_back(ramp);
    Texture texture;
    texture.image = 0;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    b.scene.textures.push_back(texture);
    const int emitter = b.material(glm::vec3(0.0f), glm::vec3(1.0f), true);
    b.scene.materials[std::size_t(emitter)].emissiveTexture.texture = 0;
    add(b, quad(side, side), {0, 0, -d}, emitter);
    b.camera({0, h, 3}, {0, h, 0}, 1);
    b.scene.cameras[0].perspective = false;
    b.scene.cameras[0].ymag = 1e-6f;
    const Traced image = trace(b.scene, independentOptions(8, 2), 64);
    const Estimate red = estimate(image, 0, [](std::size_t) { return true; }),
                   green = estimate(image, 1, [](std::size_t) { return true; });
    // v = 1/4 at the upper texel's middle, and 3/4 at the lower's.
    const double y = (red.mean / green.mean - 0.5) * 0.5 * double(side);
    const double focal = double(d) / (1 - y / double(h)), truth = 1.5 * 2 / (4 * 0.5);
    fmt::print("focal length {:.6f}, n D / (4 (n - 1)) = {:.6f}\n", focal, truth);
    EXPECT_GT(green.mean, 0.8);
    EXPECT_NEAR(focal, truth, 1e-4 * truth);
}

/** What a camera sees of each kind: depth, normal and texture coordinates by their formulas. */
TEST(PathShapes, FirstHitsFollowTheFormulas) {
    SceneBuilder b;
    TextureImage ramp;
    ramp.width = ramp.height = 2;  // red along u, green along v
    ramp.texels = std::vector<float>{0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1};
    b.scene.images.push_back(ramp);
    Texture texture;
    texture.image = 0;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    b.scene.textures.push_back(texture);
    const int material = b.material(glm::vec3(1.0f));
    b.scene.materials[std::size_t(material)].baseColorTexture.texture = 0;
    add(b, sphere(0.75f), {-1, 1, 0}, material);
    add(b, disc(0.75f), {1, 1, 0}, material);
    add(b, quad(1.5f, 1), {1, -1, 0}, material).scale = {-1, 1, 1};  // a mirror image
    add(b, sphere(0.5f), {-1, -1, 0}, material).scale = {-1.5f, 1.5f, 1.5f};
    add(b, {.kind = Shape::Kind::Plane}, {0, 0, -1}, material);
    b.camera({0, 0, 8}, {0, 0, 0}, 1);
    b.scene.cameras[0].perspective = false;
    b.scene.cameras[0].ymag = 2;
    const std::uint32_t size = 64;
    const Traced image = trace(b.scene, independentOptions(size), 1);
    std::array<std::size_t, 5> seen{};
    const auto ramped = [](double x) { return std::clamp(2 * (x - 0.25), 0.0, 1.0); };
    for (std::uint32_t i = 0; i < size * size; ++i) {
        const glm::dvec2 p(4.0 * (i % size + 0.5) / size - 2, 2 - 4.0 * (double(i / size) + 0.5) / size);
        const glm::dvec2 q(p.x - (p.x < 0 ? -1 : 1), p.y - (p.y < 0 ? -1 : 1));
        int expected = 4;
        double depth = 9;
        glm::dvec3 normal(0, 0, 1);
        glm::dvec2 uv(p.x, -p.y);
        if (p.x < 0) {
            if (const double z2 = 0.5625 - glm::dot(q, q); z2 > 0) {
                expected = p.y > 0 ? 0 : 3;
                normal = glm::dvec3(q, std::sqrt(z2)) / 0.75;
                depth = 8 - std::sqrt(z2);
                const double x = expected == 3 ? -normal.x : normal.x;
                uv = {0.5 + std::atan2(x, normal.z) / (2 * kPi), std::acos(normal.y) / kPi};
            }
        } else if (p.y > 0 ? glm::dot(q, q) < 0.5625 : std::abs(q.x) < 0.75 && std::abs(q.y) < 0.5) {
            expected = p.y > 0 ? 1 : 2;
            depth = 8;
            uv = p.y > 0 ? glm::dvec2(0.5 + q.x / 1.5, 0.5 - q.y / 1.5)
                         : glm::dvec2(0.5 - q.x / 1.5, 0.5 - q.y);
        }
        ASSERT_EQ(image.hits.instance[i], expected) << p.x << " " << p.y;
        EXPECT_EQ(image.hits.triangle[i], 0);
        EXPECT_NEAR(image.hits.depth[i], depth, 2e-6 * depth);
        EXPECT_LT(glm::distance(glm::dvec3(image.hits.normal[i]), normal), 3e-6);
        EXPECT_NEAR(image.hits.albedo[i].x, ramped(uv.x), 1e-5);
        EXPECT_NEAR(image.hits.albedo[i].y, ramped(uv.y), 1e-5);
        ++seen[std::size_t(expected)];
    }
    for (const std::size_t count : seen) EXPECT_GT(count, 100u);
}

/** Few shapes are tested one by one, many in the tree, and all one by one beside other accelerators. */
TEST(PathShapes, EveryAcceleratorFindsTheSame) {
    for (const int count : {5, 40}) {
        SceneBuilder b;
        const int grey = b.material(glm::vec3(0.7f)), lamp = b.material(glm::vec3(0.0f), glm::vec3(3.0f));
        add(b, {.kind = Shape::Kind::Plane}, {0, 0, -1.25f}, grey);
        b.sphere({0, 0, 0}, 0.4f, 2, false, grey);
        for (int i = 0; i < count; ++i) {
            const glm::vec3 at(0.37f * float(i % 7) - 1, 0.41f * float(i % 5) - 0.8f,
                               0.13f * float(i % 11) - 0.6f);
            const Shape shape = i % 3 == 0 ? sphere(0.2f) : (i % 3 == 1 ? disc(0.25f) : quad(0.3f, 0.2f));
            add(b, shape, at, i % 4 == 0 ? lamp : grey).rotation =
                glm::normalize(glm::quat(1, 0.1f * float(i % 6), -0.2f * float(i % 4), 0.3f));
        }
        b.camera({0.2f, 0.3f, 4}, {0, 0, 0}, 0.7f);
        std::vector<glm::dvec3> first;
        const std::vector<AcceleratorKind> kinds =
            count == 5
                ? std::vector{AcceleratorKind::Auto, AcceleratorKind::Grid, AcceleratorKind::KdTree}
                : std::vector{AcceleratorKind::Auto, AcceleratorKind::Bvh, AcceleratorKind::BruteForce};
        for (const AcceleratorKind kind : kinds) {
            PathTraceOptions o = independentOptions(24);
            o.accelerator = kind;
            const Traced image = trace(b.scene, o, 8);
            if (first.empty()) first = image.mean;
            EXPECT_EQ(image.mean, first) << count << " shapes, accelerator " << int(kind);
            EXPECT_EQ(image.rejected, 0u);
        }
    }
}

Renderer& renderer() {
    static Renderer one({.validation = true});
    return one;
}

/** A ball that turns while the shutter is open stays as large, and one that moves is smeared over its way. */
TEST(PathShapes, ShapesMove) {
    SceneBuilder b;
    Node& node = add(b, sphere(0.5f), {0, 0, 0}, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    (void)node;
    const int index = int(b.scene.nodes.size()) - 1;
    Animation animation;
    const float s = std::sqrt(0.5f);
    animation.channels.push_back(
        {index, AnimationPath::Rotation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 0, 0, s, s}});
    animation.channels.push_back(
        {index, AnimationPath::Translation, Interpolation::Linear, {0, 1}, {-1, 0, 0, 1, 0, 0}});
    b.scene.animations.push_back(animation);
    b.camera({0, 0, 4}, {0, 0, 0}, 1);
    b.scene.cameras[0].perspective = false;
    b.scene.cameras[0].ymag = 2;
    RenderOptions o;
    o.size = {16, 16};
    o.samples = 1024;
    o.sampler = SamplerKind::Independent;
    o.shutter = {0, 1};
    o.motionSteps = 1;
    const RenderResult result = renderer().render(b.scene, o);
    EXPECT_TRUE(renderer().device().validationMessages().empty());
    double mean = 0, left = 0;
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            mean += double(result.image.at(x, y, 0)) / 256;
            left += x < 8 ? double(result.image.at(x, y, 0)) / 256 : 0;
        }
    const double truth = kPi * 0.25 / 16, error = std::sqrt(truth / (256.0 * 1024));
    fmt::print("covers {:.6f}, truth {:.6f} +- {:.6f}\n", mean, truth, error);
    EXPECT_NEAR(mean, truth, 4 * error);
    EXPECT_NEAR(left, truth / 2, 4 * error);
}

/** The raster pipeline shows triangles in their place, and says so; radiosity refuses. */
TEST(PathShapes, RasterShowsTriangles) {
    SceneBuilder b;
    const int grey = b.material(glm::vec3(0.5f));
    add(b, sphere(0.5f), {0, 0, 0}, grey);
    add(b, {.kind = Shape::Kind::Plane}, {0, 0, -1}, grey);
    b.camera({0, 0, 4}, {0, 0, 0}, 0.8f);
    b.pointLight({1, 2, 3}, glm::vec3(10.0f));
    RenderOptions o;
    o.size = {64, 64};
    o.samples = 256;
    const RenderResult path = renderer().render(b.scene, o);
    o.pipeline = Pipeline::Raster;
    const RenderResult raster = renderer().render(b.scene, o);
    EXPECT_NE(std::ranges::find(raster.skipped, "exact shapes", &std::pair<std::string, std::string>::first),
              raster.skipped.end());
    double pathMean = 0, rasterMean = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            pathMean += double(path.image.at(x, y, 0)) / 4096;
            rasterMean += double(raster.image.at(x, y, 0)) / 4096;
        }
    fmt::print("path {:.4f}, raster (direct light alone) {:.4f}\n", pathMean, rasterMean);
    EXPECT_GT(rasterMean, 0.7 * pathMean);
    EXPECT_LT(rasterMean, 1.05 * pathMean);
    o.pipeline = Pipeline::Path;
    o.integrator = Integrator::Radiosity;
    EXPECT_THROW(renderer().render(b.scene, o), InputError);
}

TEST(PathShapes, WhatIsNoShapeIsRefused) {
    const auto refused = [](const Shape& shape, const glm::vec3& scale) {
        SceneBuilder b;
        add(b, shape, {0, 0, 0}, b.material(glm::vec3(0.5f))).scale = scale;
        EXPECT_THROW(b.scene.validate(), InputError);
    };
    refused(sphere(1), {1, 2, 1});
    refused(sphere(0), {1, 1, 1});
    refused(sphere(std::numeric_limits<float>::quiet_NaN()), {1, 1, 1});
    refused(disc(1), {0, 1, 1});
    refused(quad(1, -1), {1, 1, 1});
    SceneBuilder b;
    add(b, sphere(1), {0, 0, 0}, b.material(glm::vec3(0.5f)));
    b.scene.meshes[0].primitives[0].positions.resize(3);
    EXPECT_THROW(b.scene.validate(), InputError);
}

}  // namespace
}  // namespace helio::test
