#pragma once
/** @file What the properties of a PLY file's vertices are, by their names. */
#include "engine/scene/mesh/ply_header.hpp"

#include <cstddef>
#include <string>

namespace helio::mesh {

/** What a property of a vertex is. */
enum Slot : std::size_t { X, Y, Z, NormalX, NormalY, NormalZ, U, V, Red, Green, Blue, Alpha, slotCount };

/** slotCount for a name without a meaning here. */
std::size_t slotOf(const std::string& name);

/** 1 as an integer type stores it for a colour. */
double colorScale(PlyType type);

}  // namespace helio::mesh
