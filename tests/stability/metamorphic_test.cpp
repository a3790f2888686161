// Changes of a scene whose effect on the picture is known without knowing the picture: for what a reference
// for one scene cannot see. Bit for bit where only order or powers of two change; else by z-scores over
// independently seeded renders.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/stability/measure.hpp"
#include "tests/stability/variants.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace helio::test {
namespace {

constexpr std::uint32_t kSize = 24;
constexpr Pipeline kBoth[] = {Pipeline::Path, Pipeline::Raster};

RenderOptions options(Pipeline pipeline = Pipeline::Path, std::uint32_t samples = 16) {
    return independentSamples(kSize, samples, pipeline);
}

/** A room with a lamp, a point light, a textured floor, glass, a rough metal and an instance under rotation
 * and uneven scale. */
Scene room() {
    SceneBuilder builder;
    Scene& scene = builder.scene;
    const int grey = builder.material(glm::vec3(0.7f)), red = builder.material({0.6f, 0.1f, 0.1f});
    const int lamp = builder.material(glm::vec3(0.2f), {8, 7, 6});
    const int floor = builder.material(glm::vec3(0.8f));
    const int metal = builder.material({0.9f, 0.7f, 0.4f}), glass = builder.material(glm::vec3(1.0f));
    Material& rough = scene.materials[std::size_t(metal)];
    rough.metallic = 1;
    rough.roughness = 0.3f;
    Material& clear = scene.materials[std::size_t(glass)];
    clear.specular = 1;
    clear.roughness = 0;
    clear.transmission = 1;
    clear.thickness = 1;
    builder.room({-1, 0, -1}, {1, 2, 1}, {red, grey, floor, grey, grey, grey});
    builder.quad({-0.4f, 1.98f, -0.4f}, {0.4f, 1.98f, -0.4f}, {0.4f, 1.98f, 0.4f}, {-0.4f, 1.98f, 0.4f},
                 lamp);
    builder.sphere({-0.4f, 0.35f, -0.3f}, 0.35f, 3, false, metal);
    builder.sphere({0.4f, 0.3f, 0.3f}, 0.3f, 3, false, glass);
    const int ball = builder.sphere({0, 0, 0}, 0.25f, 2, false, red);
    Node& turned = scene.nodes[std::size_t(scene.roots[std::size_t(ball)])];
    turned.translation = {0.45f, 1.2f, -0.5f};
    turned.rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    turned.scale = {1.5f, 0.5f, 1.0f};

    TextureImage checker{"checker", 4, 4, std::vector<std::uint8_t>()};
    for (int i = 0; i < 16; ++i)
        for (int c = 0; c < 4; ++c)
            std::get<0>(checker.texels)
                .push_back(c == 3 || (i + i / 4) % 2 ? 255 : std::uint8_t(60 + 50 * c));
    scene.images = {checker};
    scene.textures = {Texture{"checker", 0}};
    scene.materials[std::size_t(floor)].baseColorTexture.texture = 0;
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.texcoords.emplace_back();
            for (const glm::vec3& p : primitive.positions) primitive.texcoords[0].emplace_back(p.x, p.z);
        }
    builder.pointLight({-0.5f, 1.5f, 0.6f}, {0.5f, 0.6f, 0.9f});
    builder.camera({0, 1, 0.95f}, {0, 0.8f, -1}, 1.4f);
    return scene;
}

ImageF render(const Scene& scene, const RenderOptions& settings) {
    const RenderResult result = renderer().render(scene, settings);
    EXPECT_EQ(result.nanCount, 0u);
    return result.image;
}

std::vector<float> values(const ImageF& image, const std::array<const char*, 3>& names) {
    std::vector<float> result;
    for (std::size_t i = 0; i < std::size_t(image.width) * image.height; ++i)
        for (const char* name : names)
            result.push_back(image.data[i * image.channels.size() + std::size_t(image.channel(name))]);
    return result;
}
std::vector<float> colors(const ImageF& image) {
    return values(image, {"R", "G", "B"});
}
std::vector<float> variances(const ImageF& image) {
    return values(image, {"variance.R", "variance.G", "variance.B"});
}

/** Worst relative difference of two pictures' values. */
double worst(const std::vector<float>& a, const std::vector<float>& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i])
            result = std::max(result, std::abs(double(a[i]) - b[i]) / (std::abs(double(b[i])) + 1e-3));
    return result;
}

/** Quarters of the picture, whose means are near normal where a pixel's is not: every one within 4.5 standard
 * errors, 12 values a comparison. */
void expectEqualInTheMean(const ImageF& a, const ImageF& b, const std::string& what) {
    for (int channel = 0; channel < 3; ++channel)
        for (int quarter = 0; quarter < 4; ++quarter) {
            double difference = 0, variance = 0, total = 0;
            const std::vector<float> x = colors(a), y = colors(b), vx = variances(a), vy = variances(b);
            for (std::uint32_t row = 0; row < a.height; ++row)
                for (std::uint32_t column = 0; column < a.width; ++column) {
                    if (int(row >= a.height / 2) * 2 + int(column >= a.width / 2) != quarter) continue;
                    const std::size_t i = 3 * (std::size_t(row) * a.width + column) + std::size_t(channel);
                    difference += double(x[i]) - y[i];
                    variance += double(vx[i]) + vy[i];
                    total += y[i];
                }
            const double z = difference / std::sqrt(variance);
            EXPECT_LT(std::abs(z), 4.5) << what << ", channel " << channel << ", quarter " << quarter
                                        << ", relative " << difference / total;
            EXPECT_LT(std::sqrt(variance), 0.05 * total) << what << ": too noisy to tell";
        }
}

TEST(Metamorphic, PowersOfTwoScaleExactly) {
    const Scene scene = room();
    for (const Pipeline pipeline : kBoth) {
        const std::vector<float> truth = colors(render(scene, options(pipeline)));
        for (const int power : {-20, 3, 20}) {
            // A point light's intensity grows with the square of distances.
            Scene scaled =
                transformed(scene, glm::scale(glm::mat4(1.0f), glm::vec3(std::ldexp(1.0f, power))));
            for (PunctualLight& light : scaled.lights) light.intensity *= std::ldexp(1.0f, 2 * power);
            EXPECT_EQ(worst(colors(render(scaled, options(pipeline))), truth), 0)
                << "2^" << power << (pipeline == Pipeline::Path ? " path" : " raster");
        }
    }
}

TEST(Metamorphic, TwiceTheLightIsTwiceThePicture) {
    Scene scene = room();
    for (const Pipeline pipeline : kBoth) {
        std::vector<float> truth = colors(render(scene, options(pipeline)));
        for (const float factor : {2.0f, 0x1p-30f, 0x1p30f}) {
            std::vector<float> bright = colors(render(brightened(scene, factor), options(pipeline)));
            for (float& x : bright) x /= factor;
            EXPECT_EQ(worst(bright, truth), 0) << factor;
        }
    }
}

TEST(Metamorphic, TheOrderOfTrianglesDoesNotMatter) {
    const Scene scene = room();
    for (const Pipeline pipeline : kBoth) {
        const std::vector<float> truth = colors(render(scene, options(pipeline)));
        for (const std::uint32_t seed : {1u, 2u})
            EXPECT_EQ(worst(colors(render(permuted(scene, seed), options(pipeline))), truth), 0) << seed;
    }
}

TEST(Metamorphic, SplitTrianglesShowTheSame) {
    const ImageF whole = render(room(), options(Pipeline::Path, 256));
    RenderOptions other = options(Pipeline::Path, 256);
    other.seed = 1;
    expectEqualInTheMean(render(refined(room()), other), whole, "split");
}

TEST(Metamorphic, BakedInstancesShowTheSame) {
    const ImageF placed = render(room(), options(Pipeline::Path, 256));
    RenderOptions other = options(Pipeline::Path, 256);
    other.seed = 1;
    expectEqualInTheMean(render(baked(room()), other), placed, "baked");
    EXPECT_LT(worst(colors(render(baked(room()), options(Pipeline::Raster))),
                    colors(render(room(), options(Pipeline::Raster)))),
              1e-3);
}

TEST(Metamorphic, EverythingTwiceInOnePlaceShowsTheSame) {
    // Lambertian alone: glass in glass would be another scene.
    const Scene scene = load("sample:cornell");
    const ImageF once = render(scene, options(Pipeline::Path, 256));
    RenderOptions other = options(Pipeline::Path, 256);
    other.seed = 1;
    expectEqualInTheMean(render(doubled(scene), other), once, "twice");
    const RenderOptions raster = options(Pipeline::Raster);
    EXPECT_LT(worst(colors(render(doubled(scene), raster)), colors(render(scene, raster))), 1e-5);
}

TEST(Metamorphic, MovingAndTurningTheWorldChangesNothing) {
    const ImageF truth = render(room(), options(Pipeline::Path, 256));
    const glm::mat4 one(1.0f);
    std::uint32_t seed = 0;
    const auto check = [&](const glm::mat4& transform, const std::string& what) {
        RenderOptions other = options(Pipeline::Path, 256);
        other.seed = ++seed;
        expectEqualInTheMean(render(transformed(room(), transform), other), truth, what);
    };
    for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
        check(glm::rotate(one, glm::radians(90.0f), axis), "quarter turn");
    check(glm::rotate(one, 2.1f, glm::normalize(glm::vec3(1, -2, 0.5f))), "turned");
    check(glm::translate(one, glm::vec3(300, -700, 150)), "moved by 380 sizes");
    check(glm::translate(one, glm::vec3(3e4f, -7e4f, 1e4f)), "moved by 38000 sizes");
}

TEST(Metamorphic, AMirroredWorldGivesAMirroredPicture) {
    for (const Pipeline pipeline : kBoth) {
        const ImageF truth = render(room(), options(pipeline, 256));
        RenderOptions other = options(pipeline, 256);
        other.seed = 1;
        // The camera stays: it must not be mirrored itself, which no camera of the contract is.
        Scene mirrored = room();
        const Scene plain = room();
        const glm::mat4 flip = glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1));
        mirrored.roots.clear();
        Node root;
        root.matrix = flip;
        for (const int node : plain.roots) {
            if (plain.nodes[std::size_t(node)].camera >= 0)
                mirrored.roots.push_back(node);
            else
                root.children.push_back(node);
        }
        mirrored.nodes.push_back(root);
        mirrored.roots.push_back(int(mirrored.nodes.size()) - 1);
        ImageF image = render(mirrored, other);
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width / 2; ++x)
                for (std::size_t c = 0; c < image.channels.size(); ++c)
                    std::swap(image.at(x, y, c), image.at(image.width - 1 - x, y, c));
        if (pipeline == Pipeline::Path)
            expectEqualInTheMean(image, truth, "mirrored");
        else
            EXPECT_LT(compareImages(image, truth).relmse, 1e-3);
    }
}

TEST(Metamorphic, LightAdds) {
    Scene lampOnly = room(), pointOnly = room();
    for (Node& node : lampOnly.nodes) node.light = -1;
    pointOnly = withEmitters(pointOnly, [](std::size_t) { return false; });
    std::uint32_t seed = 0;
    const auto traced = [&](const Scene& scene) {
        RenderOptions other = options(Pipeline::Path, 256);
        other.seed = ++seed;
        other.environment = Environment{};  // none in place of the one that unlit scenes get
        return render(scene, other);
    };
    ImageF sum = traced(lampOnly);
    const ImageF second = traced(pointOnly);
    for (std::size_t i = 0; i < std::size_t(sum.width) * sum.height; ++i)
        for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) {
            const std::size_t at = i * sum.channels.size() + std::size_t(sum.channel(name));
            sum.data[at] += second.data[at];
        }
    expectEqualInTheMean(traced(room()), sum, "sum");
}

/** Two equal squares in a room with a block between them: light from one that reaches the other is the same
 * both ways (Helmholtz). Cameras look straight at either from near, so that nothing else is seen. */
TEST(Metamorphic, CameraAndLightChangePlaces) {
    const auto scene = [](bool first) {
        SceneBuilder builder;
        const int grey = builder.material(glm::vec3(0.6f));
        const int a = builder.material(glm::vec3(0.5f), glm::vec3(first ? 10.0f : 0.0f));
        const int b = builder.material(glm::vec3(0.5f), glm::vec3(first ? 0.0f : 10.0f));
        builder.room({-1, 0, -1}, {1, 2, 1}, {grey, grey, grey, grey, grey, grey});
        builder.quad({-0.6f, 1.9f, -0.6f}, {-0.2f, 1.9f, -0.6f}, {-0.2f, 1.9f, -0.2f}, {-0.6f, 1.9f, -0.2f},
                     a);
        builder.quad({0.5f, 0.1f, 0.2f}, {0.5f, 0.1f, 0.6f}, {0.9f, 0.1f, 0.6f}, {0.9f, 0.1f, 0.2f}, b);
        builder.sphere({0.1f, 1, 0}, 0.4f, 2, false, grey);
        const glm::vec3 seen = first ? glm::vec3(0.7f, 0.1f, 0.4f) : glm::vec3(-0.4f, 1.9f, -0.4f);
        builder.camera(seen + glm::vec3(0, first ? 0.3f : -0.3f, 0), seen, 2 * std::atan(0.2f / 0.3f),
                       {0, 0, 1});
        return builder.scene;
    };
    RenderOptions settings = options(Pipeline::Path, 512);
    const Mean there = meanOf(render(scene(true), settings));
    settings.seed = 1;
    const Mean back = meanOf(render(scene(false), settings));
    const double error = std::hypot(there.error, back.error);
    EXPECT_LT(error, 0.01 * there.value);
    EXPECT_LT(std::abs(there.value - back.value), 4 * error) << there.value << " and " << back.value;
}

TEST(Metamorphic, OnePixelWideAndHighPicturesAreParts) {
    const Scene scene = room();
    for (const bool wide : {false, true}) {
        RenderOptions settings = options(Pipeline::Raster);
        const std::uint32_t n = 65;
        settings.size = {n, n};
        const ImageF whole = render(scene, settings);
        settings.size = wide ? std::array<std::uint32_t, 2>{n, 1} : std::array<std::uint32_t, 2>{1, n};
        Scene strip = scene;
        if (wide)  // the vertical field of view is that of one row
            for (Camera& camera : strip.cameras)
                camera.yfov = 2 * std::atan(std::tan(camera.yfov / 2) / float(n));
        const ImageF part = render(strip, settings);
        double difference = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                difference =
                    std::max(difference, std::abs(double(wide ? part.at(i, 0, c) : part.at(0, i, c)) -
                                                  (wide ? whole.at(i, n / 2, c) : whole.at(n / 2, i, c))));
        EXPECT_LT(difference, 1e-3) << (wide ? "one row" : "one column");
        settings = options(Pipeline::Path, 64);
        settings.size = {wide ? n : 1, wide ? 1 : n};
        const Mean traced = meanOf(render(strip, settings));
        settings.size = {n, n};
        const ImageF image = render(scene, settings);
        double value = 0, variance = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c) {
                const std::uint32_t x = wide ? i : n / 2, y = wide ? n / 2 : i;
                value += image.at(x, y, std::size_t(c)) / (3.0 * n);
                variance += image.at(x, y,
                                     std::size_t(image.channel(std::array{"variance.R", "variance.G",
                                                                          "variance.B"}[std::size_t(c)]))) /
                            (9.0 * n * n);
            }
        EXPECT_LT(std::abs(traced.value - value), 4.5 * std::sqrt(variance + traced.error * traced.error));
    }
}

}  // namespace
}  // namespace helio::test
