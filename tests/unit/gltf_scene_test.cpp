#include "tests/unit/gltf_support.hpp"

#include <cmath>

namespace helio::test {
namespace {

TEST_F(Gltf, BuildsTheHierarchy) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["nodes"] = json::parse(R"([
        {"name": "root", "children": [1, 2], "translation": [1, 2, 3]},
        {"name": "turned", "mesh": 0, "rotation": [0, 0, 0.7071068, 0.7071068], "scale": [2, 2, 2]},
        {"name": "matrix", "mesh": 0.0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]},
        {"name": "elsewhere", "mesh": 0}
    ])");
    const Scene scene = load(file);
    const auto placed = scene.instances();
    ASSERT_EQ(placed.size(), 2u);
    const glm::dvec3 tip(placed[0].transform * glm::dvec4(1, 0, 0, 1));
    EXPECT_NEAR(glm::distance(tip, glm::dvec3(1, 4, 3)), 0, 1e-6);
    EXPECT_EQ(glm::dvec3(placed[1].transform[3]), glm::dvec3(6, 2, 3));
    EXPECT_EQ(scene.nodes[0].name, "root");
}

TEST_F(Gltf, ShowsTheRightScene) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"name", "second"}}};
    file.doc["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.doc["scene"] = 1;
    const Scene second = load(file);
    EXPECT_EQ(second.roots, std::vector<int>{1});
    EXPECT_EQ(second.skipped.size(), 1u);
    file.doc.erase("scene");
    EXPECT_EQ(load(file).roots, std::vector<int>{0});
    file.doc.erase("scenes");
    EXPECT_EQ(load(file).roots, (std::vector<int>{0, 1}));
}

TEST_F(Gltf, ReadsCameras) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["cameras"] = json::parse(R"([
        {"type": "perspective", "name": "wide", "perspective": {"yfov": 1.2, "znear": 0.1, "aspectRatio": 1.5}},
        {"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0, "zfar": 10}}])");
    file.doc["nodes"].push_back({{"camera", 1}});
    file.doc["nodes"].push_back({{"camera", 0}});
    file.doc["scenes"][0]["nodes"] = {0, 1, 2};
    Scene scene = load(file);
    EXPECT_TRUE(scene.cameras[0].perspective);
    EXPECT_FLOAT_EQ(scene.cameras[0].yfov, 1.2f);
    EXPECT_FLOAT_EQ(scene.cameras[0].aspectRatio, 1.5f);
    EXPECT_TRUE(std::isinf(scene.cameras[0].zfar));
    EXPECT_FALSE(scene.cameras[1].perspective);
    EXPECT_FLOAT_EQ(scene.cameras[1].ymag, 2);
    EXPECT_FLOAT_EQ(scene.cameras[1].aspectRatio, 2);
    EXPECT_EQ(chooseCamera(scene, "").camera, 1);
    EXPECT_EQ(chooseCamera(scene, "wide").camera, 0);
}

TEST_F(Gltf, ReadsPunctualLights) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["extensionsUsed"] = {"KHR_lights_punctual"};
    file.doc["extensionsRequired"] = {"KHR_lights_punctual"};
    file.doc["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
        {"type": "point", "color": [1, 0.5, 0.25], "intensity": 8, "range": 3},
        {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.3}},
        {"type": "directional", "name": "sun"}])");
    for (int i : {0, 1, 2}) {
        file.doc["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
        file.doc["scenes"][0]["nodes"].push_back(i + 1);
    }
    const Scene scene = load(file);
    ASSERT_EQ(scene.placedLights().size(), 3u);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(8, 4, 2));
    EXPECT_EQ(scene.lights[0].range, 3);
    EXPECT_EQ(scene.lights[1].type, PunctualLight::Type::Spot);
    EXPECT_FLOAT_EQ(scene.lights[1].outerConeAngle, 0.3f);
    EXPECT_EQ(scene.lights[2].type, PunctualLight::Type::Directional);
    EXPECT_EQ(scene.lights[2].intensity, glm::vec3(1));
    EXPECT_TRUE(scene.skipped.empty());
}

TEST_F(Gltf, ReadsMaterials) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 1;
    file.doc["materials"] = json::parse(R"([{}, {
        "name": "all", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0},
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 10},
            "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_specular": {"specularFactor": 0.25, "specularColorFactor": [1, 2, 3]},
            "KHR_materials_unlit": {},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}}}])");
    const Scene scene = load(file);
    const Material& plain = scene.materials[0];
    EXPECT_EQ(plain.baseColor, glm::vec4(1));
    EXPECT_EQ(plain.metallic, 1);
    EXPECT_EQ(plain.roughness, 1);
    EXPECT_EQ(plain.emission, glm::vec3(0));
    EXPECT_EQ(plain.specular, 1);
    EXPECT_EQ(plain.ior, 1.5f);
    const Material& all = scene.materials[1];
    EXPECT_EQ(scene.meshes[0].primitives[0].material, 1);
    EXPECT_EQ(all.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(all.metallic, 0.5f);
    EXPECT_EQ(all.roughness, 0);
    EXPECT_EQ(all.emission, glm::vec3(10, 5, 0));
    EXPECT_EQ(all.specular, 0.25f);
    EXPECT_EQ(all.specularColor, glm::vec3(1, 2, 3));
    EXPECT_EQ(all.ior, 1.33f);
    EXPECT_EQ(all.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(all.alphaCutoff, 0.25f);
    EXPECT_TRUE(all.doubleSided);
    EXPECT_TRUE(all.unlit);
    EXPECT_EQ(all.unsupported, std::vector<std::string>{"KHR_materials_diffuse_transmission"});
}

TEST_F(Gltf, BringsFactorsIntoTheirRangeWithAWarning) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 1.5}, {"roughnessFactor", -1}}}}};
    const Scene scene = load(file);
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_EQ(scene.materials[0].roughness, 0);
    EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST_F(Gltf, LoadsTexturesFromFilesDataAndBufferViewsOnceEach) {
    const std::string red = png(1, 0, 0), green = png(0, 1, 0);
    write("red file.png", red);
    write("copy.png", red);
    write("broken.png", "never decoded, since nothing uses it");
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 0;
    file.doc["images"] = {{{"uri", "red%20file.png"}},
                          {{"uri", "data:image/png;base64," + base64(green)}},
                          {{"bufferView", file.addView(green)}, {"mimeType", "image/png"}},
                          {{"uri", "./copy.png"}},
                          {{"uri", "broken.png"}}};
    file.doc["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9728}}};
    file.doc["textures"] = {
        {{"source", 0}}, {{"source", 1}, {"sampler", 0}}, {{"source", 2}}, {{"source", 3}}, {{"source", 4}}};
    file.doc["materials"] = json::parse(R"([
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1, "texCoord": 1}},
         "normalTexture": {"index": 2, "scale": 0.5}, "occlusionTexture": {"index": 3, "strength": 0.25},
         "emissiveTexture": {"index": 0},
         "extensions": {"KHR_materials_specular": {"specularTexture": {"index": 1}, "specularColorTexture": {"index": 0}}}},
        {"emissiveTexture": {"index": 4}}])");
    const Scene scene = load(file);
    ASSERT_EQ(scene.images.size(), 2u) << "identical images are one";
    EXPECT_EQ(scene.images[0].name, "red%20file.png");
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(scene.images[0].texels),
              (std::vector<std::uint8_t>{255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255}));
    const Material& material = scene.materials[0];
    const auto imageOf = [&](const TextureUse& use) {
        return scene.textures[std::size_t(use.texture)].image;
    };
    EXPECT_EQ(imageOf(material.baseColorTexture), 0);
    EXPECT_EQ(imageOf(material.metallicRoughnessTexture), 1);
    EXPECT_EQ(material.metallicRoughnessTexture.texcoord, 1);
    EXPECT_EQ(imageOf(material.normalTexture), 1);
    EXPECT_EQ(material.normalScale, 0.5f);
    EXPECT_EQ(imageOf(material.occlusionTexture), 0);
    EXPECT_EQ(material.occlusionStrength, 0.25f);
    EXPECT_EQ(material.emissiveTexture.texture, material.baseColorTexture.texture);
    EXPECT_EQ(imageOf(material.specularTexture), 1);
    EXPECT_EQ(imageOf(material.specularColorTexture), 0);
    const Texture& texture = scene.textures[std::size_t(material.metallicRoughnessTexture.texture)];
    EXPECT_EQ(texture.wrapU, Wrap::ClampToEdge);
    EXPECT_EQ(texture.wrapV, Wrap::MirroredRepeat);
    EXPECT_EQ(texture.magFilter, Filter::Nearest);
    EXPECT_FALSE(texture.useMipmaps);
    EXPECT_TRUE(scene.textures[std::size_t(material.baseColorTexture.texture)].useMipmaps);
    EXPECT_FALSE(scene.materials[1].emissiveTexture);
}

TEST_F(Gltf, AppliesTextureTransforms) {
    write("a.png", png(1, 1, 1));
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 0;
    file.doc["images"] = {{{"uri", "a.png"}}};
    file.doc["textures"] = {{{"source", 0}}};
    // The extension's own example: "only the lower left quadrant of the source image, rotated clockwise 90
    // degrees".
    file.doc["materials"] =
        json::parse(R"([{"emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5], "texCoord": 2}}}}])");
    const Scene scene = load(file);
    const TextureUse& use = scene.materials[0].emissiveTexture;
    EXPECT_EQ(use.texcoord, 2);
    for (float u : {0.0f, 1.0f}) {
        for (float v : {0.0f, 1.0f}) {
            const glm::vec3 to = use.transform * glm::vec3(u, v, 1);
            EXPECT_NEAR(to.x, 0.5f * v, 1e-6);
            EXPECT_NEAR(to.y, 1 - 0.5f * u, 1e-6);
        }
    }
}

TEST_F(Gltf, NamesTexturesThatHaveNoImage) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 0;
    file.doc["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    file.doc["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    const Scene scene = load(file);
    EXPECT_FALSE(scene.materials[0].emissiveTexture);
    EXPECT_EQ(scene.materials[0].unsupported, std::vector<std::string>{"KHR_texture_basisu"});
    EXPECT_EQ(scene.skipped.size(), 1u);
}

}  // namespace
}  // namespace helio::test
