#include "tests/support/sanitized.hpp"
#include "tests/unit/gltf_support.hpp"

#include <functional>

namespace helio::test {
namespace {

/** Loading must throw an InputError of one line that names the file; anything else fails. Returns its text.
 */
std::string refusal(const fs::path& path, const std::string& what) {
    try {
        helio::load(path.string());
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos) << what << ": " << text;
        EXPECT_EQ(text.rfind(path.string(), 0), 0u) << what << ": " << text;
        EXPECT_FALSE(error.fault.empty()) << what;
        return text;
    } catch (const std::exception& error) {
        ADD_FAILURE() << what << ": not an InputError: " << error.what();
        return {};
    }
    ADD_FAILURE() << what << " was not refused";
    return {};
}

/** A file that uses everything: the ground for the malformed ones. */
GltfDocument everything(const std::string& png) {
    GltfDocument file = GltfDocument::triangle();
    auto& attributes = file.primitive()["attributes"];
    attributes["NORMAL"] = file.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);      // 1
    attributes["TANGENT"] = file.addAccessor<float>(std::vector<float>(12, 1), "VEC4", 3);       // 2
    attributes["TEXCOORD_0"] = file.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC2", 3);           // 3
    attributes["COLOR_0"] = file.addAccessor<float>(std::vector<float>(9, 1), "VEC3", 3);        // 4
    file.primitive()["indices"] = file.addAccessor<std::uint16_t>({0, 1, 2}, "SCALAR", 3);       // 5
    file.doc["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});  // 6
    const int sparseIndices = file.addView(packed<std::uint8_t>({2})),
              sparseValues = file.addView(packed<float>({1, 2, 3}));
    file.doc["accessors"][6]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", sparseIndices}, {"componentType", 5121}}},
        {"values", {{"bufferView", sparseValues}}}};
    file.doc["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 6}}}});
    file.primitive()["material"] = 0;
    file.doc["images"] = {{{"uri", "data:image/png;base64," + base64(png)}},
                          {{"bufferView", file.addView(png)}, {"mimeType", "image/png"}}};
    file.doc["samplers"] = {{{"wrapS", 33071}, {"minFilter", 9987}}};
    file.doc["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    file.doc["materials"] = json::parse(R"([{
        "name": "all", "alphaMode": "BLEND", "alphaCutoff": 0.5, "doubleSided": true, "emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 1, "roughnessFactor": 1,
            "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 0], "rotation": 1, "scale": [1, 1]}}},
            "metallicRoughnessTexture": {"index": 1}},
        "normalTexture": {"index": 1, "scale": 1}, "occlusionTexture": {"index": 1, "strength": 1}, "emissiveTexture": {"index": 1},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}, "KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_specular": {"specularFactor": 1, "specularColorFactor": [1, 1, 1],
                "specularTexture": {"index": 1, "extensions": {"KHR_texture_transform": {"rotation": 1}}}}}}])");
    file.doc["cameras"] =
        json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "zfar": 10}},
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}])");
    file.doc["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(
        R"([{"type": "spot", "color": [1, 1, 1], "intensity": 1, "range": 1, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}])");
    file.doc["nodes"] = json::parse(R"([{"mesh": 0, "children": [1, 2]},
        {"camera": 0, "translation": [0, 0, 1], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"camera": 1, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    file.doc["scenes"] = {{{"nodes", {0}}}};
    file.doc["scene"] = 0;
    file.doc["extensionsUsed"] = {"KHR_lights_punctual"};
    return file;
}

using Mutation = std::function<void(json&)>;

struct Malformed {
    const char* pointer;  ///< JSON pointer of what is replaced, or "-pointer" for what is removed
    json value;
    const char* place;  ///< must be in the message
};

TEST_F(Gltf, RefusesMalformedDocumentsNamingThePlace) {
    const std::string image = png(1, 0, 0);
    const json whole = everything(image).withInlineBuffer();
    EXPECT_NO_THROW(load(whole));
    const Malformed cases[] = {
        {"-/asset", {}, "asset"},
        {"/asset", 2, "asset"},
        {"-/asset/version", {}, "asset"},
        {"/asset/version", 2.0, "asset.version"},
        {"/asset/version", "1.0", "asset.version"},
        {"/asset/minVersion", "2.1", "asset.minVersion"},
        {"/asset/minVersion", "10.0", "asset.minVersion"},
        {"/asset/minVersion", "two", "asset.minVersion"},
        {"/asset/minVersion", 2.0, "asset.minVersion"},
        {"/buffers", json::object(), "buffers"},
        {"/buffers", json::array(), "bufferViews[0].buffer"},
        {"/buffers/0", nullptr, "buffers[0]"},
        {"/buffers/0/byteLength", -1, "buffers[0].byteLength"},
        {"/buffers/0/byteLength", 1e18, "buffers[0].byteLength"},
        {"/buffers/0/byteLength", 100000, "buffers[0].byteLength"},
        {"/buffers/0/byteLength", "12", "buffers[0].byteLength"},
        {"-/buffers/0/uri", {}, "buffers[0]"},
        {"/buffers/0/uri", 5, "buffers[0].uri"},
        {"/buffers/0/uri", "missing.bin", "buffers[0].uri"},
        {"/buffers/0/uri", "../escape.bin", "leads out"},
        {"/buffers/0/uri", "a/../../escape.bin", "leads out"},
        {"/buffers/0/uri", "%2e%2e/escape.bin", "leads out"},
        {"/buffers/0/uri", "/etc/passwd", "leads out"},
        {"/buffers/0/uri", "null%00byte", "leads out"},
        {"/buffers/0/uri", "", "leads out"},
        {"/buffers/0/uri", ".", "is no regular file"},
        {"/buffers/0/uri", "http://example.com/a.bin", "is no file"},
        {"/buffers/0/uri", "file:///etc/passwd", "is no file"},
        {"/buffers/0/uri", "data:application/octet-stream;base64", "comma"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,A*==", "base64"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AAAAA", "base64"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AA=AAA", "base64"},
        {"/bufferViews/0/buffer", 1, "bufferViews[0].buffer"},
        {"/bufferViews/0/byteOffset", -4, "bufferViews[0].byteOffset"},
        {"/bufferViews/0/byteOffset", 1e9, "bufferViews[0]"},
        {"/bufferViews/0/byteLength", 281474976710656.0, "bufferViews[0]"},
        {"/bufferViews/0/byteLength", 1e300, "bufferViews[0].byteLength"},
        {"/bufferViews/0/byteLength", 0, "bufferViews[0].byteLength"},
        {"/bufferViews/0/byteStride", 3, "bufferViews[0].byteStride"},
        {"/bufferViews/0/byteStride", 256, "bufferViews[0].byteStride"},
        {"/bufferViews/0/byteStride", 8, "accessors[0]"},
        {"/accessors/0/bufferView", 99, "accessors[0].bufferView"},
        {"/accessors/0/bufferView", 0.5, "accessors[0].bufferView"},
        {"/accessors/0/byteOffset", 4, "accessors[0].count"},
        {"/accessors/0/byteOffset", 281474976710656.0, "accessors[0].count"},
        {"/accessors/0/count", 0, "accessors[0].count"},
        {"/accessors/0/count", 4, "accessors[0].count"},
        {"/accessors/0/count", 2147483647, "accessors[0].count"},
        {"/accessors/0/count", 1e30, "accessors[0].count"},
        {"/accessors/6/count", 2147483647, "accessors[6].count"},
        {"/accessors/0/componentType", 5124, "accessors[0].componentType"},
        {"/accessors/0/componentType", "FLOAT", "accessors[0].componentType"},
        {"/accessors/0/type", "VEC5", "accessors[0].type"},
        {"/accessors/0/type", "VEC2", "POSITION"},
        {"/accessors/5/type", "VEC2", "indices"},
        {"/accessors/5/componentType", 5122, "indices"},
        {"/accessors/5/componentType", 5125, "accessors[5].count"},
        {"/accessors/1/count", 2, "NORMAL"},
        {"/accessors/6/sparse/count", 5, "accessors[6].sparse"},
        {"/accessors/6/sparse/count", -1, "accessors[6].sparse"},
        {"-/accessors/6/sparse/indices", {}, "accessors[6].sparse"},
        {"/accessors/6/sparse/indices/bufferView", 50, "accessors[6].sparse.indices"},
        {"/accessors/6/sparse/indices/componentType", 5126, "accessors[6].sparse.indices"},
        {"/accessors/6/sparse/values/byteOffset", 1e6, "accessors[6].sparse"},
        {"/accessors/6/count", 2, "accessors[6].sparse.indices"},
        {"/meshes/0/primitives", json::array(), "meshes[0].primitives"},
        {"-/meshes/0/primitives/0/attributes", {}, "meshes[0].primitives[0]"},
        {"/meshes/0/primitives/0/attributes/POSITION", 77, "attributes.POSITION"},
        {"/meshes/0/primitives/0/attributes/NORMAL", 3, "attributes.NORMAL"},
        {"/meshes/0/primitives/0/indices", -1, "primitives[0].indices"},
        {"/meshes/0/primitives/0/material", 1, "primitives[0].material"},
        {"/meshes/0/primitives/0/mode", 7, "primitives[0].mode"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 2}, "baseColorFactor"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor/0", "red", "baseColorFactor[0]"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 2, "baseColorTexture.index"},
        {"/materials/0/normalTexture", 1, "normalTexture"},
        {"/materials/0/alphaMode", "GLASS", "alphaMode"},
        {"/materials/0/emissiveFactor/0", -1, "emissiveFactor[0]"},
        {"/materials/0/extensions", json::array(), "materials[0].extensions"},
        {"/materials/0/extensions/KHR_materials_ior", true, "KHR_materials_ior"},
        {"/materials/0/extensions/KHR_materials_specular/specularTexture/index", 9, "specularTexture.index"},
        {"/textures/0/source", 4, "textures[0].source"},
        {"/textures/0/sampler", -2, "textures[0].sampler"},
        {"/samplers/0/wrapS", 1, "samplers[0].wrapS"},
        {"/images/0/uri", "data:image/png;base64,AAAA", "images[0]"},
        {"/images/0/uri", "data:image/png;base64," + base64(image.substr(0, 40)), "images[0]"},
        {"/images/0/uri", "missing.png", "images[0].uri"},
        {"/images/0/uri", "../../secret.png", "images[0].uri"},
        {"-/images/0/uri", {}, "images[0]"},
        {"/images/1/bufferView", 0, "images[1]"},
        {"/nodes/0/mesh", 3, "nodes[0].mesh"},
        {"/nodes/0/children/0", 0, "nodes[0]"},
        {"/nodes/0/children", {1, 1, 2}, "nodes[1]"},
        {"/nodes/2/children", {0}, "nodes[0]"},
        {"/nodes/0/children/0", 10, "nodes[0].children[0]"},
        {"/nodes/1/rotation", {0, 0, 0, 0}, "nodes[1].rotation"},
        {"/nodes/1/rotation", {0, 0, 1}, "nodes[1].rotation"},
        {"/nodes/1/translation", {1e300, 0, 0}, "nodes[1].translation"},
        {"/nodes/2/matrix/3", 1, "nodes[2].matrix"},
        {"/nodes/2/translation", {0, 0, 0}, "nodes[2]: has a matrix and a translation"},
        {"/nodes/2/rotation", {0, 0, 0, 1}, "nodes[2]: has a matrix and a rotation"},
        {"/nodes/2/scale", {1, 1, 1}, "nodes[2]: has a matrix and a scale"},
        {"/nodes/2/matrix", {1}, "nodes[2].matrix"},
        {"/nodes/2/extensions/KHR_lights_punctual/light", 1, "light"},
        {"/scenes/0/nodes", {1}, "scenes[0].nodes[0]"},
        {"/scenes/0/nodes", {0, 0}, "scenes[0].nodes[1]"},
        {"/scene", 1, "scene"},
        {"/cameras/0/type", "fisheye", "cameras[0].type"},
        {"/cameras/0/type", "orthographic", "cameras[0]"},
        {"/cameras/0/perspective/yfov", 0, "yfov"},
        {"/cameras/0/perspective/yfov", 4, "yfov"},
        {"/cameras/0/perspective/znear", 0, "znear"},
        {"/cameras/0/perspective/zfar", 0.05, "cameras[0]"},
        {"/cameras/1/orthographic/ymag", 0, "ymag"},
        {"/extensions/KHR_lights_punctual/lights/0/type", "area", "lights[0].type"},
        {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 0.5, "spot"},
        {"/extensionsRequired", {"KHR_draco_mesh_compression"}, "KHR_draco_mesh_compression"},
        {"/extensionsRequired", "KHR_draco_mesh_compression", "extensionsRequired"},
        {"/extensionsUsed", {1}, "extensionsUsed[0]"},
    };
    EXPECT_GE(std::size(cases), 40u);
    for (const Malformed& malformed : cases) {
        json document = whole;
        const bool isRemoved = malformed.pointer[0] == '-';
        const json::json_pointer at(malformed.pointer + (isRemoved ? 1 : 0));
        if (isRemoved) {
            document.at(at.parent_pointer()).erase(at.back());
        } else {
            document[at] = malformed.value;
        }
        const std::string what = std::string(malformed.pointer) + " " + malformed.value.dump().substr(0, 80);
        const std::string text = refusal(write("bad.gltf", document.dump()), what);
        EXPECT_NE(text.find(malformed.place), std::string::npos) << what << ": " << text;
    }
}

TEST_F(Gltf, TakesMinimumVersionsUpToTwo) {
    for (const char* version : {"2.0", "1.0", "1.1", "02.00"}) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["asset"]["minVersion"] = version;
        EXPECT_NO_THROW(load(file)) << version;
    }
}

TEST_F(Gltf, RefusesFilesOfGltfOneByTheirVersion) {
    const json document = {{"asset", {{"version", "1.0"}}}, {"buffers", {{"name", json::object()}}}};
    const std::string text = refusal(write("one.gltf", document.dump()), "glTF 1.0");
    EXPECT_NE(text.find("asset.version"), std::string::npos) << text;
    EXPECT_NE(text.find("give glTF 2.0"), std::string::npos) << text;
}

TEST_F(Gltf, RefusesNumbersThatAreNotFinite) {
    for (float wrong : {NAN, INFINITY, -INFINITY}) {
        for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
            GltfDocument file = GltfDocument::triangle();
            const bool isUv = attribute[0] == 'T';
            std::vector<float> values(isUv ? 6 : 9, 1);
            values[4] = wrong;
            file.primitive()["attributes"][attribute] = file.addAccessor(values, isUv ? "VEC2" : "VEC3", 3);
            const std::string text = refusal(write("bad.gltf", file.withInlineBuffer().dump()), attribute);
            EXPECT_NE(text.find("not finite"), std::string::npos) << text;
        }
    }
}

TEST_F(Gltf, RefusesIndicesPastTheVertices) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["indices"] = file.addAccessor<std::uint32_t>({0, 1, 0xffffffffu}, "SCALAR", 3);
    const std::string text = refusal(write("bad.gltf", file.withInlineBuffer().dump()), "index");
    EXPECT_NE(text.find("meshes[0].primitives[0].indices: element 2 is 4294967295"), std::string::npos)
        << text;
}

TEST_F(Gltf, ReadsObjectsOfListsWhereverTheyLie) {
    const std::string name(70000, 'x'), zeros(90000, 'A');  // too long for the parser's buffers
    const std::string text = R"({"asset":{"version":"2.0"},"nodes":[{"name":"of a list that does not count"}],
        "cameras":[],"nodes" : [{"name":")" +
                             name + R"("}, {"extras":{"a":[{"b":[]}]},"children":[0],"name":"second"},
        {"name":"\"]},{["}],"buffers":[{"uri":"data:;base64,)" +
                             zeros + R"(","byteLength":67500}]})";
    const Scene scene = helio::load(write("lists.gltf", text).string());
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[1].name, "second");
    EXPECT_EQ(scene.nodes[1].children, std::vector<int>{0});
    EXPECT_EQ(scene.nodes[2].name, "\"]},{[");
    EXPECT_EQ(scene.roots, (std::vector<int>{1, 2}));
}

TEST_F(Gltf, RefusesListsOfOtherThanObjects) {
    for (const char* other : {"1", "\"a\"", "null", "true", "0.5", "[]", "[{}]"}) {
        const std::string list =
            R"({"asset":{"version":"2.0"},"nodes":[{"name":"a"},)" + std::string(other) + "]}";
        const std::string text = refusal(write("bad.gltf", list), other);
        EXPECT_NE(text.find("nodes[1]: is no object"), std::string::npos) << text;
    }
}

TEST_F(Gltf, TellsTheFirstOfManyFaults) {
    json nodes = json::array();
    for (int i = 0; i < 3000; ++i) nodes.push_back({{"mesh", i >= 700 ? 1 : 0}});
    GltfDocument file = GltfDocument::triangle();
    file.doc["nodes"] = nodes;
    const std::string text = refusal(write("bad.gltf", file.withInlineBuffer().dump()), "faults");
    EXPECT_NE(text.find("nodes[700].mesh"), std::string::npos) << text;
}

TEST_F(Gltf, RefusesTextThatIsNoGltf) {
    const std::string deep(100000, '[');
    const std::pair<const char*, std::string> texts[] = {
        {"empty", ""},
        {"blank", "   "},
        {"no JSON", "hello"},
        {"null", "null"},
        {"array", "[]"},
        {"number", "5"},
        {"string", "\"glTF\""},
        {"deep arrays", deep},
        {"deep objects",
         [] {
             std::string text;
             for (int i = 0; i < 20000; ++i) text += "{\"a\":";
             return text;
         }()},
        {"deep extras",
         R"({"asset": {"version": "2.0"}, "extras": )" + deep.substr(0, 500) + std::string(500, ']') + "}"},
        {"huge number", R"({"asset": {"version": "2.0"}, "scene": 1e999})"},
        {"bad UTF-8", "{\"asset\": {\"version\": \"\xff\xfe\"}}"},
        {"trailing", R"({"asset": {"version": "2.0"}} x)"},
        {"unclosed string", R"({"asset": {"version": "2.0)"},
        {"zeros", std::string(64, '\0')},
    };
    for (const auto& [what, text] : texts) refusal(write("bad.gltf", text), what);
    for (const char* name : {"empty.gltf", "empty.glb"})
        EXPECT_NE(refusal(write(name, ""), name).find(": is empty;"), std::string::npos);
    const std::string reason = refusal(write("bad.gltf", "{\n\"asset\": \x01\n}"), "control character");
    EXPECT_NE(reason.find("line 2, byte 12: is no valid JSON: "), std::string::npos) << reason;
    EXPECT_NE(reason.find("invalid literal"), std::string::npos) << reason;
    refusal(folder_ / "missing.gltf", "missing file");
    refusal(folder_ / "missing.glb", "missing file");
    fs::create_directories(folder_ / "folder.gltf");
    refusal(folder_ / "folder.gltf", "folder");
    refusal(write("scene.xyz", "v 0 0 0"), "unknown extension");
}

TEST_F(Gltf, RefusesEveryTruncation) {
    const std::string png = this->png(0, 0, 1);
    const std::string glb = everything(png).glb();
    for (std::size_t length = 0; length < glb.size(); length += length < 64 ? 1 : 61) {
        refusal(write("cut.glb", glb.substr(0, length)), "GLB cut to " + std::to_string(length));
    }
    const std::string text = everything(png).withInlineBuffer().dump();
    for (std::size_t length = 0; length < text.size(); length += 97) {
        refusal(write("cut.gltf", text.substr(0, length)), "JSON cut to " + std::to_string(length));
    }
}

TEST_F(Gltf, RefusesBrokenGlbHeaders) {
    const std::string glb = GltfDocument::triangle().glb();
    const auto patched = [&](std::size_t at, std::uint32_t value) {
        std::string bytes = glb;
        std::memcpy(&bytes[at], &value, 4);
        return bytes;
    };
    std::uint32_t jsonLength = 0;
    std::memcpy(&jsonLength, &glb[12], 4);
    const std::size_t binary = 20 + jsonLength;
    refusal(write("a.glb", patched(4, 1)), "version 1");
    refusal(write("a.glb", patched(8, 0)), "length 0");
    refusal(write("a.glb", patched(8, 0xffffffffu)), "huge length");
    refusal(write("a.glb", patched(12, 0xffffffffu)), "huge JSON chunk");
    refusal(write("a.glb", patched(12, 8)), "short JSON chunk");
    refusal(write("a.glb", patched(16, 0x004E4942)), "first chunk is BIN");
    refusal(write("a.glb", patched(binary, 0xfffffff0u)), "huge BIN chunk");
    refusal(write("a.glb", patched(binary, 4)), "short BIN chunk");
    refusal(write("a.glb", patched(binary + 4, 0)), "no BIN chunk");
}

/** Replaces every value of a document, one at a time, by odd ones: each must load or be refused in one line.
 */
TEST_F(Gltf, SurvivesAnyValueInAnyPlace) {
    const json whole = everything(png(1, 1, 1)).withInlineBuffer();
    const std::vector<json>& odd = oddValues();
    int loaded = 0, refused = 0, turn = 0;
    const json flat = whole.flatten();
    for (const auto& [pointer, value] : flat.items()) {
        for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) {
            const bool isLeaf = at.to_string() == pointer;
            for (std::size_t i = 0; i < std::size(odd); i += isLeaf ? 1 : 4) {
                if (test::kSanitized && ++turn % 4 != 0) continue;
                json document = whole;
                document[at] = odd[i];
                try {
                    load(document);
                    ++loaded;
                } catch (const InputError& error) {
                    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                    ++refused;
                } catch (const std::exception& error) {
                    ADD_FAILURE() << at.to_string() << " = " << odd[i] << ": " << error.what();
                }
            }
        }
    }
    EXPECT_GT(refused, test::kSanitized ? 250 : 1000);
    EXPECT_GT(loaded, test::kSanitized ? 25 : 100);
}

/** Flips bytes of a GLB, in its JSON and in its data. */
TEST_F(Gltf, SurvivesFlippedBytes) {
    const std::string glb = everything(png(1, 1, 1)).glb();
    std::uint32_t state = 12345;
    for (int round = 0; round < 1500; ++round) {
        std::string bytes = glb;
        for (int flips = 0; flips < 1 + round % 4; ++flips) {
            state = state * 1664525u + 1013904223u;
            const std::size_t at = (state >> 8) % bytes.size();
            state = state * 1664525u + 1013904223u;
            bytes[at] = char(state >> 24);
        }
        try {
            helio::load(write("flipped.glb", bytes).string());
        } catch (const InputError&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << "round " << round << ": " << error.what();
        }
    }
}

}  // namespace
}  // namespace helio::test
