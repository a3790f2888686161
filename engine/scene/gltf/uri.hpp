#pragma once
/** @file What a URI in a glTF file leads to: inline data, or a file in the document's folder. */
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace helio::gltf {

/** Base64 (RFC 4648, padding optional), of which JSON may have escaped characters. False for a character or a
 * length that it cannot have. */
bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes);

/**
 * The bytes behind a URI. Files must lie in the folder of `file` or below: an absolute path, "..", a symbolic
 * link out of it, or another scheme is refused. Throws InputError(file, place, ...).
 */
std::vector<std::byte> readUri(const std::string& file, const std::string& place, std::string_view uri);

}  // namespace helio::gltf
