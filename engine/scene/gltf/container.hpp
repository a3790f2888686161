#pragma once
/** @file The outermost layer of a glTF file: bytes to JSON document and binary chunk. */
#include "engine/scene/gltf/json_reader.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace helio::gltf {

/** A file with its JSON parsed but not yet looked at. */
struct Container {
    std::string file;  ///< as the user gave it, for messages
    std::vector<std::byte> bytes;
    std::span<const std::byte> binaryChunk;  ///< of a GLB, into bytes
    bool hasBinaryChunk = false;
    std::vector<std::string> warnings;
    Document document;  ///< into bytes
};

/** Reads a file; GLB by its first bytes, whatever it is called. Throws InputError. */
Container readContainer(const std::string& file);

}  // namespace helio::gltf
