#include "tests/unit/gltf_support.hpp"

#include <cmath>
#include <numbers>

namespace helio::test {
namespace {

/** What a scene's environment shows along a direction of its own, of the nearest texel. */
glm::vec3 along(const Scene& scene, const glm::dvec3& d) {
    const TextureImage& image = scene.images.at(std::size_t(scene.environment->image));
    const double u = 0.5 - std::atan2(d.x, d.z) / (2 * std::numbers::pi);
    const double v = std::acos(d.y / glm::length(d)) / std::numbers::pi;
    const auto column = std::min(std::size_t(u * image.width), std::size_t(image.width - 1)),
               row = std::min(std::size_t(v * image.height), std::size_t(image.height - 1));
    const float* const texel = &std::get<std::vector<float>>(image.texels)[(row * image.width + column) * 4];
    return {texel[0], texel[1], texel[2]};
}

class GltfEnvironment : public Gltf {
protected:
    /** A face of 8 x 8 texels of one colour, its left half as seen times 1/2 of the linear value. */
    std::string face(const glm::vec3& color) const {
        ImageF image;
        image.width = image.height = 8;
        image.channels = {"R", "G", "B"};
        for (int i = 0; i < 64; ++i) {
            for (int c = 0; c < 3; ++c) image.data.push_back(color[c] * (i % 8 < 4 ? 0.5f : 1.0f));
        }
        saveImage(folder_ / "face.png", image);
        std::ifstream in(folder_ / "face.png", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    GltfDocument withCube() const {
        GltfDocument file = GltfDocument::triangle();
        const glm::vec3 colors[] = {{1, 0, 0}, {0, 1, 1}, {0, 1, 0}, {1, 0, 1}, {0, 0, 1}, {1, 1, 0}};
        for (const glm::vec3& color : colors)
            file.doc["images"].push_back({{"uri", "data:image/png;base64," + base64(face(color))}});
        file.doc["extensionsUsed"] = file.doc["extensionsRequired"] = {"EXT_lights_image_based"};
        json& light = file.doc["extensions"]["EXT_lights_image_based"]["lights"][0];
        light = {{"intensity", 3},
                 {"rotation", {0, 0.6, 0, 0.8}},
                 {"specularImageSize", 8},
                 {"irradianceCoefficients", std::vector<std::vector<float>>(9, {0, 0, 0})}};
        light["specularImages"] = json::array({{0, 1, 2, 3, 4, 5}});
        file.doc["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
        return file;
    }
};

TEST_F(GltfEnvironment, CubeMapsBecomeLatLongImages) {
    const Scene scene = load(withCube());
    EXPECT_NO_THROW(scene.validate());
    EXPECT_TRUE(scene.skipped.empty());
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->radiance, glm::vec3(3));
    EXPECT_FLOAT_EQ(scene.environment->rotation.y, 0.6f);
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 32u);
    EXPECT_EQ(scene.images[0].height, 16u);
    struct Face {
        glm::dvec3 forward, right;  ///< as seen from inside, upright
        glm::vec3 color;
    };
    const Face faces[] = {
        {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, 1, 1}},
        {{0, 1, 0}, {-1, 0, 0}, {0, 1, 0}}, {{0, -1, 0}, {-1, 0, 0}, {1, 0, 1}},
        {{0, 0, 1}, {-1, 0, 0}, {0, 0, 1}}, {{0, 0, -1}, {1, 0, 0}, {1, 1, 0}},
    };
    for (const Face& face : faces) {
        for (double s : {-0.6, 0.6}) {
            const glm::vec3 shown = along(scene, face.forward + s * face.right);
            const glm::vec3 expected = face.color * (s < 0 ? 0.5f : 1.0f);
            EXPECT_LT(glm::distance(shown, expected), 0.006f)
                << glm::dot(face.forward, glm::dvec3(1, 2, 3)) << " " << s;
        }
    }
}

TEST_F(GltfEnvironment, LargeFacesOfOneColorAreFacesToo) {
    constexpr std::uint32_t size = 520;  // above 512 images of one colour become one texel
    GltfDocument file = withCube();
    const std::string black = base64(png(0, 0, 0, size));
    ImageF image;
    image.width = image.height = size;
    image.channels = {"R", "G", "B"};
    for (std::uint32_t i = 0; i < size * size; ++i)
        image.data.insert(image.data.end(), 3, i < size ? 0.0f : 1.0f);
    saveImage(folder_ / "top.png", image);
    for (std::size_t f = 0; f < 6; ++f) file.doc["images"][f]["uri"] = "data:image/png;base64," + black;
    file.doc["images"][2] = {{"uri", "top.png"}};
    const Scene scene = load(file);
    EXPECT_EQ(scene.images.at(0).width, 4 * size);
    EXPECT_EQ(along(scene, {0.1, 1, 0.1}), glm::vec3(1));
    EXPECT_EQ(along(scene, {1, 0.1, 0.1}), glm::vec3(0));
    file.doc["images"][4]["uri"] = "data:image/png;base64," + base64(png(0, 0, 0, size + 8));
    EXPECT_THROW(load(file), InputError) << "of another size";
}

TEST_F(GltfEnvironment, MaterialsKeepTheirImages) {
    GltfDocument file = withCube();
    file.primitive()["material"] = 0;
    file.doc["textures"] = {{{"source", 4}}};
    file.doc["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    const Scene scene = load(file);
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.textures.at(0).image, 0);
    EXPECT_EQ(scene.environment->image, 1);
    EXPECT_EQ(scene.images[0].width, 8u);
}

TEST_F(GltfEnvironment, BrokenLightsAreRefused) {
    const auto expectRefused = [&](const char* pointer, const json& value, const char* place) {
        GltfDocument file = withCube();
        file.doc[json::json_pointer(pointer)] = value;
        if (std::string(place).find("[0][3]") != std::string::npos) {
            file.doc["images"].push_back({{"uri", "data:image/png;base64," + base64(png(1, 1, 1, 4))}});
        }
        try {
            load(file);
            ADD_FAILURE() << pointer << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(error.place.find(place), std::string::npos) << error.what();
        }
    };
    expectRefused("/extensions/EXT_lights_image_based/lights/0/specularImages/0/3", 99,
                  "specularImages[0][3]");
    expectRefused("/extensions/EXT_lights_image_based/lights/0/specularImages/0/3", 6,
                  "specularImages[0][3]");
    expectRefused("/extensions/EXT_lights_image_based/lights/0/specularImages", json::array(),
                  "specularImages");
    expectRefused("/extensions/EXT_lights_image_based/lights/0/intensity", -1, "intensity");
    expectRefused("/scenes/0/extensions/EXT_lights_image_based/light", 1, "light");
}

}  // namespace
}  // namespace helio::test
