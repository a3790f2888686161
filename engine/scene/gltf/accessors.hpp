#pragma once
/** @file The numbers in a glTF file's buffers. */
#include "engine/scene/gltf/container.hpp"
#include "engine/scene/gltf/lists.hpp"

#include <cstdint>
#include <list>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace helio::gltf {

/** A document on its way to a Scene: container, typed lists, buffers in memory. */
class Asset {
public:
    /** Takes a container whose schema is checked. Loads the buffers. Throws InputError. */
    explicit Asset(Container container);
    Asset(const Asset&) = delete;  // its buffers lie in it
    Asset& operator=(const Asset&) = delete;

    const std::string& file() const { return container_.file; }
    const Document& document() const { return container_.document; }
    const Accessor& accessor(int index) const { return accessors_[std::size_t(index)]; }

    /** The bytes of a buffer view; checked against its buffer. */
    std::span<const std::byte> bufferView(int index) const;

    /** An accessor's numbers as floats, `components` per element (1 a SCALAR, 2 to 4 a VEC, 16 a MAT4):
     * integers as they are, or scaled to 0..1 or -1..1 where normalized. Every number is finite. `place` and
     * the types' names are for messages. */
    std::vector<float> floats(int accessor, int components, const std::string& place) const;
    /** The same, into memory for as many. */
    void floats(int accessor, int components, const std::string& place, std::span<float> values) const;
    /** The elements `chosen`, which are below the accessor's count and ascend. */
    std::vector<float> floats(int accessor, int components, const std::string& place,
                              std::span<const std::uint32_t> chosen) const;
    /** An accessor of unsigned integers. */
    std::vector<std::uint32_t> indices(int accessor, const std::string& place) const;
    /** What is odd about the file and the accessors read so far. */
    std::vector<std::string> remarks() const;
    /** Places of accessors whose components do not lie at multiples of their size, as glTF wants it. */
    std::vector<std::string> misaligned() const;
    /** Bytes of the file and of its buffers: what it may unfold to is in proportion. */
    std::size_t bytes() const { return bytes_; }
    /** Bytes that the asset's own lists take. */
    std::size_t listBytes() const {
        return views_.size() * sizeof(BufferView) + accessors_.size() * sizeof(Accessor);
    }
    /** A URI of the document, as it is in the text. */
    std::string_view uri(const std::string& value) const {
        return container_.document.longString(value).value_or(value);
    }
    /** Bytes of the buffers that an accessor reads; 0 for one without data. */
    std::size_t dataBytes(int accessor) const;
    /** Refuses an accessor whose elements do not all lie in its buffers: its count may then be trusted. */
    void check(int accessor) const;
    /** The same for one that must hold indices. */
    void checkIndices(int accessor, const std::string& place) const;
    std::size_t count(int accessor) const { return accessors_[std::size_t(accessor)].count; }

private:
    struct Layout;
    /** Where an accessor's elements lie, all within their buffers. */
    Layout layout(int accessor) const;
    void checkType(int accessor, int components, const std::string& place) const;
    [[noreturn]] void refuseElement(int accessor, const std::string& place, std::size_t element) const;
    /** Whether the elements lie as they are wanted, one after the other. */
    static bool isPacked(const Layout& layout);
    /** Calls store(element, component, number), for several elements side by side. */
    template <class Store>
    void read(int accessor, const Layout& layout, Store&& store) const;

    Container container_;
    std::vector<BufferView> views_;
    std::vector<Accessor> accessors_;
    std::list<std::vector<std::byte>> owned_;          ///< of buffers that are not in the file
    std::vector<std::span<const std::byte>> buffers_;  ///< into owned_ or the file
    std::size_t bytes_ = 0;
    void note(std::string oddAccessor) const {
        const std::scoped_lock lock(oddMutex_);
        oddAccessors_.insert(std::move(oddAccessor));
    }
    mutable std::mutex oddMutex_;
    mutable std::set<std::string> oddAccessors_;
};

}  // namespace helio::gltf
