#pragma once
/** @file A piece of an OBJ file (Wavefront's Advanced Visualizer, appendix B), parsed by itself. */
#include "engine/scene/mesh/polygon.hpp"
#include "engine/scene/mesh/text.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace helio::mesh {

/** The three lists that a corner counts in. */
enum Attribute : std::size_t { Position, TexCoord, Normal, attributeCount };

struct ObjChunk {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec3> colors;  ///< as in the file; none, or one per position
    std::vector<glm::vec2> texcoords;
    /** Per attribute, three indices a triangle, from 0; -1 for none. All but positions may be empty: none. */
    std::array<std::vector<std::int32_t>, attributeCount> corners;
    /** Places in `corners` whose index counts from where the chunk's own elements begin. */
    std::array<std::vector<std::uint32_t>, attributeCount> relative;

    std::vector<Fan> polygons;

    struct MaterialChange {
        std::uint32_t triangle;  ///< the first with it
        std::uint32_t name;
    };
    std::vector<MaterialChange> materialChanges;
    std::vector<std::string> materialNames;
    std::vector<std::string> libraries;  ///< what follows mtllib

    /** The index furthest out, to be held against what the whole file has. */
    struct Extreme {
        std::int64_t index;
        std::size_t line;
    };
    std::array<Extreme, attributeCount> highest{};         ///< among indices from the file's beginning
    std::array<Extreme, attributeCount> lowestRelative{};  ///< among the others

    std::size_t lines = 0;
    std::size_t statements = 0;  ///< known ones
    std::vector<std::pair<std::string, std::string>> skipped;
    std::vector<std::pair<std::size_t, std::string>> warnings;  ///< with their lines
    std::optional<TextFault> fault;                             ///< parsing ended there

    std::size_t triangles() const { return corners[Position].size() / 3; }
};

ObjChunk parseObjChunk(std::string_view text);

}  // namespace helio::mesh
