#pragma once
/** @file Faces of a binary PLY file that have equally many corners: they lie at equal distances and are
 * decoded side by side. */
#include "engine/scene/mesh/ply_header.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace helio::mesh {

/** Where the one list of a face lies in its record, and what is around it. */
struct FaceLayout {
    std::size_t before = 0, after = 0;  ///< bytes
    PlyType countType = PlyType::Uint8, type = PlyType::Int32;

    std::size_t size(std::size_t corners) const {
        return before + sizeOf(countType) + corners * sizeOf(type) + after;
    }
};

/** None for an element with no list or several. */
std::optional<FaceLayout> faceLayout(const PlyElement& element);

struct DecodedFaces {
    std::size_t count = 0;        ///< faces
    std::int64_t highest = -1;    ///< index
    std::size_t highestFace = 0;  ///< the first with it
};

/** Decodes the first of the records, up to one that has another number of corners or an index that is none,
 * as fans of corners - 2 triangles. `indices` has room for all records. */
DecodedFaces decodeFaces(std::span<const char> records, const FaceLayout& layout, std::size_t corners,
                         bool isSwapped, std::span<std::uint32_t> indices);

}  // namespace helio::mesh
