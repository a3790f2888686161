#include "tests/unit/gltf_support.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace helio::test {
namespace {

TEST_F(Gltf, LoadsATriangleFromEveryContainer) {
    const GltfDocument file = GltfDocument::triangle();
    json external = file.doc;
    external["buffers"] = json::array({{{"byteLength", file.buffer.size()}, {"uri", "some%20data.bin"}}});
    write("some data.bin", file.buffer);
    json percent = file.doc;
    std::string escaped = "data:application/octet-stream,";
    for (unsigned char c : file.buffer)
        escaped += "%" + std::string(1, "0123456789abcdef"[c >> 4]) + "0123456789ABCDEF"[c & 15];
    percent["buffers"] = json::array({{{"byteLength", file.buffer.size()}, {"uri", escaped}}});
    const fs::path paths[] = {write("inline.gltf", file.withInlineBuffer().dump()),
                              write("out.GLTF", external.dump()), write("a.glb", file.glb()),
                              write("percent.gltf", percent.dump()),
                              write("bom.gltf", "\xef\xbb\xbf" + file.withInlineBuffer().dump(2))};
    for (const fs::path& path : paths) {
        const Scene scene = helio::load(path.string());
        EXPECT_EQ(scene.name, path.string());
        ASSERT_EQ(scene.triangleCount(), 1u) << path;
        const Primitive& primitive = scene.meshes[0].primitives[0];
        EXPECT_EQ(primitive.positions[1], glm::vec3(1, 0, 0));
        EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2}));
        EXPECT_EQ(primitive.material, -1);
        EXPECT_TRUE(primitive.normals.empty());
        EXPECT_TRUE(scene.skipped.empty());
        EXPECT_TRUE(scene.warnings.empty());
    }
}

template <class T>
void expectIndices(const Scene& scene) {
    EXPECT_EQ(scene.meshes[0].primitives[0].indices, (std::vector<std::uint32_t>{2, 0, 1}))
        << typeid(T).name();
}

TEST_F(Gltf, ReadsEveryIndexType) {
    const auto test = [&]<class T>(T) {
        GltfDocument file = GltfDocument::triangle();
        file.primitive()["indices"] = file.addAccessor<T>({2, 0, 1}, "SCALAR", 3);
        expectIndices<T>(load(file));
    };
    test(std::uint8_t());
    test(std::uint16_t());
    test(std::uint32_t());
}

TEST_F(Gltf, ReadsEveryComponentTypePlainAndNormalized) {
    const auto test = [&]<class T>(T low, double one) {
        for (bool isNormalized : {false, true}) {
            GltfDocument file = GltfDocument::triangle();
            // 4-byte steps between elements, as glTF demands of vertex attributes.
            const T high = std::numeric_limits<T>::max();
            std::vector<T> values;
            const std::size_t step = sizeof(T) == 1 ? 4 : 2;
            for (T value : {T(0), low, high}) {
                values.insert(values.end(), {value, T(1)});
                values.resize((values.size() + step - 1) / step * step);
            }
            const int accessor = file.addAccessor<T>(values, "VEC2", 3, isNormalized);
            file.doc["bufferViews"].back()["byteStride"] = step * sizeof(T);
            file.primitive()["attributes"]["TEXCOORD_0"] = accessor;
            const Scene scene = load(file);
            const auto& uv = scene.meshes[0].primitives[0].texcoords[0];
            const double scale = isNormalized ? one : 1;
            EXPECT_FLOAT_EQ(uv[1].x, float(std::max(double(low) / scale, isNormalized ? -1.0 : -1e9)));
            EXPECT_FLOAT_EQ(uv[2].x, float(double(high) / scale));
            EXPECT_FLOAT_EQ(uv[0].y, float(1 / scale));
        }
    };
    test(std::int8_t(-128), 127);
    test(std::uint8_t(3), 255);
    test(std::int16_t(-32768), 32767);
    test(std::uint16_t(5), 65535);
}

TEST_F(Gltf, ReadsInterleavedAttributesWithOffsets) {
    GltfDocument file;
    // position, normal, uv: 32 bytes a vertex, after 8 bytes of something else
    std::vector<float> data{9, 9};
    for (int v = 0; v < 3; ++v) {
        data.insert(data.end(), {float(v == 1), float(v == 2), 0, 0, 0, 2, 0.25f * float(v), 1});
    }
    const int view = file.addView(packed(data), 32);
    const auto add = [&](int offset, const char* type) {
        file.doc["accessors"].push_back({{"bufferView", view},
                                         {"byteOffset", 8 + offset},
                                         {"componentType", 5126},
                                         {"count", 3},
                                         {"type", type}});
    };
    add(0, "VEC3");
    add(12, "VEC3");
    add(24, "VEC2");
    file.doc["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}}}}}};
    file.doc["nodes"] = {{{"mesh", 0}}};
    const Scene scene = load(file);
    const Primitive& primitive = scene.meshes[0].primitives[0];
    EXPECT_EQ(primitive.positions[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(primitive.normals[1], glm::vec3(0, 0, 1)) << "normals become unit";
    EXPECT_EQ(primitive.texcoords[0][2], glm::vec2(0.5f, 1));
}

TEST_F(Gltf, ReadsSparseAccessors) {
    for (bool hasBase : {true, false}) {
        GltfDocument file = GltfDocument::triangle();
        const int indices = file.addView(packed<std::uint16_t>({1, 2}));
        const int values = file.addView(packed<float>({5, 6, 7, 8, 9, 10}));
        json& accessor = file.doc["accessors"][0];
        if (!hasBase) accessor.erase("bufferView");
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}};
        const Scene scene = load(file);
        const auto& positions = scene.meshes[0].primitives[0].positions;
        EXPECT_EQ(positions[0], glm::vec3(0));
        EXPECT_EQ(positions[1], glm::vec3(5, 6, 7));
        EXPECT_EQ(positions[2], glm::vec3(8, 9, 10));
    }
}

TEST_F(Gltf, UnfoldsStripsAndFans) {
    for (int mode : {5, 6}) {
        GltfDocument file;
        file.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", 5);
        file.doc["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", mode}}}}}};
        file.doc["nodes"] = {{{"mesh", 0}}};
        const Scene scene = load(file);
        const std::vector<std::uint32_t> strip{0, 1, 2, 1, 3, 2, 2, 3, 4}, fan{1, 2, 0, 2, 3, 0, 3, 4, 0};
        EXPECT_EQ(scene.meshes[0].primitives[0].indices, mode == 5 ? strip : fan);
    }
}

TEST_F(Gltf, NamesPointsAndLinesAsSkipped) {
    for (int mode : {0, 1, 2, 3}) {
        GltfDocument file = GltfDocument::triangle();
        file.primitive()["mode"] = mode;
        const Scene scene = load(file);
        EXPECT_EQ(scene.triangleCount(), 0u);
        ASSERT_EQ(scene.skipped.size(), 1u);
        EXPECT_EQ(scene.skipped[0].first, mode == 0 ? "points" : "lines");
    }
}

TEST_F(Gltf, ReadsVertexColoursOfThreeAndFour) {
    for (int components : {3, 4}) {
        GltfDocument file = GltfDocument::triangle();
        std::vector<float> values(std::size_t(components) * 3, 0.5f);
        file.primitive()["attributes"]["COLOR_0"] =
            file.addAccessor(values, components == 3 ? "VEC3" : "VEC4", 3);
        const Scene scene = load(file);
        EXPECT_EQ(scene.meshes[0].primitives[0].colors[2],
                  glm::vec4(0.5f, 0.5f, 0.5f, components == 3 ? 1 : 0.5f));
    }
    GltfDocument file = GltfDocument::triangle();
    std::vector<std::uint8_t> bytes{255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0};
    file.primitive()["attributes"]["COLOR_0"] = file.addAccessor(bytes, "VEC4", 3, true);
    EXPECT_EQ(load(file).meshes[0].primitives[0].colors[0], glm::vec4(1, 0, 0.2f, 1));
}

TEST_F(Gltf, ReplacesNormalsAndTangentsThatAreZero) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["attributes"]["NORMAL"] =
        file.addAccessor<float>({0, 0, 0, 0, 0, 0, 0, 3, 4}, "VEC3", 3);
    file.primitive()["attributes"]["TANGENT"] =
        file.addAccessor<float>({0, 0, 0, 0, 2, 0, 0, -1, 0, 1, 0, 1}, "VEC4", 3);
    const Scene scene = load(file);
    const Primitive& primitive = scene.meshes[0].primitives[0];
    EXPECT_EQ(primitive.normals[0], glm::vec3(0, 0, 1)) << "the triangle's own";
    EXPECT_FLOAT_EQ(primitive.normals[2].y, 0.6f);
    EXPECT_FLOAT_EQ(glm::length(glm::vec3(primitive.tangents[0])), 1);
    EXPECT_EQ(primitive.tangents[1], glm::vec4(1, 0, 0, -1));
}

TEST_F(Gltf, LeavesOutTheRestOfATriangleWithAWarning) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["indices"] = file.addAccessor<std::uint8_t>({0, 1, 2, 0, 1}, "SCALAR", 5);
    const Scene scene = load(file);
    EXPECT_EQ(scene.triangleCount(), 1u);
    EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Gltf, NamesWhatItDoesNotEvaluate) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["extensionsUsed"] = {"KHR_texture_basisu", "KHR_draco_mesh_compression", "KHR_materials_ior"};
    file.doc["animations"] = json::parse(R"([{"samplers": [{"input": 1, "output": 1}], "channels": [
        {"sampler": 0, "target": {"path": "pointer"}}, {"sampler": 0, "target": {"path": "scale"}}]}])");
    file.addAccessor<float>({0}, "SCALAR", 1);
    file.primitive()["targets"] = {{{"POSITION", 0}, {"TEXCOORD_0", 0}}};
    file.primitive()["attributes"]["COLOR_1"] = 0;
    const Scene scene = load(file);
    std::vector<std::string> names;
    for (const auto& [what, why] : scene.skipped) names.push_back(what);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"KHR_draco_mesh_compression", "KHR_texture_basisu",
                                               "animation of pointer", "animation of scale",
                                               "attribute COLOR_1", "morph targets of TEXCOORD_0"}));
}

/** Peak resident memory of the process in bytes since the last call, from /proc. */
std::size_t peakResident() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6)) * 1024;
    return 0;
}
void resetPeak() {
    std::ofstream("/proc/self/clear_refs") << "5";
}

void expectRefusedWithinMemory(const std::function<void()>& load, std::size_t bytes, const char* place) {
    resetPeak();
    const std::size_t before = peakResident();
    try {
        load();
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(error.place.find(place), std::string::npos) << error.what();
        EXPECT_NE(error.fault.find("unfolds"), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy.empty());
    }
#ifndef __SANITIZE_ADDRESS__  // which keeps what is freed
    EXPECT_LT(peakResident() - before, 64 * bytes + (std::size_t(256) << 20));
#else
    static_cast<void>(before), static_cast<void>(bytes);
#endif
}

/** Meshes of one to five small primitives; each triangle has a place of its own. */
GltfDocument manySmallPrimitives(int meshes) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["meshes"] = file.doc["nodes"] = json::array();
    for (int m = 0; m < meshes; ++m) {
        json primitives = json::array();
        for (int p = 0; p < 1 + m % 5; ++p) {
            const float x = float(m), y = float(p);
            const int positions = file.addAccessor<float>({x, y, 0, x + 1, y, 0, x, y + 1, 0}, "VEC3", 3);
            primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"material", 0}});
            if (m % 3 == 0)
                primitives.back()["indices"] = file.addAccessor<std::uint16_t>({2, 0, 1}, "SCALAR", 3);
        }
        file.doc["meshes"].push_back({{"name", std::to_string(m)}, {"primitives", primitives}});
        file.doc["nodes"].push_back({{"mesh", m}});
    }
    file.doc["materials"] = json::array({json::object()});
    file.doc.erase("scenes");
    return file;
}

TEST_F(Gltf, SmallPrimitivesComeInTheirOrder) {
    constexpr int meshes = 700;  // more than are decoded together, by count and by text
    GltfDocument file = manySmallPrimitives(meshes);
    // Among them one that is large, by itself more than is decoded ahead.
    const std::size_t large = 300000;
    const int positions = file.addAccessor(std::vector<float>(large * 3, 7), "VEC3", large);
    file.doc["meshes"][350]["primitives"].push_back({{"attributes", {{"POSITION", positions}}}});
    const Scene scene = load(file);
    ASSERT_EQ(scene.meshes.size(), std::size_t(meshes));
    for (int m = 0; m < meshes; ++m) {
        const Mesh& mesh = scene.meshes[std::size_t(m)];
        EXPECT_EQ(mesh.name, std::to_string(m));
        ASSERT_EQ(mesh.primitives.size(), std::size_t(1 + m % 5 + (m == 350 ? 1 : 0)));
        for (int p = 0; p < 1 + m % 5; ++p) {
            const Primitive& primitive = mesh.primitives[std::size_t(p)];
            EXPECT_EQ(primitive.positions.at(1), glm::vec3(m + 1, p, 0));
            EXPECT_EQ(primitive.indices, (m % 3 == 0 ? std::vector<std::uint32_t>{2, 0, 1}
                                                     : std::vector<std::uint32_t>{0, 1, 2}));
        }
    }
    EXPECT_EQ(scene.meshes[350].primitives.back().indices.size(), large);
}

TEST_F(Gltf, OfSmallPrimitivesTheFirstFaultIsToldAndNotesKeepTheirOrder) {
    GltfDocument file = manySmallPrimitives(60);
    const int odd = file.addAccessor<std::uint16_t>({0, 1, 2, 0}, "SCALAR", 4);
    for (const int m : {41, 7, 23}) file.doc["meshes"][m]["primitives"][0]["indices"] = odd;
    file.doc["meshes"][30]["primitives"][0]["mode"] = 0;
    const Scene scene = load(file);
    ASSERT_EQ(scene.warnings.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(
            scene.warnings[i],
            fmt::format("meshes[{}].primitives[0]: 4 indices are no whole triangles; the last are left out",
                        std::array{7, 23, 41}[i]));
    }
    ASSERT_EQ(scene.skipped.size(), 1u);
    const int wrong = file.addAccessor<std::uint16_t>({0, 1, 9}, "SCALAR", 3);
    file.doc["meshes"][52]["primitives"][1]["indices"] = wrong;
    file.doc["meshes"][33]["primitives"][2]["indices"] = wrong;
    for (int run = 0; run < 20; ++run) {  // whichever is found first
        try {
            load(file);
            ADD_FAILURE() << "index 9 of 3 vertices";
        } catch (const InputError& error) {
            EXPECT_EQ(error.place, "meshes[33].primitives[2].indices");
        }
    }
}

TEST_F(Gltf, SharedIndicesDoNotUnfoldASmallFile) {
    GltfDocument file = GltfDocument::triangle();
    const std::size_t count = 999999;
    file.primitive()["indices"] = file.addAccessor(std::vector<std::uint8_t>(count, 1), "SCALAR", count);
    const json shared = file.primitive();
    for (int p = 1; p < 400; ++p) file.doc["meshes"][0]["primitives"].push_back(shared);
    const std::string glb = file.glb();
    const std::string path = write("shared.glb", glb).string();
    expectRefusedWithinMemory([&] { helio::load(path); }, glb.size() * 2, "meshes[0].primitives[");
    // Strips unfold threefold.
    for (json& primitive : file.doc["meshes"][0]["primitives"]) primitive["mode"] = 5;
    const std::string strips = write("strips.glb", file.glb()).string();
    expectRefusedWithinMemory([&] { helio::load(strips); }, glb.size() * 2, "meshes[0].primitives[");
    // A few primitives may share.
    file.doc["meshes"][0]["primitives"] = json::array({shared, shared, shared});
    EXPECT_EQ(load(file).triangleCount(), count);
}

TEST_F(Gltf, AttributesWithoutDataDoNotUnfoldASmallFile) {
    GltfDocument file = GltfDocument::triangle();
    const std::size_t count = std::size_t(1) << 22;
    file.doc["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
    file.doc["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC2"}});
    file.primitive()["attributes"]["POSITION"] = 1;
    for (int set = 0; set < 20; ++set) file.primitive()["attributes"]["TEXCOORD_" + std::to_string(set)] = 2;
    expectRefusedWithinMemory([&] { load(file); }, 4096, "meshes[0].primitives[0].attributes.TEXCOORD_");
}

TEST_F(Gltf, KeepsOnlyVerticesInUseOfASharedAccessor) {
    GltfDocument file;
    std::vector<float> positions, normals;
    for (int i = 0; i < 100; ++i) {
        positions.insert(positions.end(), {float(i), 0, 0});
        normals.insert(normals.end(), {0, i % 2 ? 1.0f : -1.0f, 0});
    }
    const int position = file.addAccessor(positions, "VEC3", 100),
              normal = file.addAccessor(normals, "VEC3", 100);
    const int few = file.addAccessor<std::uint8_t>({97, 3, 40, 40, 3, 98}, "SCALAR", 6);
    std::vector<std::uint8_t> half;
    for (int i = 0; i < 51; ++i) half.push_back(std::uint8_t(i));
    const int many = file.addAccessor(half, "SCALAR", 51);
    const json attributes = {{"POSITION", position}, {"NORMAL", normal}};
    file.doc["meshes"] =
        json::array({{{"primitives", json::array({{{"attributes", attributes}, {"indices", few}},
                                                  {{"attributes", attributes}, {"indices", many}}})}}});
    file.doc["nodes"] = json::array({{{"mesh", 0}}});
    const Scene scene = load(file);
    const Primitive& small = scene.meshes[0].primitives[0];
    ASSERT_EQ(small.positions.size(), 4u);
    EXPECT_EQ(small.indices, (std::vector<std::uint32_t>{2, 0, 1, 1, 0, 3}));
    const float x[] = {3, 40, 97, 98}, y[] = {1, -1, 1, -1};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(small.positions[i].x, x[i]);
        EXPECT_EQ(small.normals[i].y, y[i]);
    }
    EXPECT_EQ(scene.meshes[0].primitives[1].positions.size(), 100u);
    EXPECT_EQ(scene.meshes[0].primitives[1].indices[50], 50u);
}

/** Accessors of many blocks, which are decoded side by side. */
class LargeGltf {
public:
    static constexpr std::uint32_t vertices = 50000, triangles = 70000;
    static glm::vec3 position(std::uint32_t i) { return {float(i) * 0.25f, float(i % 977), -float(i)}; }
    static std::uint32_t index(std::uint32_t i) { return i < vertices ? i : (i * 31) % vertices; }

    /** Positions between two other floats each, normals of 8 bits, of which every 1000th is zero. */
    static GltfDocument document(std::uint32_t badVertex = vertices, std::uint32_t badIndex = 3 * triangles) {
        GltfDocument file = GltfDocument::triangle();
        std::vector<float> positions;
        std::vector<std::int8_t> normals;
        for (std::uint32_t i = 0; i < vertices; ++i) {
            const glm::vec3 p = position(i);
            const float y = i == badVertex ? std::numeric_limits<float>::infinity() : p.y;
            positions.insert(positions.end(), {-1.0f, p.x, y, p.z, -2.0f});
            const std::int8_t z = i % 1000 == 7 ? 0 : 100;
            normals.insert(normals.end(), {0, 0, z, 0});
        }
        std::vector<std::uint32_t> indices;
        for (std::uint32_t i = 0; i < 3 * triangles; ++i)
            indices.push_back(i == badIndex ? vertices : index(i));
        const int view = file.addView(packed(positions), 20), bytes = file.addView(packed(normals), 4);
        file.doc["accessors"][0] = {{"bufferView", view},
                                    {"byteOffset", 4},
                                    {"componentType", 5126},
                                    {"count", vertices},
                                    {"type", "VEC3"}};
        file.doc["accessors"].push_back({{"bufferView", bytes},
                                         {"componentType", 5120},
                                         {"normalized", true},
                                         {"count", vertices},
                                         {"type", "VEC3"}});
        file.primitive()["attributes"]["NORMAL"] = 1;
        file.primitive()["indices"] = file.addAccessor<std::uint32_t>(indices, "SCALAR", indices.size());
        return file;
    }
};

TEST_F(Gltf, LargeAccessorsAreWhatWasWritten) {
    const Scene scene = helio::load(write("large.glb", LargeGltf::document().glb()).string());
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    ASSERT_EQ(primitive.positions.size(), LargeGltf::vertices);
    ASSERT_EQ(primitive.indices.size(), 3 * LargeGltf::triangles);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < LargeGltf::vertices; ++i) {
        wrong += primitive.positions[i] != LargeGltf::position(i);
        wrong += i % 1000 != 7 && primitive.normals[i] != glm::vec3(0, 0, 1);
        wrong += std::abs(glm::length(primitive.normals[i]) - 1) > 1e-6f;
    }
    for (std::uint32_t i = 0; i < 3 * LargeGltf::triangles; ++i)
        wrong += primitive.indices[i] != LargeGltf::index(i);
    EXPECT_EQ(wrong, 0u);
}

TEST_F(Gltf, FaultsFarIntoAccessorsAreNamed) {
    const auto fault = [&](const GltfDocument& document) {
        try {
            helio::load(write("bad.glb", document.glb()).string());
        } catch (const InputError& error) {
            return error.fault;
        }
        return std::string();
    };
    EXPECT_EQ(fault(LargeGltf::document(43210)), "element 43210 of accessor 0 is not finite");
    EXPECT_EQ(fault(LargeGltf::document(LargeGltf::vertices, 123456)),
              "element 123456 is 50000, the primitive has 50000 vertices");
}

}  // namespace
}  // namespace helio::test
