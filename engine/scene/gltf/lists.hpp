#pragma once
/** @file What is looked up by index again and again, in a typed form. The rest is read from the JSON. */
#include "engine/scene/gltf/json_reader.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace helio::gltf {

/** An accessor's componentType (glTF 2.0, section 3.6.2.2). */
enum class Component : int {
    Byte = 5120,
    UnsignedByte = 5121,
    Short = 5122,
    UnsignedShort = 5123,
    UnsignedInt = 5125,
    Float = 5126
};
std::size_t sizeOf(Component component);

/** A primitive's mode (section 3.7.2.1). */
enum class Mode : int { Points, Lines, LineLoop, LineStrip, Triangles, TriangleStrip, TriangleFan };

struct BufferView {
    int buffer = 0;
    std::size_t byteOffset = 0, byteLength = 0;
    std::size_t byteStride = 0;  ///< 0: the elements are packed
};

struct Sparse {
    std::size_t count = 0;
    int indexView = 0, valueView = 0;
    std::size_t indexOffset = 0, valueOffset = 0;
    Component indexType = Component::UnsignedByte;
};

struct Accessor {
    int bufferView = -1;  ///< -1: all zero, but for the sparse elements
    Component component = Component::Float;
    int components = 1;  ///< of an element: 1 a SCALAR, 2 to 4 a VEC, 4, 9 or 16 a matrix
    bool isMatrix = false;
    bool isNormalized = false;
    std::size_t byteOffset = 0, count = 0;
    std::optional<Sparse> sparse;
};

/** Of a document whose schema is checked. */
std::vector<BufferView> bufferViewsOf(const Document& document);
std::vector<Accessor> accessorsOf(const Document& document);

/** A member that is a list; an empty one where there is none. */
const nlohmann::json& listOf(const nlohmann::json& object, const char* name);
/** A member that is an index or another integer. */
int integerOr(const nlohmann::json& object, const char* member, int fallback);
double numberOr(const nlohmann::json& object, const char* member, double fallback);
/** An extension of an object; nullptr where it has none of that name. */
const nlohmann::json* extensionOf(const nlohmann::json& object, const char* name);
/** All extensions of an object. */
const nlohmann::json& extensionsOf(const nlohmann::json& object);

template <class Vector>
Vector vectorOr(const nlohmann::json& object, const char* member, Vector fallback) {
    const auto found = object.find(member);
    if (found == object.end()) return fallback;
    for (int i = 0; i < fallback.length(); ++i) fallback[i] = (*found)[std::size_t(i)].get<float>();
    return fallback;
}

}  // namespace helio::gltf
