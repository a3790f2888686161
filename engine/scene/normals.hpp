#pragma once
/** @file Smooth normals of some of a mesh's primitives. */
#include <heliograph/surfaces.hpp>

#include <span>
#include <string>

namespace helio {

/** As the public smoothNormals, for these primitives of mesh `mesh` alone; `file` is what errors name. */
void smoothNormals(std::span<Primitive* const> primitives, NormalWeight weight, const std::string& file,
                   std::size_t mesh);

}  // namespace helio
