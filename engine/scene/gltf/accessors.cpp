#include "engine/scene/gltf/accessors.hpp"

#include "engine/scene/gltf/uri.hpp"
#include "engine/scene/parallel.hpp"

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

double component(const std::byte* from, Component type) {
    const auto as = [from](auto value) {
        std::memcpy(&value, from, sizeof value);
        return double(value);
    };
    switch (type) {
        case Component::Byte:
            return as(std::int8_t());
        case Component::UnsignedByte:
            return as(std::uint8_t());
        case Component::Short:
            return as(std::int16_t());
        case Component::UnsignedShort:
            return as(std::uint16_t());
        case Component::UnsignedInt:
            return as(std::uint32_t());
        default:
            return as(float());
    }
}

/** glTF 2.0, section 3.11: what 1 is stored as, or 0 for a type that is not normalized. */
double normalizedOne(Component type) {
    switch (type) {
        case Component::Byte:
            return 127;
        case Component::UnsignedByte:
            return 255;
        case Component::Short:
            return 32767;
        case Component::UnsignedShort:
            return 65535;
        default:
            return 0;
    }
}

/** Whether `count` elements of `size`, `stride` apart, lie in `available` from `offset` on. No sum here
 * overflows: the schema keeps offsets below 2^48, counts below 2^31, and strides below 2^8. */
bool fits(std::size_t offset, std::size_t count, std::size_t stride, std::size_t size,
          std::size_t available) {
    return offset + (count - 1) * stride + size <= available;
}

}  // namespace

Asset::Asset(Container container)
    : container_(std::move(container)),
      views_(bufferViewsOf(container_.document)),
      accessors_(accessorsOf(container_.document)) {
    bytes_ = container_.bytes.size();
    std::map<std::string, std::span<const std::byte>> loaded;  // buffers of one URI are one
    for (std::size_t i = 0; i < document().size("buffers"); ++i) {
        const json buffer = document().element("buffers", i);
        const auto length = buffer["byteLength"].get<std::size_t>();
        const std::string place = fmt::format("buffers[{}]", i);
        std::span<const std::byte> bytes;
        if (buffer.contains("uri")) {
            const auto& uri = buffer["uri"].get_ref<const std::string&>();
            const auto known = loaded.find(uri);
            if (known != loaded.end()) {
                bytes = known->second;
            } else {
                bytes = owned_.emplace_back(readUri(file(), place + ".uri", this->uri(uri)));
                bytes_ += bytes.size();
                if (!uri.starts_with("data:")) loaded.emplace(uri, bytes);
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

std::vector<std::string> Asset::remarks() const {
    std::vector<std::string> remarks = container_.warnings;
    remarks.insert(remarks.end(), oddAccessors_.begin(), oddAccessors_.end());
    return remarks;
}

std::vector<std::string> Asset::misaligned() const {
    std::vector<std::string> places;
    for (std::size_t i = 0; i < accessors_.size(); ++i) {
        const Accessor& accessor = accessors_[i];
        if (accessor.bufferView < 0) continue;
        const BufferView& view = views_[std::size_t(accessor.bufferView)];
        const std::size_t size = sizeOf(accessor.component);
        if (accessor.byteOffset % size != 0 || view.byteOffset % size != 0 || view.byteStride % size != 0)
            places.push_back(fmt::format("accessors[{}]", i));
    }
    return places;
}

std::span<const std::byte> Asset::bufferView(int index) const {
    const BufferView& view = views_[std::size_t(index)];
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
    const Accessor& accessor;
    std::size_t components;
    std::size_t componentSize;
    std::size_t size;  ///< bytes of an element
    std::size_t stride;
    std::span<const std::byte> base;  ///< from the first element on; empty for zeros
    std::span<const std::byte> sparseIndices, sparseValues;
};

Asset::Layout Asset::layout(int index) const {
    const Accessor& accessor = accessors_[std::size_t(index)];
    const auto refuse = [&](const char* member, std::string fault, const char* remedy) {
        throw InputError(file(), fmt::format("accessors[{}]{}", index, member), std::move(fault), remedy);
    };
    Layout layout{accessor, std::size_t(accessor.components), sizeOf(accessor.component), 0, 0, {}, {}, {}};
    layout.size = layout.stride = layout.components * layout.componentSize;
    if (accessor.bufferView >= 0) {
        const auto bytes = bufferView(accessor.bufferView);
        const std::size_t viewStride = views_[std::size_t(accessor.bufferView)].byteStride;
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
    if (!accessor.sparse) return layout;
    const Sparse& sparse = *accessor.sparse;
    const std::size_t count = sparse.count;
    const auto indexBytes = bufferView(sparse.indexView), valueBytes = bufferView(sparse.valueView);
    const std::size_t indexSize = sizeOf(sparse.indexType);
    if (!fits(sparse.indexOffset, count, indexSize, indexSize, indexBytes.size()) ||
        !fits(sparse.valueOffset, count, layout.size, layout.size, valueBytes.size())) {
        refuse(".sparse.count",
               fmt::format("is {}: the elements run over the end of their buffer view", count),
               "keep the elements within the buffer view");
    }
    for (const int view : {sparse.indexView, sparse.valueView}) {
        if (views_[std::size_t(view)].byteStride != 0)
            note(fmt::format("accessors[{}].sparse: byteStride is left out, its elements are packed", index));
    }
    layout.sparseIndices = indexBytes.subspan(sparse.indexOffset);
    layout.sparseValues = valueBytes.subspan(sparse.valueOffset);
    return layout;
}

bool Asset::isPacked(const Layout& layout) {
    return !layout.base.empty() && layout.stride == layout.size && !layout.accessor.sparse;
}

std::size_t Asset::dataBytes(int index) const {
    const Accessor& accessor = this->accessor(index);
    return accessor.bufferView < 0
               ? 0
               : accessor.count * std::size_t(accessor.components) * sizeOf(accessor.component);
}

void Asset::check(int accessor) const {
    layout(accessor);
}

template <class Store>
void Asset::read(int index, const Layout& layout, Store&& store) const {
    const Accessor& accessor = layout.accessor;
    const auto readElement = [&](std::size_t element, const std::byte* from) {
        for (std::size_t c = 0; c < layout.components; ++c) {
            store(element, c, component(from + c * layout.componentSize, accessor.component));
        }
    };
    if (!layout.base.empty()) {
        forBlocks(accessor.count, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) readElement(i, &layout.base[i * layout.stride]);
        });
    }
    if (!accessor.sparse) return;
    const Component indexType = accessor.sparse->indexType;
    const std::size_t indexSize = sizeOf(indexType);
    double last = -1;
    for (std::size_t i = 0; i < accessor.sparse->count; ++i) {
        const double element = component(&layout.sparseIndices[i * indexSize], indexType);
        if (element <= last) note(fmt::format("accessors[{}].sparse.indices do not ascend", index));
        last = element;
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
    const Accessor& accessor = accessors_[std::size_t(index)];
    if (accessor.components == components && accessor.isMatrix == (components == 16)) return;
    throw InputError(file(), place, fmt::format("accessor {} has the wrong type", index),
                     "give an accessor of " + (components == 1    ? std::string("SCALAR")
                                               : components == 16 ? std::string("MAT4")
                                                                  : fmt::format("VEC{}", components)));
}

void Asset::refuseElement(int index, const std::string& place, std::size_t element) const {
    throw InputError(file(), place, fmt::format("element {} of accessor {} is not finite", element, index),
                     "give finite numbers");
}

std::vector<float> Asset::floats(int index, int components, const std::string& place) const {
    checkType(index, components, place);
    layout(index);  // checked before memory is taken for what the count says
    std::vector<float> values(count(index) * std::size_t(components));
    floats(index, components, place, values);
    return values;
}

void Asset::floats(int index, int components, const std::string& place, std::span<float> values) const {
    const Accessor& accessor = accessors_[std::size_t(index)];
    checkType(index, components, place);
    const double one = accessor.isNormalized ? normalizedOne(accessor.component) : 0;
    const Layout from = layout(index);
    if (accessor.component == Component::Float && isPacked(from)) {
        forBlocks(values.size(), [&](std::size_t begin, std::size_t end) {
            std::memcpy(&values[begin], &from.base[begin * sizeof(float)], (end - begin) * sizeof(float));
        });
    } else {
        if (from.base.empty()) std::fill(values.begin(), values.end(), 0.0f);
        read(index, from, [&](std::size_t element, std::size_t c, double value) {
            values[element * std::size_t(components) + c] =
                float(one > 0 ? std::max(value / one, -1.0) : value);
        });
    }
    if (accessor.component != Component::Float) return;
    const std::size_t wrong =
        firstWhere(values.size(), [&](std::size_t i) { return !std::isfinite(values[i]); });
    if (wrong < values.size()) refuseElement(index, place, wrong / std::size_t(components));
}

std::vector<float> Asset::floats(int index, int components, const std::string& place,
                                 std::span<const std::uint32_t> chosen) const {
    const auto width = std::size_t(components);
    const Layout from = layout(index);
    std::vector<float> values(chosen.size() * width);
    if (from.accessor.sparse) {  // read whole: its elements lie in two places
        const std::vector<float> all = floats(index, components, place);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = all[chosen[i / width] * width + i % width];
        return values;
    }
    checkType(index, components, place);
    if (from.base.empty()) return values;
    const double one = from.accessor.isNormalized ? normalizedOne(from.accessor.component) : 0;
    forBlocks(values.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::byte* const element = &from.base[chosen[i / width] * from.stride];
            const double value = component(element + i % width * from.componentSize, from.accessor.component);
            values[i] = float(one > 0 ? std::max(value / one, -1.0) : value);
        }
    });
    const std::size_t wrong =
        firstWhere(values.size(), [&](std::size_t i) { return !std::isfinite(values[i]); });
    if (wrong < values.size()) refuseElement(index, place, chosen[wrong / width]);
    return values;
}

void Asset::checkIndices(int index, const std::string& place) const {
    const Accessor& accessor = accessors_[std::size_t(index)];
    const bool isUnsigned = accessor.component == Component::UnsignedByte ||
                            accessor.component == Component::UnsignedShort ||
                            accessor.component == Component::UnsignedInt;
    if (accessor.components != 1 || !isUnsigned) {
        throw InputError(file(), place, fmt::format("accessor {} has the wrong type", index),
                         "give a SCALAR accessor of unsigned integers");
    }
    layout(index);
}

std::vector<std::uint32_t> Asset::indices(int index, const std::string& place) const {
    checkIndices(index, place);
    const Accessor& accessor = accessors_[std::size_t(index)];
    const Layout from = layout(index);
    std::vector<std::uint32_t> values(accessor.count);
    if (accessor.component == Component::UnsignedInt && isPacked(from)) {
        forBlocks(values.size(), [&](std::size_t begin, std::size_t end) {
            std::memcpy(&values[begin], &from.base[begin * sizeof(std::uint32_t)],
                        (end - begin) * sizeof(std::uint32_t));
        });
        return values;
    }
    read(index, from,
         [&](std::size_t element, std::size_t, double value) { values[element] = std::uint32_t(value); });
    return values;
}

}  // namespace helio::gltf
