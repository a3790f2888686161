#include "tests/unit/gltf/corpus.hpp"

#include <limits>

namespace helio::test {
namespace {

template <class T>
const char* typeName() {
    if constexpr (std::is_same_v<T, std::int8_t>) return "byte";
    if constexpr (std::is_same_v<T, std::uint8_t>) return "ubyte";
    if constexpr (std::is_same_v<T, std::int16_t>) return "short";
    if constexpr (std::is_same_v<T, std::uint16_t>) return "ushort";
    if constexpr (std::is_same_v<T, std::uint32_t>) return "uint";
    return "float";
}

/** What 1 is stored as. */
template <class T>
T one() {
    if constexpr (std::is_same_v<T, float>) {
        return 1;
    } else {
        return std::numeric_limits<T>::max();
    }
}

template <class T>
void addIndices(std::vector<CorpusFile>& files) {
    GltfDocument file = boundedTriangle();
    file.primitive()["indices"] = file.addAccessor<T>({2, 0, 1}, "SCALAR", 3);
    files.push_back({std::string("indices_") + typeName<T>(), file, [](const Scene& scene) {
                         EXPECT_EQ(firstPrimitive(scene).indices, (std::vector<std::uint32_t>{2, 0, 1}));
                     }});
}

/** Positions, normals and coordinates of T, as KHR_mesh_quantization allows. */
template <class T>
void addQuantized(std::vector<CorpusFile>& files, bool isNormalized) {
    GltfDocument file;
    const T most = one<T>();
    const std::vector<T> positions{0, 0, 0, most, 0, 0, 0, most, 0};
    withBounds(file, addVertices(file, positions, 3, isNormalized), positions, 3);
    json attributes = {{"POSITION", 0}};
    const bool isSigned = std::is_signed_v<T>;
    if (isSigned && isNormalized)
        attributes["NORMAL"] = addVertices<T>(file, {0, 0, most, 0, 0, most, 0, 0, most}, 3, true);
    attributes["TEXCOORD_0"] = addVertices<T>(file, {0, 0, most, 0, 0, most}, 2, isNormalized);
    file.doc["meshes"] = json::array({{{"primitives", json::array({{{"attributes", attributes}}})}}});
    file.doc["nodes"] = json::array({{{"mesh", 0}}});
    file.doc["scenes"] = json::array({{{"nodes", {0}}}});
    use(file, "KHR_mesh_quantization", true);
    const float value = isNormalized ? 1.0f : float(most);
    files.push_back({std::string("quantized_") + typeName<T>() + (isNormalized ? "_normalized" : ""), file,
                     [value, isSigned, isNormalized](const Scene& scene) {
                         const Primitive& primitive = firstPrimitive(scene);
                         EXPECT_EQ(primitive.positions[1], glm::vec3(value, 0, 0));
                         EXPECT_EQ(primitive.positions[2], glm::vec3(0, value, 0));
                         EXPECT_EQ(primitive.texcoords.at(0)[2], glm::vec2(0, value));
                         if (isSigned && isNormalized) {
                             EXPECT_EQ(primitive.normals.at(1), glm::vec3(0, 0, 1));
                         }
                     }});
}

template <class T>
void addColors(std::vector<CorpusFile>& files, std::size_t components) {
    GltfDocument file = boundedTriangle();
    std::vector<T> values(components * 3);
    values[0] = one<T>();
    values[components + 1] = one<T>();
    if (components == 4) values[3] = one<T>();
    file.primitive()["attributes"]["COLOR_0"] =
        addVertices(file, values, components, !std::is_same_v<T, float>);
    files.push_back({std::string("color_") + typeName<T>() + std::to_string(components), file,
                     [components](const Scene& scene) {
                         const float alpha = components == 3 ? 1.0f : 0.0f;
                         EXPECT_EQ(firstPrimitive(scene).colors.at(0), glm::vec4(1, 0, 0, 1));
                         EXPECT_EQ(firstPrimitive(scene).colors.at(1), glm::vec4(0, 1, 0, alpha));
                     }});
}

template <class T>
void addTexcoords(std::vector<CorpusFile>& files) {
    GltfDocument file = boundedTriangle();
    // Five sets, each with its number in u.
    for (int set = 0; set < 5; ++set) {
        const T u = std::is_same_v<T, float> ? T(set) : T(set * (one<T>() / 5));
        file.primitive()["attributes"]["TEXCOORD_" + std::to_string(set)] =
            addVertices<T>(file, {u, 0, u, 0, u, one<T>()}, 2, !std::is_same_v<T, float>);
    }
    files.push_back({std::string("texcoord_") + typeName<T>(), file, [](const Scene& scene) {
                         const auto& sets = firstPrimitive(scene).texcoords;
                         ASSERT_EQ(sets.size(), 5u);
                         const float step = std::is_same_v<T, float> ? 1.0f : 0.2f;
                         for (int set = 0; set < 5; ++set) {
                             EXPECT_FLOAT_EQ(sets[std::size_t(set)][0].x, step * float(set));
                             EXPECT_EQ(sets[std::size_t(set)][2].y, 1);
                         }
                     }});
}

/** An accessor of which one element is replaced: values of T, the place given as Index. */
template <class T, class Index>
void addSparse(std::vector<CorpusFile>& files, bool hasBase) {
    GltfDocument file = boundedTriangle();
    const std::size_t stride = (2 * sizeof(T) + 3) / 4 * 4;
    json accessor = {{"componentType", componentType<T>()}, {"count", 3}, {"type", "VEC2"}};
    if (!std::is_same_v<T, float>) accessor["normalized"] = true;
    if (hasBase) {
        std::string bytes(stride * 3, '\0');
        for (std::size_t i = 0; i < 3; ++i) {
            const T most = one<T>();
            std::memcpy(&bytes[i * stride], &most, sizeof(T));
        }
        accessor["bufferView"] = file.addView(bytes, stride == 2 * sizeof(T) ? 0 : int(stride));
    }
    const int indices = file.addView(packed<Index>({1})), values = file.addView(packed<T>({0, one<T>()}));
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", indices}, {"componentType", componentType<Index>()}}},
                          {"values", {{"bufferView", values}}}};
    file.doc["accessors"].push_back(accessor);
    file.primitive()["attributes"]["TEXCOORD_0"] = 1;
    if (std::is_signed_v<T> && !std::is_same_v<T, float>) use(file, "KHR_mesh_quantization", true);
    files.push_back(
        {std::string("sparse_") + typeName<T>() + "_at_" + typeName<Index>() + (hasBase ? "" : "_of_zeros"),
         file, [hasBase](const Scene& scene) {
             const auto& uv = firstPrimitive(scene).texcoords.at(0);
             EXPECT_EQ(uv[0], glm::vec2(hasBase ? 1 : 0, 0));
             EXPECT_EQ(uv[1], glm::vec2(0, 1));
             EXPECT_EQ(uv[2], uv[0]);
         }});
}

void addInterleaved(std::vector<CorpusFile>& files) {
    GltfDocument file;
    std::vector<float> data;
    for (int v = 0; v < 3; ++v)
        data.insert(data.end(), {float(v == 1), float(v == 2), 0, 0, 0, 1, 0.25f * float(v), 1});
    const int view = file.addView(packed(data), 32);
    const auto add = [&](int offset, const char* type) {
        file.doc["accessors"].push_back({{"bufferView", view},
                                         {"byteOffset", offset},
                                         {"componentType", 5126},
                                         {"count", 3},
                                         {"type", type}});
    };
    add(0, "VEC3"), add(12, "VEC3"), add(24, "VEC2");
    file.doc["accessors"][0]["min"] = {0, 0, 0};
    file.doc["accessors"][0]["max"] = {1, 1, 0};
    file.doc["meshes"] =
        json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}])");
    file.doc["nodes"] = json::array({{{"mesh", 0}}});
    file.doc["scenes"] = json::array({{{"nodes", {0}}}});
    files.push_back({"interleaved", file, [](const Scene& scene) {
                         EXPECT_EQ(firstPrimitive(scene).positions[2], glm::vec3(0, 1, 0));
                         EXPECT_EQ(firstPrimitive(scene).normals[1], glm::vec3(0, 0, 1));
                         EXPECT_EQ(firstPrimitive(scene).texcoords[0][2], glm::vec2(0.5f, 1));
                     }});
}

void addModes(std::vector<CorpusFile>& files) {
    for (int mode : {4, 5, 6}) {
        GltfDocument file;
        const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0};
        withBounds(file, file.addAccessor(positions, "VEC3", 6), positions, 3);
        const json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
        file.doc["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
        file.doc["nodes"] = json::array({{{"mesh", 0}}});
        file.doc["scenes"] = json::array({{{"nodes", {0}}}});
        static const char* const names[] = {"triangles", "triangle_strip", "triangle_fan"};
        const std::vector<std::uint32_t> expected[] = {
            {0, 1, 2, 3, 4, 5}, {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}, {1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0}};
        files.push_back({names[mode - 4], file, [indices = expected[mode - 4]](const Scene& scene) {
                             EXPECT_EQ(firstPrimitive(scene).indices, indices);
                         }});
    }
}

template <class Index>
void addSparseOfEveryType(std::vector<CorpusFile>& files) {
    for (bool hasBase : {true, false}) {
        addSparse<std::int8_t, Index>(files, hasBase);
        addSparse<std::uint8_t, Index>(files, hasBase);
        addSparse<std::int16_t, Index>(files, hasBase);
        addSparse<std::uint16_t, Index>(files, hasBase);
        addSparse<float, Index>(files, hasBase);
    }
}

}  // namespace

void addAccessorFiles(std::vector<CorpusFile>& files) {
    addIndices<std::uint8_t>(files);
    addIndices<std::uint16_t>(files);
    addIndices<std::uint32_t>(files);
    for (bool isNormalized : {false, true}) {
        addQuantized<std::int8_t>(files, isNormalized);
        addQuantized<std::uint8_t>(files, isNormalized);
        addQuantized<std::int16_t>(files, isNormalized);
        addQuantized<std::uint16_t>(files, isNormalized);
    }
    for (std::size_t components : {3, 4}) {
        addColors<float>(files, components);
        addColors<std::uint8_t>(files, components);
        addColors<std::uint16_t>(files, components);
    }
    addTexcoords<float>(files);
    addTexcoords<std::uint8_t>(files);
    addTexcoords<std::uint16_t>(files);
    addSparseOfEveryType<std::uint8_t>(files);
    addSparseOfEveryType<std::uint16_t>(files);
    addSparseOfEveryType<std::uint32_t>(files);
    addInterleaved(files);
    addModes(files);
}

}  // namespace helio::test
