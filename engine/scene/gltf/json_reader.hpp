#pragma once
/** @file JSON text to a document that takes no more memory than it may. */
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace helio::gltf {

/** Memory that a file of so many bytes may unfold to, beyond its bytes: with them and with the program's own
 * it stays within twice the file and 256 MiB. */
constexpr std::size_t maximumUnfolded(std::size_t bytes) {
    return bytes + (std::size_t(128) << 20);
}

/** A document, and about how many bytes it takes. */
struct Json {
    nlohmann::json document;
    std::size_t bytes = 0;
};

/**
 * Parses a glTF file's JSON; `file` is for messages. Left out as they are met: members of the document that
 * glTF does not know, `extras` but for `extras.heliograph`, and the content of extensions that are not
 * supported. Throws InputError for text that is no JSON, nests too deep, or would take more than
 * maximumUnfolded() of it.
 */
Json readJson(const std::string& file, std::string_view text);

}  // namespace helio::gltf
