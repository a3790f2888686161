#include "engine/scene/gltf/container.hpp"

#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace helio::gltf {
namespace {

std::uint32_t littleEndian32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

void parseInto(Container& container, std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    container.document = Document(container.file, text);
}

/** A GLB's header is magic, version, length; then chunks of length, type, data: JSON first, BIN second. */
void parseBinary(Container& container) {
    constexpr std::uint32_t jsonChunk = 0x4E4F534A, binChunk = 0x004E4942;
    const std::span<const std::byte> bytes(container.bytes);
    const auto fail = [&](const char* place, std::string fault) {
        throw InputError(container.file, place, std::move(fault), "write the GLB again; it may be cut off");
    };
    if (bytes.size() < 20)
        fail("header", fmt::format("has {} bytes, fewer than a GLB's smallest", bytes.size()));
    if (const auto version = littleEndian32(bytes, 4); version != 2) {
        throw InputError(container.file, "header", fmt::format("is of GLB version {}", version),
                         "give version 2");
    }
    const std::size_t length = littleEndian32(bytes, 8);
    if (length > bytes.size() || length < 20) {
        fail("header", fmt::format("says {} bytes, the file has {}", length, bytes.size()));
    }
    std::size_t at = 12;
    for (int index = 0; length - at >= 8; ++index) {
        const std::size_t size = littleEndian32(bytes, at);
        const std::uint32_t type = littleEndian32(bytes, at + 4);
        at += 8;
        if (size > length - at) fail(index == 0 ? "JSON chunk" : "BIN chunk", "is longer than the file");
        const auto content = bytes.subspan(at, size);
        if (index == 0) {
            if (type != jsonChunk) fail("first chunk", "is no JSON chunk");
            parseInto(container, content);
        } else if (index == 1 && type == binChunk) {
            container.binaryChunk = content;
            container.hasBinaryChunk = true;
        } else if (container.warnings.empty()) {
            container.warnings.push_back(fmt::format("chunk {} of the GLB is left out", index));
        }
        at += size;
    }
    if (at < bytes.size())
        container.warnings.push_back(
            fmt::format("{} bytes after the GLB's end are left out", bytes.size() - at));
}

}  // namespace

Container readContainer(const std::string& file) {
    Container container;
    container.file = file;
    container.bytes = readFile(file);
    if (container.bytes.empty())
        throw InputError(file, "", "is empty", "give a .gltf or .glb file, or write this one again");
    const std::string_view text(reinterpret_cast<const char*>(container.bytes.data()),
                                container.bytes.size());
    if (text.starts_with("glTF")) {
        parseBinary(container);
    } else {
        parseInto(container, container.bytes);
    }
    return container;
}

}  // namespace helio::gltf
