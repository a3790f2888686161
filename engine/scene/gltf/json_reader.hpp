#pragma once
/** @file JSON text to a document that takes no more memory than it may. */
#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
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
    std::size_t begin, end;
};

/**
 * A glTF file's JSON, whose lists of objects (nodes, accessors and the like) stay text: an object of them is
 * parsed each time that it is asked for. Parsed, a list would take twelve times its text.
 */
class Document {
public:
    Document() = default;
    /** `text` must outlast this; `file` is for messages. Left out: members of the document that glTF does not
     * know, `extras` but for `extras.heliograph`, and the content of extensions that are not supported.
     * Throws InputError for text that is no JSON, nests too deep, or would take more than it may. */
    Document(const std::string& file, std::string_view text);

    /** All but the lists of objects, which are empty arrays in it. */
    const nlohmann::json& root() const { return root_; }
    /** Whether the document may have a list of objects of that name. */
    static bool isList(std::string_view name);
    /** How many objects a list has; 0 for one that is not there. */
    std::size_t size(std::string_view list) const;
    /** Bytes of text that a list's longest object has. */
    std::size_t longest(std::string_view list) const;
    /** Bytes of text that an object of a list has, about. */
    std::size_t textBytes(std::string_view list, std::size_t index) const;
    /** An object of a list. Adds to `bytes`, if given, about what it takes. Throws InputError for one that
     * would take more than it may. May be called from several threads. */
    nlohmann::json element(std::string_view list, std::size_t index, std::size_t* bytes = nullptr) const;
    /** The long string that a member's value stands for, as it is in the text; none for another value. */
    std::optional<std::string_view> longString(const std::string& value) const;

    /** About how many bytes this takes. */
    std::size_t bytes() const { return bytes_; }
    std::size_t textBytes() const { return text_.size(); }

private:
    class Parser;
    std::string file_;
    std::string_view text_;
    nlohmann::json root_;
    std::map<std::string, std::vector<std::size_t>, std::less<>>
        lists_;  ///< where in the text objects begin, and the list ends
    std::vector<LongString> longStrings_;
    std::size_t bytes_ = 0;
};

}  // namespace helio::gltf
