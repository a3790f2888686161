// Surfaces that let light through, in the raster pipeline: closed forms of layers in any order, and the path
// tracer.

#include "engine/scene/samples/shapes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace helio {
namespace {

using test::renderer;

/** A glowing black rectangle over x and y from -1 to 1 whose z is `z` + `slope` x. */
struct Sheet {
    double z, slope;
    float alpha;
    glm::vec3 glow;
    AlphaMode mode = AlphaMode::Blend;
};

/** Sheets under a camera that looks down from z = 10 along -z, one unit from the middle to the upper edge. */
Scene sheets(const std::vector<Sheet>& list) {
    Scene scene;
    scene.name = "sheets";
    for (const Sheet& sheet : list) {
        Material material;
        material.baseColor = {0, 0, 0, sheet.alpha};
        material.metallic = 0;
        material.specular = 0;
        material.emission = sheet.glow;
        material.alphaMode = sheet.mode;
        scene.materials.push_back(material);
        Primitive square;
        for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
            square.positions.emplace_back(x, y, sheet.z + sheet.slope * x);
        square.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
        square.indices = {0, 1, 2, 0, 2, 3};
        square.material = int(scene.materials.size()) - 1;
        scene.meshes.push_back({"sheet", {square}});
        Node node;
        node.mesh = int(scene.meshes.size()) - 1;
        scene.nodes.push_back(node);
    }
    Camera camera;
    camera.perspective = false;
    camera.ymag = 1;
    scene.cameras = {camera};
    Node eye;
    eye.camera = 0;
    eye.translation = {0, 0, 10};
    scene.nodes.push_back(eye);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) scene.roots.push_back(int(i));
    return scene;
}

RenderOptions raster(std::uint32_t size) {
    RenderOptions options;
    options.size = {size, size};
    options.pipeline = Pipeline::Raster;
    options.samples = 1;
    options.environment = Environment{.radiance = {0.25f, 0.5f, 1}};
    return options;
}

/** What a pixel column at x shows: the sheets blended from the back, over the surroundings. */
glm::dvec3 blended(std::vector<Sheet> list, double x) {
    std::ranges::sort(list, [&](const Sheet& a, const Sheet& b) {
        return a.z + a.slope * x < b.z + b.slope * x;  // the farthest first
    });
    glm::dvec3 color(0.25, 0.5, 1);
    for (const Sheet& sheet : list) {
        const double alpha = sheet.mode == AlphaMode::Blend  ? double(sheet.alpha)
                             : sheet.mode == AlphaMode::Mask ? (sheet.alpha >= 0.5f ? 1.0 : 0.0)
                                                             : 1.0;
        color = alpha * glm::dvec3(sheet.glow) + (1 - alpha) * color;
    }
    return color;
}

std::vector<Sheet> crossingSheets(std::size_t count) {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (double(random()) / 4294967296.0);
    };
    std::vector<Sheet> list;
    for (std::size_t i = 0; i < count; ++i) {
        Sheet sheet{uniform(-3, 3), uniform(-2, 2), float(uniform(0.1, 0.9)), glm::vec3(0.0f)};
        for (int c = 0; c < 3; ++c) sheet.glow[c] = float(uniform(0, 2));
        if (i == 4) sheet = {2, 0, 0.3f, sheet.glow, AlphaMode::Mask};       // a hole all over
        if (i == 6) sheet = {-3.5, 1.5, 0.8f, sheet.glow, AlphaMode::Mask};  // behind most
        list.push_back(sheet);
    }
    return list;
}

double counter(const RenderResult& result, const char* name) {
    for (const auto& [key, value] : result.counters)
        if (key == name) return double(value);
    return -1;
}

TEST(ShadeAlpha, CrossingSheetsAreBlendedInTheirOrderAtEveryPixel) {
    const std::vector<Sheet> list = crossingSheets(12);
    constexpr std::uint32_t size = 33;  // odd: the rasterizer's other tile kernel
    for (const std::uint32_t width : {size, size + 1}) {
        const RenderResult result = renderer().render(sheets(list), raster(width));
        double worst = 0;
        for (std::uint32_t y = 0; y < width; ++y)
            for (std::uint32_t i = 0; i < width; ++i) {
                const double x = 2 * (i + 0.5) / width - 1;
                const glm::dvec3 expected = blended(list, x);
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst,
                                     std::abs(double(result.image.at(i, y, std::uint32_t(c))) - expected[c]));
            }
        EXPECT_LT(worst, 2e-6) << width;
        EXPECT_GE(counter(result, "alpha_layers"), 8);
        EXPECT_LE(counter(result, "alpha_layers"), 13);
        EXPECT_TRUE(result.warnings.empty());
    }
}

TEST(ShadeAlpha, TheOrderOfTheScenesTrianglesHasNoInfluence) {
    std::vector<Sheet> list = crossingSheets(9);
    RenderOptions options = raster(48);
    options.auxiliary = false;
    const RenderResult first = renderer().render(sheets(list), options);
    std::mt19937 random(2);
    for (int k = 0; k < 3; ++k) {
        std::ranges::shuffle(list, random);
        EXPECT_EQ(renderer().render(sheets(list), options).image.data, first.image.data);
    }
}

TEST(ShadeAlpha, HolesOfAMaskShowWhatIsBehind) {
    // Left half of the texture is a hole; behind it an opaque sheet.
    std::vector<Sheet> list = {{1, 0, 1, {1, 0, 0}, AlphaMode::Mask},
                               {0, 0, 1, {0, 1, 0}, AlphaMode::Opaque}};
    Scene scene = sheets(list);
    scene.images.push_back({"hole", 2, 1, std::vector<float>{1, 1, 1, 0.25f, 1, 1, 1, 0.75f}});
    Texture texture;
    texture.image = 0;
    texture.useMipmaps = false;
    scene.textures.push_back(texture);
    scene.materials[0].baseColorTexture.texture = 0;
    RenderOptions options = raster(16);
    options.textureFilter = TextureFilter::Nearest;
    const RenderResult result = renderer().render(scene, options);
    const auto ids = std::size_t(result.image.channel("id.instance"));
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            EXPECT_EQ(result.image.at(x, y, 0), x < 8 ? 0.0f : 1.0f);
            EXPECT_EQ(result.image.at(x, y, 1), x < 8 ? 1.0f : 0.0f);
            EXPECT_EQ(result.image.at(x, y, ids), x < 8 ? 1.0f : 0.0f);
        }
}

TEST(ShadeAlpha, ThePathTracerSeesTheSame) {
    const Scene scene = sheets(crossingSheets(7));
    const RenderResult layers = renderer().render(scene, raster(16));
    RenderOptions options = raster(16);
    options.pipeline = Pipeline::Path;
    options.samples = 256;
    const RenderResult paths = renderer().render(scene, options);
    // All pixels of a column show the same: 16 x 256 samples of values up to 2 each.
    for (std::uint32_t x = 0; x < 16; ++x)
        for (std::uint32_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (std::uint32_t y = 0; y < 16; ++y)
                sum += double(paths.image.at(x, y, c)) - double(layers.image.at(x, y, c));
            // A pixel's paths are spread over its width; sheets cross in few of them.
            EXPECT_NEAR(sum / 16, 0.0, 0.08) << x;
        }
    double difference = 0, mean = 0;
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            difference += double(paths.image.at(x, y, 1)) - double(layers.image.at(x, y, 1));
            mean += double(layers.image.at(x, y, 1));
        }
    EXPECT_LT(std::abs(difference / mean), 0.02);
}

TEST(ShadeAlpha, SupersamplesHaveLayersOfTheirOwn) {
    const std::vector<Sheet> list = {{1, 0, 0.5f, {1, 0, 0}}, {0, 0, 0.25f, {0, 1, 0}}};
    RenderOptions options = raster(16);
    options.antialiasing = antialiasing("ssaa4");
    const RenderResult result = renderer().render(sheets(list), options);
    const glm::dvec3 expected = blended(list, 0);
    for (std::uint32_t c = 0; c < 3; ++c)
        EXPECT_NEAR(double(result.image.at(7, 9, c)), expected[int(c)], 1e-6);
    // Multisampling has the same, by shading its samples one by one: it says so.
    options.antialiasing = antialiasing("msaa4");
    const RenderResult multi = renderer().render(sheets(list), options);
    for (std::uint32_t c = 0; c < 3; ++c)
        EXPECT_NEAR(double(multi.image.at(7, 9, c)), expected[int(c)], 1e-6);
    EXPECT_EQ(counter(multi, "pixels_shaded"), counter(result, "pixels_shaded"));
    EXPECT_TRUE(std::ranges::any_of(multi.skipped, [](const auto& s) { return s.first == "multisampling"; }));
}

/** Alpha of a mask over its sheet: smooth, so that a pixel off by its width changes little. */
double maskAlpha(double u, double v) {
    const double pi = 3.14159265358979;
    return 0.5 + 0.45 * std::sin(4 * pi * u) * std::sin(4 * pi * v);
}

/** Gives a sheet of the scene that mask. */
void addMask(Scene& scene, std::size_t material) {
    constexpr std::uint32_t size = 128;
    std::vector<float> texels;
    for (std::uint32_t i = 0; i < size * size; ++i)
        for (int c = 0; c < 4; ++c)
            texels.push_back(c < 3 ? 1.0f
                                   : float(maskAlpha((i % size + 0.5) / size, (i / size + 0.5) / size)));
    scene.images.push_back({"mask", size, size, std::move(texels)});
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    texture.useMipmaps = false;
    scene.textures.push_back(texture);
    scene.materials[material].alphaMode = AlphaMode::Mask;
    scene.materials[material].baseColorTexture.texture = int(scene.textures.size()) - 1;
}

TEST(ShadeAlpha, MultisamplesSeeThroughMasksEachForItself) {
    // Two masks before each other and a sheet behind, all of one colour over a triangle: what a sample sees
    // is what a supersample at its place does.
    Scene scene = sheets({{1, 0.2, 1, {1, 0, 0}}, {0.5, -0.3, 1, {0, 1, 0}}, {0, 0, 1, {0, 0, 1}}});
    addMask(scene, 0);
    addMask(scene, 1);
    scene.materials[0].alphaCutoff = 0.4f;
    scene.materials[1].alphaCutoff = 0.3f;
    scene.materials[2].alphaMode = AlphaMode::Opaque;
    for (const std::uint32_t size : {24u, 33u}) {
        RenderOptions options = raster(size);
        options.antialiasing = antialiasing("msaa8");
        const RenderResult multi = renderer().render(scene, options);
        EXPECT_EQ(counter(multi, "alpha_layers"), 3);
        options.antialiasing.kind = Antialiasing::Kind::Supersampling;
        const RenderResult super = renderer().render(scene, options);
        double worst = 0, mixed = 0;
        const auto ids = std::uint32_t(multi.image.channel("id.instance"));
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                for (std::uint32_t c = 0; c < 3; ++c)
                    worst = std::max(
                        worst, std::abs(double(multi.image.at(x, y, c)) - double(super.image.at(x, y, c))));
                mixed += multi.image.at(x, y, 0) > 0.05f && multi.image.at(x, y, 0) < 0.95f;
                EXPECT_EQ(multi.image.at(x, y, ids), super.image.at(x, y, ids));
            }
        EXPECT_LT(worst, 1e-6);
        EXPECT_GT(mixed, 0.05 * size * size);
        EXPECT_TRUE(std::ranges::none_of(multi.skipped, [](const auto& s) { return s.first == "blending"; }));
    }
}

TEST(ShadeAlpha, LightComesThroughMasksAsRaysFindIt) {
    constexpr std::uint32_t size = 40;
    const glm::dvec3 lamp(0.3, -0.2, 3);
    for (const auto type :
         {PunctualLight::Type::Point, PunctualLight::Type::Spot, PunctualLight::Type::Directional}) {
        // A floor at z = 0 under a mask at z = 1; the eye is between them.
        Scene scene = sheets({{0, 0, 1, glm::vec3(0.0f), AlphaMode::Opaque}, {1, 0, 1, glm::vec3(0.0f)}});
        scene.materials[0].baseColor = glm::vec4(1.0f);
        addMask(scene, 1);
        scene.nodes[2].translation = {0, 0, 0.5f};
        PunctualLight light;
        light.type = type;
        light.intensity = glm::vec3(10.0f);
        light.innerConeAngle = 0.7f;
        light.outerConeAngle = 0.8f;
        scene.lights = {light};
        Node node = lookAtNode("lamp", lamp, {0, 0, 0});
        node.light = 0;
        scene.nodes.push_back(node);
        scene.roots.push_back(3);
        RenderOptions options = raster(size);
        options.environment.reset();
        options.shadows = {Shadows::Kind::Hard, 512};
        const RenderResult maps = renderer().render(scene, options);
        EXPECT_TRUE(std::ranges::none_of(maps.skipped,
                                         [](const auto& s) { return s.first == "blending in shadows"; }));
        options.pipeline = Pipeline::Path;
        options.maxDepth = 1;
        options.samples = 4;
        const RenderResult rays = renderer().render(scene, options);
        int lit = 0, dark = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                const glm::dvec3 p(2 * (x + 0.5) / size - 1, 1 - 2 * (y + 0.5) / size, 0);
                const glm::dvec3 to = type == PunctualLight::Type::Directional ? lamp : lamp - p;
                const glm::dvec3 at = p + to / to.z;
                if (std::max(std::abs(at.x), std::abs(at.y)) > 0.95) continue;
                const double alpha = maskAlpha((at.x + 1) / 2, (1 - at.y) / 2);
                if (std::abs(alpha - 0.5) < 0.15) continue;
                const double value = double(maps.image.at(x, y, 0)), traced = double(rays.image.at(x, y, 0));
                ++(alpha < 0.5 ? lit : dark);
                EXPECT_EQ(value > 0, alpha < 0.5) << x << ", " << y;
                EXPECT_NEAR(value, traced, 0.02 * traced) << x << ", " << y;
            }
        EXPECT_GT(lit, 100);
        EXPECT_GT(dark, 100);
    }
}

TEST(ShadeAlpha, MoreLayersThanThereAreIsAWarning) {
    std::vector<Sheet> list(300, Sheet{0, 0, 0.001f, glm::vec3(1.0f)});  // one place: ids tell them apart
    const RenderResult result = renderer().render(sheets(list), raster(8));
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("64 pixels have more than 256 layers"), std::string::npos)
        << result.warnings[0];
    const double behind = std::pow(1 - double(0.001f), 256);
    EXPECT_NEAR(double(result.image.at(4, 4, 0)), 1 - behind, 2e-5);
}

/** A white floor under a ceiling of `across` x `across` glowing squares, every third of which shines 30 times
 * as much. */
Scene tiledCeiling(int across) {
    Scene scene;
    scene.name = "ceiling";
    Material floor;
    floor.baseColor = {1, 1, 1, 1};
    floor.metallic = 0;
    floor.specular = 0;
    Material dim = floor, bright = floor;
    dim.emission = glm::vec3(1.0f);
    bright.emission = glm::vec3(30.0f);
    scene.materials = {floor, dim, bright};
    const auto addSquare = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material) {
        Primitive p;
        p.positions = {corner, corner + u, corner + u + v, corner + v};
        p.indices = {0, 1, 2, 0, 2, 3};
        p.material = material;
        return p;
    };
    Mesh mesh;
    mesh.primitives.push_back(addSquare({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 0));
    const float side = 2.0f / float(across);
    for (int i = 0; i < across * across; ++i)
        mesh.primitives.push_back(addSquare({-1 + side * float(i % across), 1, -1 + side * float(i / across)},
                                            {side, 0, 0}, {0, 0, side}, i % 3 == 0 ? 2 : 1));
    scene.meshes = {mesh};
    Node node, eye;
    node.mesh = 0;
    Camera camera;
    camera.perspective = false;
    camera.ymag = 2;
    scene.cameras = {camera};
    eye.camera = 0;
    eye.translation = {0, 0.5f, 0};
    eye.rotation = glm::quat(std::sqrt(0.5f), -std::sqrt(0.5f), 0, 0);  // down
    scene.nodes = {node, eye};
    scene.roots = {0, 1};
    return scene;
}

TEST(ShadeDrawnLights, MeanAndSpreadAgainstAllLights) {
    const Scene scene = tiledCeiling(30);
    RenderOptions options = raster(48);
    options.environment.reset();
    options.lightSamples = 0;
    const RenderResult all = renderer().render(scene, options);
    options.lightSamples = 48;
    const RenderResult drawn = renderer().render(scene, options);
    EXPECT_EQ(renderer().render(scene, options).image.data, drawn.image.data);
    double sum = 0, squares = 0;
    const std::size_t pixels = 48 * 48;
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 48; ++x) {
            const double error = double(drawn.image.at(x, y, 0)) / double(all.image.at(x, y, 0)) - 1;
            sum += error;
            squares += error * error;
        }
    const double rms = std::sqrt(squares / double(pixels));
    std::printf("48 of 900 lights: mean error %.5f, RMS %.4f\n", sum / double(pixels), rms);
    EXPECT_LT(rms, 0.1);
    EXPECT_LT(std::abs(sum / double(pixels)), 4 * rms / std::sqrt(double(pixels)));
    EXPECT_TRUE(std::ranges::any_of(
        drawn.skipped, [](const auto& s) { return s.first == "light of every emissive surface"; }));
}

}  // namespace
}  // namespace helio
