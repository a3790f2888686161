#pragma once
/** @file Small glTF files made in a test. */
#include <heliograph/error.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace helio::test {

using nlohmann::json;
namespace fs = std::filesystem;

inline std::string base64(const std::string& bytes) {
    static const char* const alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) {
            text.push_back(i + k <= bytes.size() ? alphabet[bits >> (18 - 6 * k) & 63] : '=');
        }
    }
    return text;
}

template <class T>
std::string packed(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

template <class T>
constexpr int componentType() {
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
}

/** A document and its one buffer, which grows with every accessor. */
struct GltfDocument {
    json doc = {{"asset", {{"version", "2.0"}}}};
    std::string buffer;

    int addView(const std::string& bytes, int stride = 0) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
        if (stride != 0) view["byteStride"] = stride;
        buffer += bytes;
        doc["bufferViews"].push_back(view);
        return int(doc["bufferViews"].size()) - 1;
    }
    template <class T>
    int addAccessor(const std::vector<T>& values, const std::string& type, std::size_t count,
                    bool isNormalized = false) {
        json accessor = {{"bufferView", addView(packed(values))},
                         {"componentType", componentType<T>()},
                         {"count", count},
                         {"type", type}};
        if (isNormalized) accessor["normalized"] = true;
        doc["accessors"].push_back(accessor);
        return int(doc["accessors"].size()) - 1;
    }
    /** One triangle in node 0, with positions in accessor 0. */
    static GltfDocument triangle() {
        GltfDocument file;
        file.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
        file.doc["meshes"] =
            json::array({{{"primitives", json::array({{{"attributes", {{"POSITION", 0}}}}})}}});
        file.doc["nodes"] = json::array({{{"mesh", 0}}});
        file.doc["scenes"] = json::array({{{"nodes", {0}}}});
        return file;
    }
    json& primitive() { return doc["meshes"][0]["primitives"][0]; }
    json withInlineBuffer() const {
        json whole = doc;
        whole["buffers"] = json::array({{{"byteLength", buffer.size()},
                                         {"uri", "data:application/octet-stream;base64," + base64(buffer)}}});
        return whole;
    }
    std::string glb() const {
        json whole = doc;
        whole["buffers"] = json::array({{{"byteLength", buffer.size()}}});
        std::string text = whole.dump(), binary = buffer;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const std::uint32_t total = std::uint32_t(12 + 8 + text.size() + 8 + binary.size());
        return "glTF" + packed<std::uint32_t>({2, total, std::uint32_t(text.size())}) + "JSON" + text +
               packed<std::uint32_t>({std::uint32_t(binary.size())}) + std::string("BIN\0", 4) + binary;
    }
};

class Gltf : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("heliograph_gltf_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    Scene load(const json& document) const {
        return helio::load(write("test.gltf", document.dump()).string());
    }
    Scene load(const GltfDocument& file) const { return load(file.withInlineBuffer()); }

    /** The bytes of a PNG of one colour. */
    std::string png(float red, float green, float blue, std::uint32_t size = 2) const {
        ImageF image;
        image.width = image.height = size;
        image.channels = {"R", "G", "B"};
        for (std::uint32_t i = 0; i < size * size; ++i)
            image.data.insert(image.data.end(), {red, green, blue});
        saveImage(folder_ / "made.png", image);
        std::ifstream in(folder_ / "made.png", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    fs::path folder_;
};

/** What no place of a document expects: the wrong type, out of range, empty. */
inline const std::vector<nlohmann::json>& oddValues() {
    using nlohmann::json;
    static const std::vector<json> values{nullptr,
                                          true,
                                          -1,
                                          0,
                                          3,
                                          1e9,
                                          4294967296.0,
                                          1e300,
                                          -1e300,
                                          "",
                                          "x",
                                          json::array(),
                                          json{{"a", 1}},
                                          json::array({json::object()}),
                                          json::array({1, 2, 3})};
    return values;
}

/** Values of an animation's two keys. Those of a spline come with tangents of zero, so that it passes its
 * middle at the mean of its ends. */
inline std::vector<float> twoKeys(const std::vector<float>& first, const std::vector<float>& second,
                                  bool isSpline) {
    const std::vector<float> zero(first.size());
    std::vector<float> all;
    for (const auto& value : {first, second}) {
        if (isSpline) all.insert(all.end(), zero.begin(), zero.end());
        all.insert(all.end(), value.begin(), value.end());
        if (isSpline) all.insert(all.end(), zero.begin(), zero.end());
    }
    return all;
}

}  // namespace helio::test
