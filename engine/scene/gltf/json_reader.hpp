#pragma once
/** @file JSON text to a document that takes no more memory than it may. */
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace helio::gltf {

/** Memory that a file of so many bytes may unfold to, beyond its bytes: with them and with the program's own
 * it stays within twice the file and 256 MiB. A document leaves room for the scene. */
constexpr std::size_t maximumUnfolded(std::size_t bytes) {
    return bytes + (std::size_t(240) << 20);
}
constexpr std::size_t maximumDocument(std::size_t bytes) {
    return bytes + (std::size_t(128) << 20);
}
/** Nodes, materials and the like that say something take no more than so many times their text: as a document
 * (a node of 40 bytes takes 380), and with what becomes of them (800). They may, whatever it is in all; what
 * says nothing, {},{},{}, takes more and is held to the above. */
inline constexpr std::size_t documentProportion = 12, sceneProportion = 24;

/** A string too long for the parser's buffers, where it lies in the text, escapes and all. */
struct LongString {
    std::size_t ordinal;  ///< among the strings of the text, keys included
    std::size_t begin, end;
};

/** A document, and about how many bytes it takes. The value of a long string that is a member `uri` is one of
 * longStringMark and its number; of others it is empty. */
struct Json {
    nlohmann::json document;
    std::size_t bytes = 0;
    std::vector<LongString> longStrings;
};
inline constexpr char longStringMark = '\x01';

/**
 * Parses a glTF file's JSON; `file` is for messages. Left out as they are met: members of the document that
 * glTF does not know, `extras` but for `extras.heliograph`, and the content of extensions that are not
 * supported. Throws InputError for text that is no JSON, nests too deep, or would take more than it may.
 */
Json readJson(const std::string& file, std::string_view text);

}  // namespace helio::gltf
