#include "engine/scene/gltf/accessors.hpp"

#include "engine/scene/gltf/uri.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** An accessor that has no data is all zeros: a count alone must not fill the memory. */
constexpr std::size_t maximumCountWithoutData = std::size_t(1) << 24;

/** tinygltf takes 1.0 for no integer, and cuts an extension's integers to 32 bits: all numbers are given to
 * it as the kind that it reads right. */
void adaptNumbers(json& value, bool isInExtension = false) {
    constexpr double exactIntegers = 9007199254740992.0;  // 2^53
    if (value.is_object()) {
        for (auto& [key, member] : value.items()) adaptNumbers(member, isInExtension || key == "extensions");
    } else if (value.is_array()) {
        for (json& element : value) adaptNumbers(element, isInExtension);
    } else if (isInExtension && value.is_number()) {
        value = value.get<double>();
    } else if (value.is_number_float()) {
        const double x = value.get<double>();
        if (x == std::floor(x) && std::abs(x) <= exactIntegers) value = std::int64_t(x);
    }
}

/** tinygltf gets the document without what it would load or decode by itself, and without what is not read
 * here. */
tinygltf::Model parseModel(const Container& container) {
    json document = json::object();
    for (const auto& [member, value] : container.document.items()) {
        const bool isLeftOut = member == "buffers" || member == "images" || member == "animations" ||
                               member == "skins" || member == "extras";
        if (!isLeftOut) document[member] = value;
    }
    adaptNumbers(document);
    const std::string text = document.dump();
    tinygltf::TinyGLTF parser;
    parser.RemoveImageLoader();
    tinygltf::Model model;
    std::string error, warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(), unsigned(text.size()), "")) {
        std::replace(error.begin(), error.end(), '\n', ' ');
        throw InputError(container.file, "", "is no glTF: " + error, "check the file with a glTF validator");
    }
    return model;
}

double component(const std::byte* from, int type) {
    const auto as = [from](auto value) {
        std::memcpy(&value, from, sizeof value);
        return double(value);
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return as(std::int8_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return as(std::uint8_t());
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return as(std::int16_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return as(std::uint16_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as(std::uint32_t());
        default:
            return as(float());
    }
}

/** glTF 2.0, section 3.11: what 1 is stored as, or 0 for a type that is not normalized. */
double normalizedOne(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 127;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 255;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 32767;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 65535;
        default:
            return 0;
    }
}

std::size_t sizeOfComponent(int type) {
    return std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(type)));
}

/** Whether `count` elements of `size`, `stride` apart, lie in `available` from `offset` on. No sum here
 * overflows: the schema keeps offsets below 2^48, counts below 2^31, and strides below 2^8. */
bool fits(std::size_t offset, std::size_t count, std::size_t stride, std::size_t size,
          std::size_t available) {
    return offset + (count - 1) * stride + size <= available;
}

}  // namespace

Asset::Asset(Container container) : container_(std::move(container)), model_(parseModel(container_)) {
    bytes_ = container_.size;
    const auto found = container_.document.find("buffers");
    if (found == container_.document.end()) return;
    std::map<std::string, std::span<const std::byte>> loaded;  // buffers of one URI are one
    for (std::size_t i = 0; i < found->size(); ++i) {
        json& buffer = (*found)[i];
        const auto length = buffer["byteLength"].get<std::size_t>();
        const std::string place = fmt::format("buffers[{}]", i);
        std::span<const std::byte> bytes;
        if (buffer.contains("uri")) {
            std::string& uri = buffer["uri"].get_ref<std::string&>();
            const auto known = loaded.find(uri);
            if (known != loaded.end()) {
                bytes = known->second;
            } else {
                bytes = owned_.emplace_back(readUri(file(), place + ".uri", folder(), uri));
                bytes_ += bytes.size();
                if (uri.starts_with("data:")) {
                    uri = std::string();  // a third more than its bytes, which are there now
                } else {
                    loaded.emplace(uri, bytes);
                }
            }
        } else if (i == 0 && container_.hasBinaryChunk) {
            bytes = container_.binaryChunk;
        } else {
            throw InputError(file(), place, "has neither a uri nor a GLB's binary chunk", "give it a uri");
        }
        if (bytes.size() < length) {
            throw InputError(file(), place + ".byteLength",
                             fmt::format("is {}, its data has {} bytes", length, bytes.size()),
                             "write the buffer again; it may be cut off");
        }
        buffers_.push_back(bytes.first(length));
    }
}

std::vector<std::string> Asset::misaligned() const {
    std::vector<std::string> places;
    for (std::size_t i = 0; i < model_.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = model_.accessors[i];
        if (accessor.bufferView < 0) continue;
        const tinygltf::BufferView& view = model_.bufferViews[std::size_t(accessor.bufferView)];
        const std::size_t size = sizeOfComponent(accessor.componentType);
        if (accessor.byteOffset % size != 0 || view.byteOffset % size != 0 || view.byteStride % size != 0)
            places.push_back(fmt::format("accessors[{}]", i));
    }
    return places;
}

std::filesystem::path Asset::folder() const {
    return std::filesystem::path(file()).parent_path();
}

std::span<const std::byte> Asset::bufferView(int index) const {
    const tinygltf::BufferView& view = model_.bufferViews[std::size_t(index)];
    const std::span<const std::byte> buffer = buffers_[std::size_t(view.buffer)];
    if (view.byteOffset + view.byteLength > buffer.size()) {
        throw InputError(file(), fmt::format("bufferViews[{}]", index),
                         fmt::format("ends at byte {}, its buffer at {}", view.byteOffset + view.byteLength,
                                     buffer.size()),
                         "keep byteOffset + byteLength within the buffer");
    }
    return buffer.subspan(view.byteOffset, view.byteLength);
}

struct Asset::Layout {
    const tinygltf::Accessor& accessor;
    std::size_t components;
    std::size_t componentSize;
    std::size_t size;  ///< bytes of an element
    std::size_t stride;
    std::span<const std::byte> base;  ///< from the first element on; empty for zeros
    std::span<const std::byte> sparseIndices, sparseValues;
};

Asset::Layout Asset::layout(int index) const {
    const tinygltf::Accessor& accessor = model_.accessors[std::size_t(index)];
    const auto refuse = [&](const char* member, std::string fault, const char* remedy) {
        throw InputError(file(), fmt::format("accessors[{}]{}", index, member), std::move(fault), remedy);
    };
    Layout layout{accessor,
                  std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type))),
                  sizeOfComponent(accessor.componentType),
                  0,
                  0,
                  {},
                  {},
                  {}};
    layout.size = layout.stride = layout.components * layout.componentSize;
    if (accessor.bufferView >= 0) {
        const auto bytes = bufferView(accessor.bufferView);
        const std::size_t viewStride = model_.bufferViews[std::size_t(accessor.bufferView)].byteStride;
        if (viewStride != 0) layout.stride = viewStride;
        if (layout.stride < layout.size) {
            refuse("", fmt::format("has elements of {} bytes every {}", layout.size, layout.stride),
                   "widen byteStride");
        }
        if (!fits(accessor.byteOffset, accessor.count, layout.stride, layout.size, bytes.size())) {
            refuse(".count",
                   fmt::format("is {}: the elements run over the end of their buffer view of {} bytes",
                               accessor.count, bytes.size()),
                   "keep the elements within the buffer view");
        }
        layout.base = bytes.subspan(accessor.byteOffset);
    } else if (accessor.count > maximumCountWithoutData) {
        refuse(".count", fmt::format("is {} without any data", accessor.count), "give it a bufferView");
    }
    if (!accessor.sparse.isSparse) return layout;
    const auto& sparse = accessor.sparse;
    const auto count = std::size_t(sparse.count);
    const auto indexBytes = bufferView(sparse.indices.bufferView),
               valueBytes = bufferView(sparse.values.bufferView);
    const auto indexOffset = std::size_t(sparse.indices.byteOffset),
               valueOffset = std::size_t(sparse.values.byteOffset);
    const std::size_t indexSize = sizeOfComponent(sparse.indices.componentType);
    if (!fits(indexOffset, count, indexSize, indexSize, indexBytes.size()) ||
        !fits(valueOffset, count, layout.size, layout.size, valueBytes.size())) {
        refuse(".sparse.count",
               fmt::format("is {}: the elements run over the end of their buffer view", count),
               "keep the elements within the buffer view");
    }
    layout.sparseIndices = indexBytes.subspan(indexOffset);
    layout.sparseValues = valueBytes.subspan(valueOffset);
    return layout;
}

bool Asset::isPacked(const Layout& layout) {
    return !layout.base.empty() && layout.stride == layout.size && !layout.accessor.sparse.isSparse;
}

void Asset::check(int accessor) const {
    layout(accessor);
}

template <class Store>
void Asset::read(int index, const Layout& layout, Store&& store) const {
    const tinygltf::Accessor& accessor = layout.accessor;
    const auto readElement = [&](std::size_t element, const std::byte* from) {
        for (std::size_t c = 0; c < layout.components; ++c) {
            store(element, c, component(from + c * layout.componentSize, accessor.componentType));
        }
    };
    if (!layout.base.empty()) {
        for (std::size_t i = 0; i < accessor.count; ++i) readElement(i, &layout.base[i * layout.stride]);
    }
    if (!accessor.sparse.isSparse) return;
    const int indexType = accessor.sparse.indices.componentType;
    const std::size_t indexSize = sizeOfComponent(indexType);
    for (std::size_t i = 0; i < std::size_t(accessor.sparse.count); ++i) {
        const double element = component(&layout.sparseIndices[i * indexSize], indexType);
        if (!(element < double(accessor.count))) {
            throw InputError(
                file(), fmt::format("accessors[{}].sparse.indices", index),
                fmt::format("has {} for element {}, the accessor has {}", element, i, accessor.count),
                "keep indices below the accessor's count");
        }
        readElement(std::size_t(element), &layout.sparseValues[i * layout.size]);
    }
}

void Asset::checkType(int index, int components, const std::string& place) const {
    const int type = components == 1    ? TINYGLTF_TYPE_SCALAR
                     : components == 16 ? TINYGLTF_TYPE_MAT4
                                        : components;  // VEC2 to VEC4 are named by their numbers
    if (model_.accessors[std::size_t(index)].type == type) return;
    throw InputError(file(), place, fmt::format("accessor {} has the wrong type", index),
                     "give an accessor of " + (components == 1    ? std::string("SCALAR")
                                               : components == 16 ? std::string("MAT4")
                                                                  : fmt::format("VEC{}", components)));
}

std::vector<float> Asset::floats(int index, int components, const std::string& place) const {
    checkType(index, components, place);
    layout(index);  // checked before memory is taken for what the count says
    std::vector<float> values(count(index) * std::size_t(components));
    floats(index, components, place, values);
    return values;
}

void Asset::floats(int index, int components, const std::string& place, std::span<float> values) const {
    const tinygltf::Accessor& accessor = model_.accessors[std::size_t(index)];
    checkType(index, components, place);
    const double one = accessor.normalized ? normalizedOne(accessor.componentType) : 0;
    const Layout from = layout(index);
    const auto refuse = [&](std::size_t element) {
        throw InputError(file(), place,
                         fmt::format("element {} of accessor {} is not finite", element, index),
                         "give finite numbers");
    };
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && isPacked(from)) {
        std::memcpy(values.data(), from.base.data(), values.size_bytes());
        const auto wrong =
            std::find_if_not(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
        if (wrong != values.end()) refuse(std::size_t(wrong - values.begin()) / std::size_t(components));
        return;
    }
    std::fill(values.begin(), values.end(), 0.0f);
    read(index, from, [&](std::size_t element, std::size_t c, double value) {
        if (!std::isfinite(value)) refuse(element);
        values[element * std::size_t(components) + c] = float(one > 0 ? std::max(value / one, -1.0) : value);
    });
}

void Asset::checkIndices(int index, const std::string& place) const {
    const tinygltf::Accessor& accessor = model_.accessors[std::size_t(index)];
    const bool isUnsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                            accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                            accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !isUnsigned) {
        throw InputError(file(), place, fmt::format("accessor {} has the wrong type", index),
                         "give a SCALAR accessor of unsigned integers");
    }
    layout(index);
}

std::vector<std::uint32_t> Asset::indices(int index, const std::string& place) const {
    checkIndices(index, place);
    const tinygltf::Accessor& accessor = model_.accessors[std::size_t(index)];
    const Layout from = layout(index);
    std::vector<std::uint32_t> values(accessor.count);
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT && isPacked(from)) {
        std::memcpy(values.data(), from.base.data(), values.size() * sizeof(std::uint32_t));
        return values;
    }
    read(index, from,
         [&](std::size_t element, std::size_t, double value) { values[element] = std::uint32_t(value); });
    return values;
}

}  // namespace helio::gltf
