#include "engine/scene/gltf/uri.hpp"

#include "engine/image/read_file.hpp"
#include "engine/scene/folder.hpp"

#include <heliograph/error.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace helio::gltf {
namespace {

constexpr std::array<std::int8_t, 256> base64Values = [] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i) values[std::uint8_t(alphabet[i])] = std::int8_t(i);
    return values;
}();

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/** Percent-decoding; an incomplete escape stands for itself. */
std::string percentDecoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 &&
            hexDigit(text[i + 2]) >= 0) {
            decoded.push_back(char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])));
            i += 2;
        } else {
            decoded.push_back(text[i]);
        }
    }
    return decoded;
}

/** "scheme:" as in RFC 3986; a single letter would be a drive. */
bool hasScheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos &&
           uri.substr(0, colon).find_first_of("/?#%") == std::string_view::npos;
}

std::vector<std::byte> readDataUri(const std::string& file, const std::string& place, std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) {
        throw InputError(file, place, "is a data URI without a comma", "give data:TYPE;base64,DATA");
    }
    std::vector<std::byte> bytes;
    const std::string_view data = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) {
        if (!decodeBase64(data, bytes))
            throw InputError(file, place, "is no valid base64", "encode the data again");
    } else if (data.find('\\') != std::string_view::npos) {
        throw InputError(file, place, "is a data URI with escapes", "encode the data as base64");
    } else {
        bytes.reserve(data.size());
        for (char c : percentDecoded(data)) bytes.push_back(std::byte(c));
    }
    return bytes;
}

}  // namespace

bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int bitCount = 0;
    std::size_t characters = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '\\' && text.substr(i + 1, 1) == "/") continue;
        if (c == '\\' && text.substr(i + 1, 3) == "u00" && i + 5 < text.size()) {
            const int high = hexDigit(text[i + 4]), low = hexDigit(text[i + 5]);
            c = high >= 0 && high < 8 && low >= 0 ? char(high * 16 + low) : '\\';
            i += 5;
        }
        const int value = base64Values[std::uint8_t(c)];
        if (value < 0) return false;
        ++characters;
        bits = bits << 6 | std::uint32_t(value);
        bitCount += 6;
        if (bitCount >= 8) {
            bitCount -= 8;
            bytes.push_back(std::byte(bits >> bitCount & 0xff));
        }
    }
    return characters % 4 != 1;
}

std::vector<std::byte> readUri(const std::string& file, const std::string& place, std::string_view uri) {
    if (uri.starts_with("data:")) return readDataUri(file, place, uri);
    const std::string shown(uri.substr(0, 100));
    if (hasScheme(uri)) {
        throw InputError(file, place, "'" + shown + "' is no file", "give a path relative to the glTF file");
    }
    const std::string decoded = percentDecoded(uri);
    const std::filesystem::path path = std::filesystem::path(decoded).lexically_normal();
    const bool leaves = path.is_absolute() || (!path.empty() && *path.begin() == "..");
    if (decoded.empty() || decoded.find('\0') != std::string::npos || leaves) {
        throw InputError(file, place, "'" + shown + "' leads out of the glTF file's folder",
                         "give a path relative to that folder and below it");
    }
    try {
        return readFile(fileBelow(file, path));
    } catch (const InputError& error) {
        throw InputError(file, place, "'" + shown + "' " + error.fault, "put the file beside the glTF file");
    }
}

}  // namespace helio::gltf
