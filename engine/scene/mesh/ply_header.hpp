#pragma once
/** @file The header of a PLY file (Turk 1994). */
#include "engine/image/read_file.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace helio::mesh {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
std::size_t sizeOf(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    bool isList = false;
    PlyType countType = PlyType::Uint8;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    enum class Format : std::uint8_t { Ascii, LittleEndian, BigEndian };
    Format format = Format::Ascii;
    std::vector<PlyElement> elements;
    std::string texture;               ///< what a comment TextureFile names
    std::vector<std::string> unknown;  ///< a warning for each line that is no part of a header
    std::uint64_t size = 0;            ///< bytes; the elements follow
    std::size_t lines = 0;
};

/** Throws InputError with `file` and the line. */
PlyHeader readPlyHeader(const ByteSource& source, const std::string& file);

}  // namespace helio::mesh
