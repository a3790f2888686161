/** @file What is known of an image file before a module decodes it. */
#include "engine/image/backend.hpp"
#include "engine/image/decoder_memory.hpp"

#include <array>
#include <cstring>
#include <string_view>

namespace helio {
namespace {

constexpr std::array<unsigned char, 8> pngMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> jpegMagic{0xff, 0xd8, 0xff};

std::uint32_t bigEndian32(const std::byte* bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    return value;
}

/** The checksum of PNG (ISO 15948, annex D). */
std::uint32_t crc32(std::span<const std::byte> bytes) {
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> values{};
        for (std::uint32_t n = 0; n < 256; ++n) {
            values[n] = n;
            for (int k = 0; k < 8; ++k) values[n] = (values[n] & 1 ? 0xedb88320u : 0u) ^ values[n] >> 1;
        }
        return values;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (std::byte byte : bytes) crc = table[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xff] ^ crc >> 8;
    return ~crc;
}

/** The first chunk as ISO 15948, 11.2.2 allows it. */
bool hasHeader(std::span<const std::byte> file) {
    constexpr std::size_t data = 16;           // after the magic bytes, a length and a name
    if (file.size() < data + 13) return true;  // cut off, which is said elsewhere
    const auto byte = [&](std::size_t at) { return std::to_integer<unsigned>(file[data + at]); };
    const std::uint32_t width = bigEndian32(&file[data]), height = bigEndian32(&file[data + 4]);
    const unsigned depth = byte(8), color = byte(9);
    constexpr std::uint32_t largest = 0x7fffffff;
    const bool isDepth = depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16;
    const bool isColor =
        color == 0 || (color == 3 && depth <= 8) || ((color == 2 || color == 4 || color == 6) && depth >= 8);
    return std::memcmp(&file[data - 4], "IHDR", 4) == 0 && bigEndian32(&file[data - 8]) == 13 && width > 0 &&
           width <= largest && height > 0 && height <= largest && isDepth && isColor && byte(10) == 0 &&
           byte(11) == 0 && byte(12) <= 1;
}

bool startsWith(std::span<const std::byte> file, std::span<const unsigned char> magic) {
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

/** The chunks that pixels come from. Texts and profiles are compressed, so that a few of them take any memory
 * that libpng gives them, 8 MB each. */
std::vector<std::byte> pixelChunks(std::span<const std::byte> file) {
    std::vector<std::byte> kept(file.begin(), file.begin() + std::ptrdiff_t(pngMagic.size()));
    kept.reserve(file.size());
    for (std::size_t at = pngMagic.size(); at + 12 <= file.size();) {
        const std::size_t size = std::size_t(bigEndian32(&file[at])) + 12;
        const std::string_view name(reinterpret_cast<const char*>(&file[at + 4]), 4);
        const bool isPixels =
            name == "IHDR" || name == "PLTE" || name == "tRNS" || name == "IDAT" || name == "IEND";
        const auto chunk = file.subspan(at, size);
        if (isPixels) kept.insert(kept.end(), chunk.begin(), chunk.end());
        if (name == "IEND") break;
        at += size;
    }
    return kept;
}

/** RIFF, a length, WEBP. */
bool isWebp(std::span<const std::byte> file) {
    return file.size() >= 12 && std::memcmp(file.data(), "RIFF", 4) == 0 &&
           std::memcmp(file.data() + 8, "WEBP", 4) == 0;
}

}  // namespace

std::string pngFault(std::span<const std::byte> file) {
    if (!startsWith(file, pngMagic)) return {};
    if (!hasHeader(file)) return "has a header that no PNG has";
    std::size_t at = pngMagic.size();
    while (file.size() - at >= 12) {  // a chunk: length, name, data, checksum of name and data
        const std::uint64_t length = bigEndian32(&file[at]);
        if (length + 12 > file.size() - at) break;
        if (crc32(file.subspan(at + 4, length + 4)) != bigEndian32(&file[at + 8 + length]))
            return "is damaged";
        if (std::memcmp(&file[at + 4], "IEND", 4) == 0) return {};
        at += length + 12;
    }
    return "is cut off";
}

bool isTextureFormat(std::span<const std::byte> file) {
    return startsWith(file, pngMagic) || startsWith(file, jpegMagic) || isWebp(file);
}

namespace {

std::string decodeAs(std::span<const std::byte> file, ImageBudget& budget, DecodedImage& image) {
    if (startsWith(file, pngMagic)) return imageBackend().decode(pixelChunks(file), "png", budget, image);
    if (startsWith(file, jpegMagic)) return imageBackend().decode(file, "jpg", budget, image);
    if (isWebp(file)) return imageBackend().decode(file, "webp", budget, image);
    return "is neither PNG nor JPEG nor WebP";
}

}  // namespace

std::string checkImage(std::span<const std::byte> file) {
    if (std::string fault = pngFault(file); !fault.empty()) return fault;
    ImageBudget trial = ImageBudget::trial();
    const DecoderMemory memory = decoderMemory(file);  // or room in a file, and time
    if (!trial.hold(memory.bytes, file.size())) return unfoldsTo(memory.width, memory.height, file.size());
    DecodedImage none;
    return decodeAs(file, trial, none);
}

std::string decodeImage(std::span<const std::byte> file, ImageBudget& budget, DecodedImage& image,
                        bool isChecked) {
    budget.begin();
    if (std::string fault = pngFault(file); !fault.empty()) return fault;
    const DecoderMemory memory = decoderMemory(file);
    if (!budget.hold(memory.bytes, file.size())) return unfoldsTo(memory.width, memory.height, file.size());
    if (!isChecked && ImageBudget::wantsTrial(memory.inAll(), file.size())) {
        if (std::string fault = checkImage(file); !fault.empty()) return fault;
    }
    return decodeAs(file, budget, image);
}

}  // namespace helio
