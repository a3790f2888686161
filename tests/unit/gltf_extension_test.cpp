#include "tests/unit/gltf_support.hpp"

#include <cmath>
#include <limits>

namespace helio::test {
namespace {

/** A triangle whose one material has `extensions`, and textures 0..3 of one image each. */
GltfDocument withMaterial(const char* extensions) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 0;
    file.doc["materials"] = {{{"extensions", json::parse(extensions)}}};
    for (const auto& [name, value] : file.doc["materials"][0]["extensions"].items()) {
        file.doc["extensionsUsed"].push_back(name);
        file.doc["extensionsRequired"].push_back(name);
    }
    return file;
}

class GltfMaterials : public Gltf {
protected:
    /** Loads the file with textures 0..4; their images are 1x1 to 5x5. */
    Scene loadTextured(GltfDocument file) const {
        for (std::uint32_t i = 0; i < 5; ++i) {
            const std::string name = "texture" + std::to_string(i) + ".png";
            write(name, png(0.2f * float(i), 0, 0, i + 1));
            file.doc["images"].push_back({{"uri", name}});
            file.doc["textures"].push_back({{"source", i}});
        }
        Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_TRUE(scene.skipped.empty());
        EXPECT_TRUE(scene.warnings.empty());
        EXPECT_TRUE(scene.materials[0].unsupported.empty());
        return scene;
    }
    /** The index of the asset's texture that `use` stands for. */
    static int assetTexture(const Scene& scene, const TextureUse& use) {
        if (!use) return -1;
        return int(scene.images[std::size_t(scene.textures[std::size_t(use.texture)].image)].width) - 1;
    }
};

TEST_F(GltfMaterials, Transmission) {
    const Scene scene = loadTextured(withMaterial(R"({"KHR_materials_transmission":
        {"transmissionFactor": 0.5, "transmissionTexture": {"index": 1, "texCoord": 1}}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.transmission, 0.5f);
    EXPECT_EQ(assetTexture(scene, m.transmissionTexture), 1);
    EXPECT_EQ(m.transmissionTexture.texcoord, 1);
}

TEST_F(GltfMaterials, Volume) {
    const Scene scene = loadTextured(
        withMaterial(R"({"KHR_materials_volume": {"thicknessFactor": 2, "thicknessTexture": {"index": 2},
                         "attenuationDistance": 3, "attenuationColor": [0.25, 0.5, 0.75]}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.thickness, 2);
    EXPECT_EQ(assetTexture(scene, m.thicknessTexture), 2);
    EXPECT_EQ(m.attenuationDistance, 3);
    EXPECT_EQ(m.attenuationColor, glm::vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(load(withMaterial(R"({"KHR_materials_volume": {}})")).materials[0].attenuationDistance,
              std::numeric_limits<float>::infinity());
}

TEST_F(GltfMaterials, Clearcoat) {
    const Scene scene = loadTextured(withMaterial(R"({"KHR_materials_clearcoat": {
        "clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0},
        "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": {"index": 1},
        "clearcoatNormalTexture": {"index": 2, "scale": 0.75}}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.clearcoat, 0.5f);
    EXPECT_EQ(m.clearcoatRoughness, 0.25f);
    EXPECT_EQ(m.clearcoatNormalScale, 0.75f);
    EXPECT_EQ(assetTexture(scene, m.clearcoatTexture), 0);
    EXPECT_EQ(assetTexture(scene, m.clearcoatRoughnessTexture), 1);
    EXPECT_EQ(assetTexture(scene, m.clearcoatNormalTexture), 2);
}

TEST_F(GltfMaterials, Sheen) {
    const Scene scene = loadTextured(withMaterial(R"({"KHR_materials_sheen": {
        "sheenColorFactor": [0.1, 0.2, 0.3], "sheenColorTexture": {"index": 3},
        "sheenRoughnessFactor": 0.5, "sheenRoughnessTexture": {"index": 4}}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.sheenColor, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.sheenRoughness, 0.5f);
    EXPECT_EQ(assetTexture(scene, m.sheenColorTexture), 3);
    EXPECT_EQ(assetTexture(scene, m.sheenRoughnessTexture), 4);
}

TEST_F(GltfMaterials, Anisotropy) {
    const Scene scene = loadTextured(withMaterial(R"({"KHR_materials_anisotropy": {
        "anisotropyStrength": 0.5, "anisotropyRotation": 1.5, "anisotropyTexture": {"index": 1}}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.anisotropyStrength, 0.5f);
    EXPECT_EQ(m.anisotropyRotation, 1.5f);
    EXPECT_EQ(assetTexture(scene, m.anisotropyTexture), 1);
}

TEST_F(GltfMaterials, Iridescence) {
    const Scene scene = loadTextured(withMaterial(R"({"KHR_materials_iridescence": {
        "iridescenceFactor": 0.5, "iridescenceTexture": {"index": 0}, "iridescenceIor": 1.75,
        "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 800,
        "iridescenceThicknessTexture": {"index": 2}}})"));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.iridescence, 0.5f);
    EXPECT_EQ(m.iridescenceIor, 1.75f);
    EXPECT_EQ(m.iridescenceThicknessMinimum, 200);
    EXPECT_EQ(m.iridescenceThicknessMaximum, 800);
    EXPECT_EQ(assetTexture(scene, m.iridescenceTexture), 0);
    EXPECT_EQ(assetTexture(scene, m.iridescenceThicknessTexture), 2);
}

TEST_F(GltfMaterials, DispersionAndIor) {
    const Scene scene = loadTextured(withMaterial(
        R"({"KHR_materials_dispersion": {"dispersion": 0.25}, "KHR_materials_ior": {"ior": 2.5}})"));
    EXPECT_EQ(scene.materials[0].dispersion, 0.25f);
    EXPECT_EQ(scene.materials[0].ior, 2.5f);
    EXPECT_EQ(load(withMaterial(R"({"KHR_materials_ior": {"ior": 0}})")).materials[0].ior, 0);
    const Scene below = load(withMaterial(R"({"KHR_materials_ior": {"ior": 0.5}})"));
    EXPECT_EQ(below.materials[0].ior, 1);
    EXPECT_EQ(below.warnings.size(), 1u);
}

TEST_F(GltfMaterials, ExtensionsDefaultToHavingNoEffect) {
    const Material plain, loaded = load(withMaterial(R"({"KHR_materials_anisotropy": {},
        "KHR_materials_clearcoat": {}, "KHR_materials_dispersion": {}, "KHR_materials_emissive_strength": {},
        "KHR_materials_ior": {}, "KHR_materials_iridescence": {}, "KHR_materials_sheen": {},
        "KHR_materials_specular": {}, "KHR_materials_transmission": {}, "KHR_materials_volume": {}})"))
                                       .materials[0];
    EXPECT_EQ(loaded.anisotropyStrength, plain.anisotropyStrength);
    EXPECT_EQ(loaded.clearcoat, plain.clearcoat);
    EXPECT_EQ(loaded.dispersion, plain.dispersion);
    EXPECT_EQ(loaded.ior, plain.ior);
    EXPECT_EQ(loaded.iridescence, plain.iridescence);
    EXPECT_EQ(loaded.iridescenceIor, plain.iridescenceIor);
    EXPECT_EQ(loaded.iridescenceThicknessMinimum, plain.iridescenceThicknessMinimum);
    EXPECT_EQ(loaded.iridescenceThicknessMaximum, plain.iridescenceThicknessMaximum);
    EXPECT_EQ(loaded.sheenColor, plain.sheenColor);
    EXPECT_EQ(loaded.sheenRoughness, plain.sheenRoughness);
    EXPECT_EQ(loaded.specular, plain.specular);
    EXPECT_EQ(loaded.specularColor, plain.specularColor);
    EXPECT_EQ(loaded.transmission, plain.transmission);
    EXPECT_EQ(loaded.thickness, plain.thickness);
    EXPECT_EQ(loaded.attenuationColor, plain.attenuationColor);
    EXPECT_FALSE(loaded.unlit);
}

/** Every slot for a texture that a material has, as the pointer to it in the file. */
TEST_F(GltfMaterials, EveryTextureSlotTakesATransformWithItsOwnSet) {
    const std::pair<const char*, TextureUse Material::*> slots[] = {
        {"/pbrMetallicRoughness/baseColorTexture", &Material::baseColorTexture},
        {"/pbrMetallicRoughness/metallicRoughnessTexture", &Material::metallicRoughnessTexture},
        {"/normalTexture", &Material::normalTexture},
        {"/occlusionTexture", &Material::occlusionTexture},
        {"/emissiveTexture", &Material::emissiveTexture},
        {"/extensions/KHR_materials_anisotropy/anisotropyTexture", &Material::anisotropyTexture},
        {"/extensions/KHR_materials_clearcoat/clearcoatTexture", &Material::clearcoatTexture},
        {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
         &Material::clearcoatRoughnessTexture},
        {"/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", &Material::clearcoatNormalTexture},
        {"/extensions/KHR_materials_iridescence/iridescenceTexture", &Material::iridescenceTexture},
        {"/extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
         &Material::iridescenceThicknessTexture},
        {"/extensions/KHR_materials_sheen/sheenColorTexture", &Material::sheenColorTexture},
        {"/extensions/KHR_materials_sheen/sheenRoughnessTexture", &Material::sheenRoughnessTexture},
        {"/extensions/KHR_materials_specular/specularTexture", &Material::specularTexture},
        {"/extensions/KHR_materials_specular/specularColorTexture", &Material::specularColorTexture},
        {"/extensions/KHR_materials_transmission/transmissionTexture", &Material::transmissionTexture},
        {"/extensions/KHR_materials_volume/thicknessTexture", &Material::thicknessTexture},
    };
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["material"] = 0;
    json material;
    int number = 0;
    for (const auto& [path, slot] : slots) {
        ++number;
        material[json::json_pointer(path)] = {{"index", number % 5},
                                              {"texCoord", 9},
                                              {"extensions",
                                               {{"KHR_texture_transform",
                                                 {{"offset", {number, -number}},
                                                  {"rotation", M_PI / 2},
                                                  {"scale", {2, 3}},
                                                  {"texCoord", number}}}}}};
    }
    file.doc["materials"] = json::array({material});
    const Scene scene = loadTextured(file);
    number = 0;
    for (const auto& [path, slot] : slots) {
        ++number;
        const TextureUse& use = scene.materials[0].*slot;
        EXPECT_EQ(assetTexture(scene, use), number % 5) << path;
        EXPECT_EQ(use.texcoord, number) << path;
        // Scaled to (2, 3), turned by 90 degrees to (3, -2), moved.
        const glm::vec3 at = use.transform * glm::vec3(1, 1, 1);
        EXPECT_NEAR(at.x, 3 + number, 1e-5) << path;
        EXPECT_NEAR(at.y, -2 - number, 1e-5) << path;
    }
}

GltfDocument withVariants() {
    GltfDocument file = GltfDocument::triangle();
    file.doc["extensionsUsed"] = file.doc["extensionsRequired"] = {"KHR_materials_variants"};
    file.doc["extensions"]["KHR_materials_variants"]["variants"] =
        json::parse(R"([{"name": "day"}, {"name": "dusk"}, {"name": "night"}])");
    file.primitive()["material"] = 0;
    file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] =
        json::parse(R"([{"material": 1, "variants": [1]}, {"material": 2, "variants": [2]}])");
    for (int i = 0; i < 3; ++i) {
        file.doc["images"].push_back({{"uri", "variant" + std::to_string(i) + ".png"}});
        file.doc["textures"].push_back({{"source", i}});
        file.doc["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
    }
    return file;
}

TEST_F(Gltf, ShowsMaterialVariants) {
    for (int i = 0; i < 3; ++i) write("variant" + std::to_string(i) + ".png", png(float(i) / 2, 0, 0));
    const std::string path = write("variants.gltf", withVariants().withInlineBuffer().dump()).string();
    const auto material = [](const Scene& scene) { return scene.meshes[0].primitives[0].material; };
    const Scene plain = helio::load(path);
    EXPECT_EQ(plain.variants, (std::vector<std::string>{"day", "dusk", "night"}));
    EXPECT_EQ(material(plain), 0);
    EXPECT_EQ(plain.images.size(), 1u) << "only what is shown is decoded";
    const char* const names[] = {"day", "dusk", "night"};
    for (int i = 0; i < 3; ++i) {
        const Scene shown = helio::load(path, {.variant = names[i]});
        EXPECT_EQ(material(shown), i);
        EXPECT_EQ(shown.images.size(), 1u);
        EXPECT_TRUE(shown.materials[std::size_t(i)].emissiveTexture);
    }
    Scene all = helio::load(path, {.everyVariant = true});
    EXPECT_EQ(all.images.size(), 3u);
    for (int i : {2, 0, 1}) {
        chooseVariant(all, names[i]);
        EXPECT_EQ(material(all), i);
    }
    EXPECT_NO_THROW(all.validate());
    try {
        helio::load(path, {.variant = "noon"});
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("day, dusk, night"), std::string::npos) << error.what();
    }
}

TEST_F(Gltf, PlacesCopiesOfAMesh) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["extensionsUsed"] = file.doc["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const int translation = file.addAccessor<float>({0, 0, 0, 1, 2, 3, 4, 5, 6}, "VEC3", 3);
    // Quarter turns about +Z; as normalized shorts, which the extension allows.
    const int rotation =
        file.addAccessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 32767, 0}, "VEC4", 3, true);
    const int scale = file.addAccessor<float>({1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", 3);
    file.doc["nodes"][0]["translation"] = {10, 0, 0};
    file.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
    const Scene scene = load(file);
    EXPECT_NO_THROW(scene.validate());
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.triangleCount(), 3u);
    const std::vector<Instance> placed = scene.instances();
    ASSERT_EQ(placed.size(), 3u);
    const glm::dvec3 expected[] = {{11, 0, 0}, {11, 4, 3}, {11, 5, 6}};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 tip(placed[i].transform * glm::dvec4(1, 0, 0, 1));
        EXPECT_NEAR(glm::distance(tip, expected[i]), 0, 1e-6) << i;
        EXPECT_EQ(placed[i].node, 0);
    }
    file.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
        file.addAccessor<float>({1, 1, 1}, "VEC3", 1);
    EXPECT_THROW(load(file), InputError);
}

TEST_F(Gltf, CopiesWithoutDataDoNotUnfoldASmallFile) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 23}, {"type", "VEC3"}});
    file.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 1}};
    try {
        load(file);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(error.fault.find("unfolds"), std::string::npos) << error.what();
    }
}

TEST_F(Gltf, RefusesRequiredExtensionsThatItDoesNotSupport) {
    for (const char* name : {"KHR_draco_mesh_compression", "KHR_texture_basisu", "EXT_meshopt_compression"}) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["extensionsUsed"] = file.doc["extensionsRequired"] = {name};
        try {
            load(file);
            ADD_FAILURE() << name << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(error.fault.find(name), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace helio::test
