#include "engine/image/backend.hpp"

#include <heliograph/error.hpp>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace helio {
namespace {

constexpr std::array<unsigned char, 8> pngMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> jpegMagic{0xff, 0xd8, 0xff};

/** The folder of the library that this code is in, in the build tree and where it is installed alike. */
std::filesystem::path libraryFolder() {
    Dl_info info{};
    static const int anchor = 0;
    if (dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr) return {};
    return std::filesystem::absolute(info.dli_fname).parent_path();
}

const ImageBackend& loadBackend() {
    const std::filesystem::path file = libraryFolder() / "libheliograph_image.so";
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        const char* const reason = dlerror();
        throw Error("images cannot be read or written: " +
                    std::string(reason != nullptr ? reason : file.c_str()));
    }
    const auto version = reinterpret_cast<const char* (*)()>(dlsym(module, "heliographImageVersion"));
    const auto backend = reinterpret_cast<const ImageBackend* (*)()>(dlsym(module, "heliographImageBackend"));
    if (version == nullptr || backend == nullptr || std::strcmp(version(), HELIOGRAPH_VERSION) != 0) {
        throw Error("images cannot be read or written: " + file.string() +
                    " is not of version " HELIOGRAPH_VERSION);
    }
    return *backend();
}

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

bool startsWith(std::span<const std::byte> file, std::span<const unsigned char> magic) {
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

/** RIFF, a length, WEBP. */
bool isWebp(std::span<const std::byte> file) {
    return file.size() >= 12 && std::memcmp(file.data(), "RIFF", 4) == 0 &&
           std::memcmp(file.data() + 8, "WEBP", 4) == 0;
}

}  // namespace

const ImageBackend& imageBackend() {
    static const ImageBackend& backend = loadBackend();
    return backend;
}

std::string pngFault(std::span<const std::byte> file) {
    if (!startsWith(file, pngMagic)) return {};
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

std::string decodeImage(std::span<const std::byte> file, DecodedImage& image) {
    if (std::string fault = pngFault(file); !fault.empty()) return fault;
    if (startsWith(file, pngMagic)) return imageBackend().decode(file, "png", image);
    if (startsWith(file, jpegMagic)) return imageBackend().decode(file, "jpg", image);
    if (isWebp(file)) return imageBackend().decode(file, "webp", image);
    return "is neither PNG nor JPEG nor WebP";
}

}  // namespace helio
