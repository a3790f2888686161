#pragma once
/** @file One material of an MTL file. mtl.hpp says what becomes of it. */
#include <heliograph/scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace helio::mesh {

/** Where textures come from. */
class TextureResolver {
public:
    virtual ~TextureResolver() = default;
    /** Into Scene::textures; -1, with a warning, for a file that is not there. */
    virtual int texture(const std::string& name, bool isClamped) = 0;
};

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
Material materialOf(const std::string& file, const MtlBlock& block, TextureResolver& textures, Scene& scene);

}  // namespace helio::mesh
