#include "tests/unit/gltf/corpus.hpp"

namespace helio::test {
namespace {

/** A triangle with coordinates and a material that has one extension; textures 0 of the four texels. */
GltfDocument withExtension(const std::string& name, const char* content) {
    GltfDocument file = boundedTriangle();
    file.primitive()["material"] = 0;
    json& attributes = file.primitive()["attributes"];
    attributes["NORMAL"] = addVertices<float>(file, {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    attributes["TANGENT"] = addVertices<float>(file, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    attributes["TEXCOORD_0"] = attributes["TEXCOORD_1"] = addVertices<float>(file, {0, 0, 1, 0, 0, 1}, 2);
    file.doc["images"] =
        json::array({{{"bufferView", file.addView(pngOfFourTexels())}, {"mimeType", "image/png"}}});
    file.doc["textures"] = json::array({{{"source", 0}}});
    file.doc["materials"] = json::array({{{"extensions", {{name, json::parse(content)}}}}});
    use(file, name);
    return file;
}

void expectTexture(const Scene& scene, const TextureUse& use) {
    ASSERT_TRUE(bool(use));
    const Texture& texture = scene.textures.at(std::size_t(use.texture));
    const TextureImage& image = scene.images.at(std::size_t(texture.image));
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.texels), fourTexels());
}

void addMaterials(std::vector<CorpusFile>& files) {
    const auto add = [&](const char* name, const char* content,
                         std::function<void(const Scene&, const Material&)> check) {
        files.push_back({name, withExtension(name, content),
                         [check](const Scene& scene) { check(scene, scene.materials.at(0)); }});
    };
    add("KHR_materials_anisotropy",
        R"({"anisotropyStrength": 0.5, "anisotropyRotation": 1.5, "anisotropyTexture": {"index": 0}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.anisotropyStrength, 0.5f);
            EXPECT_EQ(m.anisotropyRotation, 1.5f);
            expectTexture(scene, m.anisotropyTexture);
        });
    add("KHR_materials_clearcoat",
        R"({"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0}, "clearcoatRoughnessFactor": 0.25,
            "clearcoatRoughnessTexture": {"index": 0}, "clearcoatNormalTexture": {"index": 0, "scale": 0.75}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.clearcoat, 0.5f);
            EXPECT_EQ(m.clearcoatRoughness, 0.25f);
            EXPECT_EQ(m.clearcoatNormalScale, 0.75f);
            expectTexture(scene, m.clearcoatTexture);
            expectTexture(scene, m.clearcoatRoughnessTexture);
            expectTexture(scene, m.clearcoatNormalTexture);
        });
    add("KHR_materials_emissive_strength", R"({"emissiveStrength": 7})",
        [](const Scene&, const Material& m) { EXPECT_EQ(m.emission, glm::vec3(0)); });
    files.back().document.doc["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
    files.back().check = [](const Scene& scene) {
        EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(7, 3.5f, 0));
    };
    add("KHR_materials_ior", R"({"ior": 1.75})",
        [](const Scene&, const Material& m) { EXPECT_EQ(m.ior, 1.75f); });
    add("KHR_materials_iridescence",
        R"({"iridescenceFactor": 0.5, "iridescenceTexture": {"index": 0}, "iridescenceIor": 1.75,
            "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 800,
            "iridescenceThicknessTexture": {"index": 0}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.iridescence, 0.5f);
            EXPECT_EQ(m.iridescenceIor, 1.75f);
            EXPECT_EQ(m.iridescenceThicknessMinimum, 200);
            EXPECT_EQ(m.iridescenceThicknessMaximum, 800);
            expectTexture(scene, m.iridescenceTexture);
            expectTexture(scene, m.iridescenceThicknessTexture);
        });
    add("KHR_materials_sheen",
        R"({"sheenColorFactor": [0.1, 0.2, 0.3], "sheenColorTexture": {"index": 0}, "sheenRoughnessFactor": 0.5,
            "sheenRoughnessTexture": {"index": 0}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.sheenColor, glm::vec3(0.1f, 0.2f, 0.3f));
            EXPECT_EQ(m.sheenRoughness, 0.5f);
            expectTexture(scene, m.sheenColorTexture);
            expectTexture(scene, m.sheenRoughnessTexture);
        });
    add("KHR_materials_specular",
        R"({"specularFactor": 0.5, "specularTexture": {"index": 0}, "specularColorFactor": [1, 2, 3],
            "specularColorTexture": {"index": 0}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.specular, 0.5f);
            EXPECT_EQ(m.specularColor, glm::vec3(1, 2, 3));
            expectTexture(scene, m.specularTexture);
            expectTexture(scene, m.specularColorTexture);
        });
    add("KHR_materials_transmission", R"({"transmissionFactor": 0.5, "transmissionTexture": {"index": 0}})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.transmission, 0.5f);
            expectTexture(scene, m.transmissionTexture);
        });
    add("KHR_materials_unlit", "{}", [](const Scene&, const Material& m) { EXPECT_TRUE(m.unlit); });
    add("KHR_materials_volume",
        R"({"thicknessFactor": 2, "thicknessTexture": {"index": 0}, "attenuationDistance": 3,
            "attenuationColor": [0.25, 0.5, 0.75]})",
        [](const Scene& scene, const Material& m) {
            EXPECT_EQ(m.thickness, 2);
            EXPECT_EQ(m.attenuationDistance, 3);
            EXPECT_EQ(m.attenuationColor, glm::vec3(0.25f, 0.5f, 0.75f));
            expectTexture(scene, m.thicknessTexture);
        });
    // The validator wants transmission beside a volume, and a volume beside dispersion.
    json& volume = files.back().document.doc["materials"][0]["extensions"];
    volume["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    use(files.back().document, "KHR_materials_transmission");
    add("KHR_materials_dispersion", R"({"dispersion": 0.25})",
        [](const Scene&, const Material& m) { EXPECT_EQ(m.dispersion, 0.25f); });
    json& dispersion = files.back().document.doc["materials"][0]["extensions"];
    dispersion["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    dispersion["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    use(files.back().document, "KHR_materials_volume");
    use(files.back().document, "KHR_materials_transmission");
}

void addTextures(std::vector<CorpusFile>& files) {
    GltfDocument transform = withExtension("KHR_materials_unlit", "{}");
    use(transform, "KHR_texture_transform", true);
    transform.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json::parse(
        R"({"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
            {"offset": [0.5, 0.25], "rotation": 0, "scale": [2, 4], "texCoord": 0}}})");
    files.push_back({"KHR_texture_transform", transform, [](const Scene& scene) {
                         const TextureUse& use = scene.materials.at(0).baseColorTexture;
                         expectTexture(scene, use);
                         EXPECT_EQ(use.texcoord, 0);
                         EXPECT_EQ(use.transform * glm::vec3(1, 1, 1), glm::vec3(2.5f, 4.25f, 1));
                     }});

    GltfDocument fromWebp = withExtension("KHR_materials_unlit", "{}");
    use(fromWebp, "EXT_texture_webp", true);
    fromWebp.doc["images"][0] = {{"bufferView", fromWebp.addView(webpOfFourTexels())},
                                 {"mimeType", "image/webp"}};
    fromWebp.doc["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
    fromWebp.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    files.push_back({"EXT_texture_webp", fromWebp, [](const Scene& scene) {
                         expectTexture(scene, scene.materials.at(0).baseColorTexture);
                     }});

    // Every pair of wrapping modes under every filter, a texture each.
    GltfDocument samplers = withExtension("KHR_materials_unlit", "{}");
    samplers.doc["textures"] = json::array();
    samplers.doc["materials"] = json::array();
    samplers.doc["meshes"][0]["primitives"] = json::array();
    std::vector<Texture> expected;
    const std::pair<int, Wrap> wraps[] = {
        {10497, Wrap::Repeat}, {33648, Wrap::MirroredRepeat}, {33071, Wrap::ClampToEdge}};
    for (int minFilter : {9728, 9729, 9984, 9985, 9986, 9987}) {
        for (int magFilter : {9728, 9729}) {
            for (const auto& [wrapS, u] : wraps) {
                for (const auto& [wrapT, v] : wraps) {
                    const std::size_t index = expected.size();
                    Texture texture;
                    texture.wrapU = u, texture.wrapV = v;
                    texture.magFilter = magFilter == 9728 ? Filter::Nearest : Filter::Linear;
                    // 9984 NEAREST_MIPMAP_NEAREST, 9985 LINEAR_MIPMAP_NEAREST, 9986 NEAREST_MIPMAP_LINEAR
                    texture.minFilter = minFilter % 2 == 0 ? Filter::Nearest : Filter::Linear;
                    texture.useMipmaps = minFilter > 9729;
                    expected.push_back(texture);
                    samplers.doc["samplers"].push_back({{"minFilter", minFilter},
                                                        {"magFilter", magFilter},
                                                        {"wrapS", wrapS},
                                                        {"wrapT", wrapT}});
                    samplers.doc["textures"].push_back({{"source", 0}, {"sampler", index}});
                    samplers.doc["materials"].push_back(
                        {{"extensions", {{"KHR_materials_unlit", json::object()}}},
                         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", index}}}}}});
                    samplers.doc["meshes"][0]["primitives"].push_back(
                        {{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 3}}}, {"material", index}});
                }
            }
        }
    }
    files.push_back({"samplers", samplers, [expected](const Scene& scene) {
                         ASSERT_EQ(scene.materials.size(), expected.size());
                         EXPECT_EQ(scene.images.size(), 1u);
                         for (std::size_t i = 0; i < expected.size(); ++i) {
                             const TextureUse& use = scene.materials[i].baseColorTexture;
                             const Texture& texture = scene.textures.at(std::size_t(use.texture));
                             EXPECT_EQ(texture.wrapU, expected[i].wrapU) << i;
                             EXPECT_EQ(texture.wrapV, expected[i].wrapV) << i;
                             EXPECT_EQ(texture.magFilter, expected[i].magFilter) << i;
                             EXPECT_EQ(texture.minFilter, expected[i].minFilter) << i;
                             EXPECT_EQ(texture.useMipmaps, expected[i].useMipmaps) << i;
                         }
                     }});
}

void addOthers(std::vector<CorpusFile>& files) {
    GltfDocument variants = boundedTriangle();
    use(variants, "KHR_materials_variants");
    variants.doc["extensions"]["KHR_materials_variants"]["variants"] =
        json::parse(R"([{"name": "day"}, {"name": "night"}])");
    variants.doc["materials"] = json::parse(R"([{"name": "a"}, {"name": "b"}])");
    variants.primitive()["material"] = 0;
    variants.primitive()["extensions"]["KHR_materials_variants"]["mappings"] =
        json::parse(R"([{"material": 1, "variants": [1]}])");
    files.push_back({"KHR_materials_variants", variants, [](const Scene& scene) {
                         EXPECT_EQ(scene.variants, (std::vector<std::string>{"day", "night"}));
                         EXPECT_EQ(firstPrimitive(scene).variantMaterials, (std::vector<int>{0, 1}));
                     }});

    GltfDocument lights = boundedTriangle();
    use(lights, "KHR_lights_punctual", true);
    lights.doc["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(
        R"([{"type": "point", "color": [1, 0.5, 0.25], "intensity": 8, "range": 3},
            {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.3}}, {"type": "directional"}])");
    for (int i : {0, 1, 2}) {
        lights.doc["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
        lights.doc["scenes"][0]["nodes"].push_back(i + 1);
    }
    files.push_back({"KHR_lights_punctual", lights, [](const Scene& scene) {
                         ASSERT_EQ(scene.placedLights().size(), 3u);
                         EXPECT_EQ(scene.lights[0].intensity, glm::vec3(8, 4, 2));
                         EXPECT_EQ(scene.lights[1].type, PunctualLight::Type::Spot);
                         EXPECT_EQ(scene.lights[2].type, PunctualLight::Type::Directional);
                     }});

    GltfDocument copies = boundedTriangle();
    use(copies, "EXT_mesh_gpu_instancing", true);
    const int translation = copies.addAccessor<float>({0, 0, 0, 1, 2, 3}, "VEC3", 2);
    const int rotation = copies.addAccessor<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", 2, true);
    const int scale = copies.addAccessor<float>({1, 1, 1, 2, 2, 2}, "VEC3", 2);
    copies.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
    files.push_back({"EXT_mesh_gpu_instancing", copies, [](const Scene& scene) {
                         const auto placed = scene.instances();
                         ASSERT_EQ(placed.size(), 2u);
                         const glm::dvec3 tip(placed[1].transform * glm::dvec4(1, 0, 0, 1));
                         EXPECT_LT(glm::distance(tip, glm::dvec3(-1, 2, 3)), 1e-6);
                     }});

    GltfDocument image = boundedTriangle();
    use(image, "EXT_lights_image_based");
    const int view = image.addView(pngOfFourTexels());
    for (int face = 0; face < 6; ++face)
        image.doc["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    image.doc["extensions"]["EXT_lights_image_based"]["lights"] =
        json::array({{{"intensity", 2},
                      {"specularImageSize", 2},
                      {"specularImages", json::array({{0, 1, 2, 3, 4, 5}})},
                      {"irradianceCoefficients", std::vector<std::vector<float>>(9, {0, 0, 0})}}});
    image.doc["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    files.push_back({"EXT_lights_image_based", image, [](const Scene& scene) {
                         ASSERT_TRUE(scene.environment.has_value());
                         EXPECT_EQ(scene.environment->radiance, glm::vec3(2));
                         const TextureImage& sky = scene.images.at(std::size_t(scene.environment->image));
                         const auto& texels = std::get<std::vector<float>>(sky.texels);
                         // Blue's alpha of 64 / 255 brings it to nearly 4.
                         float bluest = 0;
                         for (std::size_t i = 2; i < texels.size(); i += 4)
                             bluest = std::max(bluest, texels[i]);
                         EXPECT_GT(bluest, 2);
                         EXPECT_LE(bluest, 255.0f / 64 + 1e-5f);
                     }});

    GltfDocument extras = boundedTriangle();
    extras.primitive()["material"] = 0;
    extras.doc["materials"] =
        json::parse(R"([{"extras": {"heliograph": {"scattering": {"model": "mirror"}}}}])");
    files.push_back({"extras_heliograph", extras, [](const Scene& scene) {
                         EXPECT_EQ(scene.materials.at(0).scattering.value().model, Scattering::Model::Mirror);
                     }});
}

}  // namespace

void addExtensionFiles(std::vector<CorpusFile>& files) {
    addMaterials(files);
    addTextures(files);
    addOthers(files);
}

}  // namespace helio::test
