#include "engine/image/decoder_memory.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace helio {
namespace {

class Bytes {
public:
    explicit Bytes(std::span<const std::byte> file) : file_(file) {}
    std::size_t size() const { return file_.size(); }
    /** 0 past the end. */
    std::uint32_t at(std::size_t i) const {
        return i < file_.size() ? std::to_integer<std::uint32_t>(file_[i]) : 0;
    }
    std::uint32_t big16(std::size_t i) const { return at(i) << 8 | at(i + 1); }
    std::uint32_t big32(std::size_t i) const { return big16(i) << 16 | big16(i + 2); }
    std::uint32_t little16(std::size_t i) const { return at(i) | at(i + 1) << 8; }
    std::uint32_t little32(std::size_t i) const {
        return at(i) | at(i + 1) << 8 | at(i + 2) << 16 | at(i + 3) << 24;
    }
    bool has(const char* text, std::size_t i) const {
        const std::size_t length = std::strlen(text);
        return i + length <= size() && std::memcmp(&file_[i], text, length) == 0;
    }

private:
    std::span<const std::byte> file_;
};

/** ISO 15948, 11.2.2. */
DecoderMemory pngMemory(const Bytes& file) {
    DecoderMemory memory{0, file.big32(16), file.big32(20)};
    const std::uint32_t depth = file.at(24), color = file.at(25), interlace = file.at(28);
    if (depth == 16) memory.texel = 8;
    if (interlace == 0) return memory;
    constexpr std::uint64_t rgba = 4;  // as a palette or a transparent colour may become
    const std::uint64_t channels = color == 4 ? 2 : rgba, bytes = depth == 16 ? 2 : 1;
    memory.bytes = std::uint64_t(memory.width) * memory.height * channels * bytes;
    return memory;
}

/** ITU-T T.81, annex B: marker segments up to the first scan. */
DecoderMemory jpegMemory(const Bytes& file) {
    DecoderMemory memory;
    std::uint64_t coefficients = 0;
    std::uint32_t components = 0;
    bool isProgressive = false;
    for (std::size_t at = 2; at + 4 <= file.size();) {
        if (file.at(at) != 0xff) {  // between segments; a decoder goes on to the next marker
            ++at;
            continue;
        }
        const std::uint32_t marker = file.at(at + 1);
        if (marker == 0xff) {
            ++at;
            continue;
        }
        if (marker == 0 || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd9)) {
            at += 2;
            continue;
        }
        const bool isFrame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (isFrame) {
            memory.height = file.big16(at + 5);
            memory.width = file.big16(at + 7);
            components = file.at(at + 9);
            isProgressive = (marker & 3) == 2;
            std::uint32_t widest = 1, highest = 1;
            for (std::uint32_t c = 0; c < components; ++c) {
                widest = std::max(widest, file.at(at + 11 + 3 * c) >> 4);
                highest = std::max(highest, file.at(at + 11 + 3 * c) & 15);
            }
            coefficients = 0;
            for (std::uint32_t c = 0; c < components; ++c) {
                // Blocks of 64 coefficients of 16 bits, in whole units of all components.
                const std::uint64_t across = (memory.width + 8 * widest - 1) / (8 * widest),
                                    down = (memory.height + 8 * highest - 1) / (8 * highest);
                const std::uint32_t sampling = file.at(at + 11 + 3 * c);
                coefficients += across * (sampling >> 4) * down * (sampling & 15) * 128;
            }
        }
        if (marker == 0xda) {
            if (isProgressive || file.at(at + 4) < components) memory.bytes = coefficients;
            return memory;
        }
        at += 2 + std::max<std::size_t>(file.big16(at + 2), 2);
    }
    return memory;
}

/** RFC 9649: chunks from byte 12 on; a lossless one has its size in 14 bits each after a signature byte, a
 * lossy one after three bytes of tag and three of start code (RFC 6386, 9.1). */
DecoderMemory webpMemory(const Bytes& file) {
    for (std::size_t at = 12; at + 8 <= file.size();) {
        if (file.has("VP8L", at)) {
            const std::uint32_t bits = file.little32(at + 9);
            DecoderMemory memory{0, (bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1};
            memory.bytes = std::uint64_t(memory.width) * memory.height * 4;
            return memory;
        }
        if (file.has("VP8 ", at))
            return {0, file.little16(at + 14) & 0x3fff, file.little16(at + 16) & 0x3fff};
        const std::size_t size = file.little32(at + 4);
        at += 8 + size + size % 2;
    }
    return {};
}

/** Windows' BITMAPINFOHEADER: one compressed by run lengths is unfolded when it is opened. */
DecoderMemory bmpMemory(const Bytes& file) {
    const std::uint32_t compression = file.little32(30);
    if (compression != 1 && compression != 2) return {};
    const auto height = std::int32_t(file.little32(22));  // negative: from the top
    DecoderMemory memory{0, file.little32(18),
                         height < 0 ? 0u - std::uint32_t(height) : std::uint32_t(height)};
    memory.bytes = std::uint64_t(memory.width) * memory.height;
    return memory;
}

}  // namespace

DecoderMemory decoderMemory(std::span<const std::byte> file) {
    const Bytes bytes(file);
    if (bytes.has("\x89PNG", 0)) return pngMemory(bytes);
    if (bytes.has("\xff\xd8", 0)) return jpegMemory(bytes);
    if (bytes.has("BM", 0)) return bmpMemory(bytes);
    return bytes.has("RIFF", 0) ? webpMemory(bytes) : DecoderMemory{};
}

}  // namespace helio
