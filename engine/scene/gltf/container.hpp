#pragma once
/** @file The outermost layer of a glTF file: bytes to JSON document and binary chunk. */
#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace helio::gltf {

/** A file with its JSON parsed but not yet looked at. */
struct Container {
    std::string file;  ///< as the user gave it, for messages
    std::vector<std::byte> bytes;
    std::size_t size = 0;                    ///< of the file, kept when `bytes` is let go
    std::span<const std::byte> binaryChunk;  ///< of a GLB, into bytes
    bool hasBinaryChunk = false;
    std::vector<std::string> warnings;
    nlohmann::json document;
    std::size_t documentBytes = 0;              ///< that the document takes
    std::size_t textBytes = 0;                  ///< of the JSON
    std::vector<std::string_view> longStrings;  ///< as the text has them, into bytes; Json says which

    /** The long string that a member's value stands for; none for another value. */
    std::optional<std::string_view> longString(const std::string& value) const;
};

/** Reads a file; GLB by its first bytes, whatever it is called. Throws InputError. */
Container readContainer(const std::string& file);

}  // namespace helio::gltf
