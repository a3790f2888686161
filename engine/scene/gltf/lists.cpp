#include "engine/scene/gltf/lists.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** Sizes are below 2^48 (the schema), whether the file has them as integers or as 1e3. */
std::size_t sizeOr(const json& object, const char* member, std::size_t fallback) {
    const auto found = object.find(member);
    return found == object.end() ? fallback : std::size_t(found->get<double>());
}

int componentsOf(std::string_view type) {
    constexpr std::pair<std::string_view, int> types[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, components] : types) {
        if (name == type) return components;
    }
    return 0;
}

/** The objects of a list, read side by side where they are small. */
template <class Object, class Read>
std::vector<Object> objectsOf(const Document& document, const char* list, Read&& read) {
    constexpr std::size_t smallText = std::size_t(1) << 16;
    std::vector<Object> objects(document.size(list));
    const std::size_t block =
        document.longest(list) <= smallText ? 256 : std::max<std::size_t>(objects.size(), 1);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, objects.size(), block), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) read(document.element(list, i), objects[i]);
    });
    return objects;
}

}  // namespace

std::size_t sizeOf(Component component) {
    switch (component) {
        case Component::Byte:
        case Component::UnsignedByte:
            return 1;
        case Component::Short:
        case Component::UnsignedShort:
            return 2;
        default:
            return 4;
    }
}

std::vector<BufferView> bufferViewsOf(const Document& document) {
    return objectsOf<BufferView>(document, "bufferViews", [](const json& from, BufferView& view) {
        view.buffer = integerOr(from, "buffer", 0);
        view.byteOffset = sizeOr(from, "byteOffset", 0);
        view.byteLength = sizeOr(from, "byteLength", 0);
        view.byteStride = sizeOr(from, "byteStride", 0);
    });
}

std::vector<Accessor> accessorsOf(const Document& document) {
    return objectsOf<Accessor>(document, "accessors", [](const json& from, Accessor& accessor) {
        const auto& type = from["type"].get_ref<const std::string&>();
        accessor.bufferView = integerOr(from, "bufferView", -1);
        accessor.component = Component(integerOr(from, "componentType", 0));
        accessor.components = componentsOf(type);
        accessor.isMatrix = type.starts_with("MAT");
        accessor.isNormalized = from.value("normalized", false);
        accessor.byteOffset = sizeOr(from, "byteOffset", 0);
        accessor.count = sizeOr(from, "count", 0);
        const auto found = from.find("sparse");
        if (found == from.end()) return;
        Sparse& sparse = accessor.sparse.emplace();
        const json &indices = (*found)["indices"], &values = (*found)["values"];
        sparse.count = sizeOr(*found, "count", 0);
        sparse.indexView = integerOr(indices, "bufferView", 0);
        sparse.indexOffset = sizeOr(indices, "byteOffset", 0);
        sparse.indexType = Component(integerOr(indices, "componentType", 0));
        sparse.valueView = integerOr(values, "bufferView", 0);
        sparse.valueOffset = sizeOr(values, "byteOffset", 0);
    });
}

const json& listOf(const json& object, const char* name) {
    static const json empty = json::array();
    const auto found = object.find(name);
    return found == object.end() ? empty : *found;
}

int integerOr(const json& object, const char* member, int fallback) {
    const auto found = object.find(member);
    return found == object.end() ? fallback : int(found->get<double>());
}

double numberOr(const json& object, const char* member, double fallback) {
    const auto found = object.find(member);
    return found == object.end() ? fallback : found->get<double>();
}

const json& extensionsOf(const json& object) {
    static const json empty = json::object();
    const auto found = object.find("extensions");
    return found == object.end() ? empty : *found;
}

const json* extensionOf(const json& object, const char* name) {
    const json& extensions = extensionsOf(object);
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &*found;
}

}  // namespace helio::gltf
