// The conventions of geometry and radiometry, each from a glTF file to the pixels of both pipelines.
#include "tests/support/renderer.hpp"
#include "tests/unit/gltf_support.hpp"

#include <numbers>

namespace helio::test {
namespace {

constexpr Pipeline kBoth[] = {Pipeline::Path, Pipeline::Raster};
constexpr double pi = std::numbers::pi;

class Conventions : public Gltf {
protected:
    /** A square of 2 x 2 around (0, 0, -2), its front to the viewer at the origin, Lambertian with base
     * colour 0.5; node 0, with a camera in node 1 that sees 90 degrees. */
    static GltfDocument square() {
        GltfDocument file;
        file.addAccessor<float>({-1, -1, -2, 1, -1, -2, 1, 1, -2, -1, 1, -2}, "VEC3", 4);
        file.addAccessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 4);
        file.addAccessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 6);
        file.doc["meshes"] = json::parse(
            R"([{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}])");
        file.doc["materials"] = json::parse(
            R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0},
                 "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}])");
        file.doc["cameras"] =
            json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1.5707963, "znear": 0.1}}])");
        file.doc["nodes"] = json::parse(R"([{"mesh": 0}, {"camera": 0}])");
        file.doc["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
        return file;
    }
    static void turnCamera(GltfDocument& file) {  // to the square's back
        file.doc["nodes"][1] = {{"camera", 0}, {"rotation", {0, 1, 0, 0}}, {"translation", {0, 0, -4}}};
    }
    static void addLight(GltfDocument& file, const json& light, const json& node) {
        file.doc["extensions"]["KHR_lights_punctual"]["lights"].push_back(light);
        json placed = node;
        placed["extensions"]["KHR_lights_punctual"]["light"] =
            file.doc["extensions"]["KHR_lights_punctual"]["lights"].size() - 1;
        file.doc["scenes"][0]["nodes"].push_back(file.doc["nodes"].size());
        file.doc["nodes"].push_back(placed);
    }

    ImageF render(const GltfDocument& file, Pipeline pipeline, std::uint32_t width = 9,
                  std::uint32_t height = 9, bool cull = false) const {
        RenderOptions options;
        options.pipeline = pipeline;
        options.size = {width, height};
        options.samples = 4;
        options.cullBackFaces = cull;
        options.environment = Environment{};
        if (pipeline == Pipeline::Path) options.maxDepth = 1;
        return renderer().render(load(file), options).image;
    }
    static float at(const ImageF& image, std::uint32_t x, std::uint32_t y, const std::string& channel = "R") {
        const auto found = std::ranges::find(image.channels, channel);
        EXPECT_NE(found, image.channels.end()) << channel;
        const auto index = std::size_t(found - image.channels.begin());
        return image.data.at((std::size_t(y) * image.width + x) * image.channels.size() + index);
    }
};

TEST_F(Conventions, EmissionIsFactorTimesStrengthFromTheFrontFaceAlone) {
    for (const Pipeline pipeline : kBoth) {
        for (bool isBehind : {false, true}) {
            for (bool isDoubleSided : {false, true}) {
                GltfDocument file = square();
                file.doc["materials"][0]["emissiveFactor"] = {0.5, 0.25, 0.125};
                file.doc["materials"][0]["extensions"]["KHR_materials_emissive_strength"]
                        ["emissiveStrength"] = 8;
                file.doc["materials"][0]["doubleSided"] = isDoubleSided;
                if (isBehind) turnCamera(file);
                const ImageF image = render(file, pipeline);
                const float shown = isBehind && !isDoubleSided ? 0.0f : 1.0f;
                EXPECT_EQ(at(image, 4, 4, "R"), 4 * shown) << isBehind << isDoubleSided;
                EXPECT_EQ(at(image, 4, 4, "G"), 2 * shown) << isBehind << isDoubleSided;
                EXPECT_EQ(at(image, 4, 4, "B"), 1 * shown) << isBehind << isDoubleSided;
            }
        }
    }
}

// Within what a pixel of 1/99 of the view covers.
TEST_F(Conventions, PunctualLightsAreInWattsPerSteradianAndPerSquareMetre) {
    struct Case {
        json light, node;
        double irradiance;  ///< at the square's middle
    };
    const double tilted = std::cos(pi / 6);
    const Case cases[] = {
        {{{"type", "point"}, {"intensity", 12}}, json::object(), 12.0 / 4},
        {{{"type", "point"}, {"intensity", 12}}, {{"translation", {0, 2, 0}}}, 12.0 / 8 * std::sqrt(0.5)},
        {{{"type", "spot"}, {"intensity", 12}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.4}}}},
         json::object(),
         12.0 / 4},
        {{{"type", "spot"}, {"intensity", 12}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.4}}}},
         {{"rotation", {0, std::sin(0.25), 0, std::cos(0.25)}}},  // turned by 0.5: outside
         0},
        {{{"type", "directional"}, {"intensity", 5}}, json::object(), 5},
        {{{"type", "directional"}, {"intensity", 5}},
         {{"rotation", {std::sin(pi / 12), 0, 0, std::cos(pi / 12)}}},  // 30 degrees
         5 * tilted},
    };
    for (const Pipeline pipeline : kBoth) {
        for (const Case& c : cases) {
            GltfDocument file = square();
            addLight(file, c.light, c.node);
            const double expected = 0.5 / pi * c.irradiance;
            EXPECT_NEAR(at(render(file, pipeline, 99, 99), 49, 49), expected, 6e-3 * expected + 1e-7)
                << c.light.dump() << c.node.dump();
        }
    }
}

TEST_F(Conventions, EverySurfaceScattersOnBothFacesUnlessTheBackIsCulled) {
    for (const Pipeline pipeline : kBoth) {
        GltfDocument file = square();
        turnCamera(file);
        addLight(file, {{"type", "directional"}, {"intensity", 2}}, {{"rotation", {0, 1, 0, 0}}});
        EXPECT_NEAR(at(render(file, pipeline), 4, 4), 1 / pi, 1e-5);
    }
    GltfDocument file = square();
    EXPECT_EQ(at(render(file, Pipeline::Raster, 9, 9, true), 4, 4, "id.instance"), 0);
    turnCamera(file);
    EXPECT_EQ(at(render(file, Pipeline::Raster, 9, 9, true), 4, 4, "id.instance"), -1)
        << "counter-clockwise is the front";
}

TEST_F(Conventions, AMeshWithoutNormalsIsFlat) {
    for (const Pipeline pipeline : kBoth) {
        const ImageF image = render(square(), pipeline);
        for (std::uint32_t x = 3; x < 6; ++x) {
            EXPECT_EQ(at(image, x, 4, "normal.X"), 0);
            EXPECT_EQ(at(image, x, 4, "normal.Z"), 1);
        }
    }
}

TEST_F(Conventions, CamerasLookAlongMinusZWithYUpAndDepthIsAlongTheView) {
    for (const Pipeline pipeline : kBoth) {
        GltfDocument file = square();
        // Moved to the right and up, it fills the right upper quarter of 90 degrees.
        file.doc["nodes"][0]["translation"] = {1, 1, 0};
        const ImageF image = render(file, pipeline, 8, 8);
        for (std::uint32_t y = 0; y < 8; ++y) {
            for (std::uint32_t x = 0; x < 8; ++x) {
                const bool isHit = x >= 4 && y < 4;
                EXPECT_EQ(at(image, x, y, "id.instance"), isHit ? 0 : -1) << x << " " << y;
                EXPECT_EQ(at(image, x, y, "id.triangle") < 0, !isHit);
                EXPECT_NEAR(at(image, x, y, "depth.Z"), isHit ? 2 : 0, 1e-5) << x << " " << y;
            }
        }
    }
}

TEST_F(Conventions, SizeKeepsTheVerticalFieldOfView) {
    for (const Pipeline pipeline : kBoth) {
        for (const auto& [width, height] : {std::pair{8u, 8u}, {16u, 8u}, {4u, 8u}, {8u, 16u}}) {
            // At distance 2 the square is half of the 90 degrees high: half of the rows, as many columns.
            const ImageF image = render(square(), pipeline, width, height);
            std::uint32_t rows = 0, columns = 0;
            for (std::uint32_t y = 0; y < height; ++y) rows += at(image, width / 2, y, "id.instance") == 0;
            for (std::uint32_t x = 0; x < width; ++x) columns += at(image, x, height / 2, "id.instance") == 0;
            EXPECT_EQ(rows, height / 2);
            EXPECT_EQ(columns, std::min(width, height / 2));
        }
    }
}

TEST_F(Conventions, TexturesStartAtTheirTopLeftAndAreDecodedFromSrgb) {
    // 2 x 2 texels: black but for the top left, sRGB 188 (0.5 linear within rounding).
    ImageF texture;
    texture.width = texture.height = 2;
    texture.channels = {"R", "G", "B"};
    texture.data.assign(12, 0.0f);
    texture.data[0] = 0.5f;
    saveImage(folder_ / "corner.png", texture);
    for (const Pipeline pipeline : kBoth) {
        GltfDocument file = square();
        file.doc["images"] = {{{"uri", "corner.png"}}};
        file.doc["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
        file.doc["textures"] = {{{"source", 0}, {"sampler", 0}}};
        file.doc["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}},
                                                            {"metallicFactor", 0}};
        addLight(file, {{"type", "directional"}, {"intensity", 2 * pi}}, json::object());
        const ImageF image = render(file, pipeline, 8, 8);
        EXPECT_NEAR(at(image, 3, 3), 1, 0.01) << "the square's left upper quarter";
        EXPECT_EQ(at(image, 4, 3), 0);
        EXPECT_EQ(at(image, 3, 4), 0);
        EXPECT_EQ(at(image, 4, 4), 0);
    }
}

TEST_F(Conventions, VertexColoursAreLinearAndMultiplyTheBaseColour) {
    for (const Pipeline pipeline : kBoth) {
        GltfDocument file = square();
        file.primitive()["attributes"]["COLOR_0"] = file.addAccessor(
            std::vector<float>{0.5f, 0.25f, 1, 0.5f, 0.25f, 1, 0.5f, 0.25f, 1, 0.5f, 0.25f, 1}, "VEC3", 4);
        addLight(file, {{"type", "directional"}, {"intensity", 2 * pi}}, json::object());
        const ImageF image = render(file, pipeline);
        EXPECT_NEAR(at(image, 4, 4, "R"), 0.5, 1e-5);
        EXPECT_NEAR(at(image, 4, 4, "G"), 0.25, 1e-5);
        EXPECT_NEAR(at(image, 4, 4, "B"), 1, 1e-5);
    }
}

}  // namespace
}  // namespace helio::test
