/** @file Rows A4 to A7: antialiasing of the raster pipeline against exact coverage. */
#include "tests/support/renderer.hpp"
#include "tests/support/shader_harness.hpp"

#include <heliograph/error.hpp>
#include <heliograph/verify.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace helio {
namespace {

using test::renderer;

constexpr std::uint32_t kSize = 48;

using Polygon = std::vector<glm::dvec2>;

/** The part of a polygon where n.p + d >= 0. */
Polygon cut(const Polygon& polygon, const glm::dvec2& n, double d) {
    Polygon kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
        const double da = glm::dot(n, a) + d, db = glm::dot(n, b) + d;
        if (da >= 0) kept.push_back(a);
        if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

double area(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 a = polygon[k] - polygon[0], b = polygon[(k + 1) % polygon.size()] - polygon[0];
        sum += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::abs(sum);
}

/** Exact area of a convex polygon in the pixel whose upper left corner is (x, y). */
double coverage(Polygon polygon, double x, double y) {
    polygon = cut(polygon, {1, 0}, -x);
    polygon = cut(polygon, {-1, 0}, x + 1);
    polygon = cut(polygon, {0, 1}, -y);
    polygon = cut(polygon, {0, -1}, y + 1);
    return polygon.size() < 3 ? 0.0 : area(polygon);
}

/** Emissive triangles in pixel coordinates (x right, y down), each in front of those before it, under an
 * orthographic camera. */
struct PixelTriangle {
    std::array<glm::dvec2, 3> corners;
    float emission;
};
Scene pixelScene(const std::vector<PixelTriangle>& triangles) {
    Scene scene;
    scene.name = "pixels";
    Mesh mesh;
    float z = -90;
    for (const PixelTriangle& t : triangles) {
        Material material;
        material.baseColor = {0, 0, 0, 1};
        material.emission = glm::vec3(t.emission);
        material.doubleSided = true;
        Primitive primitive;
        for (const glm::dvec2& c : t.corners)
            primitive.positions.emplace_back(c.x - 0.5 * kSize, 0.5 * kSize - c.y, z);
        primitive.indices = {0, 1, 2};
        primitive.material = int(scene.materials.size());
        scene.materials.push_back(material);
        mesh.primitives.push_back(primitive);
        z += 1;
    }
    scene.meshes = {mesh};
    Camera camera;
    camera.perspective = false;
    camera.ymag = 0.5f * kSize;
    camera.znear = 0.1f;
    camera.zfar = 100;
    scene.cameras = {camera};
    Node object, eye;
    object.mesh = 0;
    eye.camera = 0;
    scene.nodes = {object, eye};
    scene.roots = {0, 1};
    return scene;
}

RenderResult render(const Scene& scene, const Antialiasing& how, bool auxiliary = false) {
    RenderOptions options;
    options.size = {kSize, kSize};
    options.pipeline = Pipeline::Raster;
    options.environment = Environment{};
    options.antialiasing = how;
    options.auxiliary = auxiliary;
    return renderer().render(scene, options);
}

/** The region below a line through the image's middle, as one large triangle, and its exact image. */
struct HalfPlane {
    explicit HalfPlane(double slope) {
        const glm::dvec2 middle(0.5 * kSize + 0.137, 0.5 * kSize + 0.291), along(1, slope);
        triangle = {{middle - 200.0 * along, middle + 200.0 * along, middle + glm::dvec2(0, 4000)}, 1.0f};
        const Polygon polygon(triangle.corners.begin(), triangle.corners.end());
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) exact.push_back(coverage(polygon, x, y));
    }
    PixelTriangle triangle;
    std::vector<double> exact;
    /** Root mean square over the pixels that the edge crosses. */
    double rms(const ImageF& image) const {
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            if (exact[i] <= 0 || exact[i] >= 1) continue;
            const double error = image.data[i * image.channels.size()] - exact[i];
            sum += error * error;
            ++count;
        }
        return std::sqrt(sum / double(count));
    }
};

double slopeOfFit(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        sx += x[i];
        sy += y[i];
        sxx += x[i] * x[i];
        sxy += x[i] * y[i];
    }
    const double n = double(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(Coverage, ExactAreaOfTrianglesInAPixel) {
    std::mt19937 random(1);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (random() / 4294967296.0);
    };
    std::vector<glm::vec2> a, b, c;
    std::vector<double> exact;
    for (int i = 0; i < 20000; ++i) {
        const double size = std::pow(10.0, uniform(-2, 1.5));
        glm::vec2 p[3];
        for (auto& v : p) v = glm::vec2(0.5 + size * uniform(-1, 1), 0.5 + size * uniform(-1, 1));
        if (i % 5 == 0) p[1].x = p[0].x;
        if (i % 7 == 0) p[2].y = p[1].y;
        if (i % 11 == 0) p[0] = glm::vec2(0, 1);
        a.push_back(p[0]);
        b.push_back(p[1]);
        c.push_back(p[2]);
        exact.push_back(coverage({p[0], p[1], p[2]}, 0, 0));
    }
    const std::vector<float> got =
        test::runOnDevice<float>("shaders/raster/coverage.glsl", "pixelCoverage(a, b, c)", a, b, c);
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(got[i] - exact[i]));
    std::printf("             worst %.2g square pixels\n", worst);
    EXPECT_LT(worst, 1e-6);
}

TEST(Coverage, PixelsOfATriangleAddUpToItsArea) {
    const glm::vec2 p[3] = {{3.2f, 1.7f}, {40.9f, 22.3f}, {11.6f, 44.1f}};
    std::vector<glm::vec2> a, b, c;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
            a.push_back(p[0] - glm::vec2(x, y));
            b.push_back(p[1] - glm::vec2(x, y));
            c.push_back(p[2] - glm::vec2(x, y));
        }
    double sum = 0;
    for (float v :
         test::runOnDevice<float>("shaders/raster/coverage.glsl", "pixelCoverage(a, b, c)", a, b, c))
        sum += v;
    EXPECT_NEAR(sum, area({p[0], p[1], p[2]}), 1e-4);
}

TEST(Supersampling, ErrorFallsAsTheoryOfThePatternSays) {
    // Random samples: N^-1/2. Jittered: N^-3/4. A grid against an edge along its rows: no better than N^-1/2.
    std::vector<double> n, random, jittered, grid;
    for (int side = 2; side <= 12; side = side < 4 ? side + 1 : side * 3 / 2) {
        double sums[3] = {};
        int images = 0;
        for (double slope : {0.31, 0.77, -0.53}) {
            const HalfPlane edge(slope);
            const Scene scene = pixelScene({edge.triangle});
            for (std::uint32_t seed = 0; seed < 4; ++seed, ++images) {
                const std::string samples = std::to_string(side * side), cells = std::to_string(side);
                const double r = edge.rms(render(scene, antialiasing("random" + samples, seed)).image),
                             j = edge.rms(render(scene, antialiasing("jitter" + cells, seed)).image);
                sums[0] += r * r;
                sums[1] += j * j;
            }
        }
        const HalfPlane level(0.0);
        n.push_back(std::log2(side * side));
        random.push_back(std::log2(std::sqrt(sums[0] / images)));
        jittered.push_back(std::log2(std::sqrt(sums[1] / images)));
        grid.push_back(std::log2(level.rms(
            render(pixelScene({level.triangle}), antialiasing("grid" + std::to_string(side))).image)));
    }
    const double ofRandom = slopeOfFit(n, random), ofJittered = slopeOfFit(n, jittered);
    std::printf("             random N^%.3f, jittered N^%.3f, grid along the edge %.3f at N = %.0f\n",
                ofRandom, ofJittered, std::exp2(grid.back()), std::exp2(n.back()));
    EXPECT_NEAR(ofRandom, -0.5, 0.1);
    EXPECT_NEAR(ofJittered, -0.75, 0.1);
    // All columns of a grid see an edge along it alike: sqrt(N) distinct heights, error up to half a step.
    for (std::size_t i = 0; i < n.size(); ++i)
        EXPECT_LE(std::exp2(grid[i]), 0.5 / std::sqrt(std::exp2(n[i])) + 1e-6);
}

/** Triangles that overlap and share edges, each of its own brightness. */
std::vector<PixelTriangle> overlapping() {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (random() / 4294967296.0);
    };
    std::vector<PixelTriangle> triangles;
    for (int i = 0; i < 40; ++i) {
        const glm::dvec2 centre(uniform(0, kSize), uniform(0, kSize));
        PixelTriangle t;
        for (auto& c : t.corners) c = centre + glm::dvec2(uniform(-9, 9), uniform(-9, 9));
        t.emission = float(i + 1);
        triangles.push_back(t);
    }
    return triangles;
}

/** A pattern whose middle is not the pixel's shifts the picture. */
TEST(Supersampling, PatternsAreCentred) {
    for (int count = 1; count <= 64; ++count)
        for (const char* kind : {"ssaa", "grid"}) {
            const auto positions = antialiasing(kind + std::to_string(count)).positions;
            glm::dvec2 mean(0);
            for (const auto& [x, y] : positions) {
                EXPECT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1) << kind << count;
                mean += glm::dvec2(x, y) / double(positions.size());
            }
            EXPECT_LT(glm::length(mean - 0.5), 1e-6) << kind << count;
        }
}

TEST(Multisampling, StandardPositionsSharesAndOneShadingPerTriangleAndPixel) {
    const Scene scene = pixelScene(overlapping());
    EXPECT_EQ(
        antialiasing("msaa4").positions,
        (std::vector<std::array<float, 2>>{{.375f, .125f}, {.875f, .375f}, {.125f, .625f}, {.625f, .875f}}));
    for (std::size_t count : {2u, 4u, 8u, 16u}) {
        const Antialiasing how = antialiasing("msaa" + std::to_string(count));
        ASSERT_EQ(how.positions.size(), count);
        const RenderResult result = render(scene, how);
        // The same, sample by sample: brightness tells the triangle.
        std::vector<std::set<float>> seen(kSize * kSize);
        std::vector<double> mean(kSize * kSize);
        for (const auto& position : how.positions) {
            const ImageF one = render(scene, {Antialiasing::Kind::Supersampling, {position}}).image;
            for (std::size_t i = 0; i < mean.size(); ++i) {
                const float value = one.data[i * one.channels.size()];
                if (value > 0) seen[i].insert(value);
                mean[i] += value / double(count);
            }
        }
        std::uint64_t expected = 0, shaded = 0;
        double worst = 0;
        for (std::size_t i = 0; i < mean.size(); ++i) {
            expected += seen[i].size();
            worst = std::max(worst, std::abs(result.image.data[i * result.image.channels.size()] - mean[i]));
        }
        for (const auto& [name, value] : result.counters)
            if (name == "pixels_shaded") shaded = value;
        EXPECT_EQ(shaded, expected) << count;
        EXPECT_LT(worst, 1e-5) << count;
        EXPECT_EQ(result.samples, count);
    }
    // One triangle: only multiples of a quarter.
    const HalfPlane edge(0.31);
    const ImageF image = render(pixelScene({edge.triangle}), antialiasing("msaa4")).image;
    std::set<float> values;
    for (std::size_t i = 0; i < kSize * kSize; ++i) values.insert(image.data[i * image.channels.size()]);
    EXPECT_EQ(values, (std::set<float>{0.0f, 0.25f, 0.5f, 0.75f, 1.0f}));
}

TEST(Multisampling, BitsDoNotDependOnTheOrderOfTriangles) {
    std::vector<PixelTriangle> triangles = overlapping();
    const auto image = [&](const Scene& scene) { return render(scene, antialiasing("msaa8")).image.data; };
    const Scene scene = pixelScene(triangles);
    Scene turned = scene;
    std::reverse(turned.meshes[0].primitives.begin(), turned.meshes[0].primitives.end());
    const std::vector<float> a = image(scene), b = image(turned);
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, double(std::abs(a[i] - b[i])));
    EXPECT_EQ(worst, 0);
}

TEST(Fxaa, EdgesComeCloserToTheirExactCoverage) {
    double before = 0, after = 0;
    for (double slope : {0.05, 0.12, 0.2, 0.31, 0.5, 0.77, 1.0, -0.12, -0.4, 3.0, 8.0}) {
        const HalfPlane edge(slope);
        const Scene scene = pixelScene({edge.triangle});
        const double rough = edge.rms(render(scene, {}).image),
                     smooth = edge.rms(render(scene, antialiasing("fxaa")).image);
        std::printf("             slope %5.2f: RMS error %.4f -> %.4f\n", slope, rough, smooth);
        EXPECT_LT(smooth, rough) << slope;
        before += rough * rough;
        after += smooth * smooth;
    }
    std::printf("             all: falls by %.0f %%\n", 100 * (1 - std::sqrt(after / before)));
    EXPECT_LT(std::sqrt(after / before), 0.6);  // 0.69 where the wrong side of an edge is mixed
}

TEST(Fxaa, WithoutContrastNoBitChanges) {
    // Two halves whose lightness differs by less than an eighth, over the whole picture.
    const HalfPlane edge(0.31);
    PixelTriangle back{{glm::dvec2(-500, -500), {2000, -500}, {-500, 2000}}, 0.50f}, front = edge.triangle;
    front.emission = 0.58f;  // sqrt: 0.707 and 0.762
    const Scene scene = pixelScene({back, front});
    EXPECT_EQ(render(scene, antialiasing("fxaa")).image.data, render(scene, {}).image.data);
    front.emission = 0.50f;
    const Scene constant = pixelScene({back, front});
    for (float v : render(constant, antialiasing("fxaa")).image.data) EXPECT_EQ(v, 0.5f);
}

TEST(Antialiasing, NamesThatAreRefused) {
    for (const char* name :
         {"", "msaa", "msaa3", "msaa32", "ssaa", "ssaa0", "grid65", "jitter-1", "fxaa2", "MSAA4"})
        EXPECT_THROW(antialiasing(name), InputError) << name;
    RenderOptions options;
    options.pipeline = Pipeline::Raster;
    options.antialiasing = {Antialiasing::Kind::Supersampling, {{0.5f, 1.5f}}};
    EXPECT_THROW(renderer().render(pixelScene(overlapping()), options), InputError);
}

TEST(Supersampling, SamplesOfALargeSceneLeaveOutWhatAWallHides) {
    // Glowing cards behind a wall that hides all of them, and the wall alone.
    Scene scene;
    Material glow;
    glow.emission = {0, 1, 0};
    glow.baseColor = {0.5f, 0.4f, 0.2f, 1};
    Material wall = glow;
    wall.emission = {1, 0.5f, 0.25f};
    scene.materials = {glow, wall};
    Primitive cards, front;
    cards.material = 0;
    constexpr std::uint32_t count = 70000;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float x = -0.8f + 1.6f * float(i % 280) / 280, y = -0.8f + 1.6f * float(i / 280) / 250;
        cards.positions.insert(cards.positions.end(), {{x, y, 0}, {x + 0.01f, y, 0}, {x, y + 0.01f, -0.1f}});
        cards.indices.insert(cards.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    front.material = 1;
    front.positions = {{-2, -2, 2}, {2, -2, 1}, {2, 2, 2}, {-2, 2, 1}, {0.2f, 0.3f, 3}};
    front.indices = {0, 1, 2, 0, 2, 3, 0, 1, 4};
    scene.meshes = {{"front", {front}}, {"cards", {cards}}};
    Camera camera;
    camera.perspective = false;
    camera.ymag = 1;
    scene.cameras = {camera};
    Node eye, first, second;
    eye.camera = 0;
    eye.translation = {0, 0, 10};
    first.mesh = 0;
    second.mesh = 1;
    scene.nodes = {eye, first, second};
    scene.roots = {0, 1, 2};
    RenderOptions options;
    options.pipeline = Pipeline::Raster;
    options.size = {64, 64};
    options.environment = Environment{.radiance = {0.25f, 0.5f, 1}};
    for (const char* name : {"ssaa4", "taa"}) {
        options.antialiasing = antialiasing(name);
        options.antialiasing.temporal.frames = 4;
        scene.roots = {0, 1, 2};
        const RenderResult all = renderer().render(scene, options);
        std::uint64_t hidden = 0, triangles = 0;
        for (const auto& [key, value] : all.counters) {
            if (key == "triangles_hidden") hidden = std::uint64_t(value);
            if (key == "triangles") triangles = std::uint64_t(value);
        }
        EXPECT_GE(triangles, 4u * (count + 3)) << name;
        EXPECT_GT(hidden, 4u * (count - 100)) << name;  // but for a cluster that lies on both
        scene.roots = {0, 1};
        const RenderResult alone = renderer().render(scene, options);
        EXPECT_EQ(all.image.data, alone.image.data) << name;
        for (const auto& [key, value] : alone.counters) EXPECT_NE(key, "triangles_hidden");
    }
}

}  // namespace
}  // namespace helio
