#pragma once
/** @file One material of an MTL file. mtl.hpp says what becomes of it. */
#include "engine/scene/mesh/textures.hpp"

#include <heliograph/scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace helio::mesh {

/** The lines from one newmtl to the next, joined ones as one. */
struct MtlBlock {
    struct Line {
        std::size_t number;
        std::string keyword, rest;
    };
    std::string name;
    std::vector<Line> lines;
};

/** Throws InputError with `file` and the line for a number that is none. */
Material materialOf(const std::string& file, const MtlBlock& block, TextureFiles& textures, Scene& scene);

}  // namespace helio::mesh
