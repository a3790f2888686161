#pragma once
/** @file Triangles that a tree serves badly: most rays come near them, so that they are better tested at
 * once. */
#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace helio::pack {

/** Triangles (corners in threes) whose box has at least 0.03 of the surface of the scene's box: about the
 * share of rays that would meet a tree's leaf around them. The largest `most` where there are more;
 * ascending. */
std::vector<std::uint32_t> largeTriangles(std::span<const glm::vec3> positions, std::size_t most);

}  // namespace helio::pack
