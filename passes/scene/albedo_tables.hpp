#pragma once
/** @file
 * The table of sheen's directional albedo that kernels read behind the materials
 * (shaders/scene/surface_material.glsl).
 */
#include <glm/glm.hpp>

#include <vector>

namespace helio::pack {

/** Nodes along each axis: the square root of the cosine and the roughness, 0 to 1. */
inline constexpr int kAlbedoNodes = 32;

/** Albedo of KHR_materials_sheen's sheen of colour 1 under `cosine` to the viewer. */
double sheenDirectionalAlbedo(double cosine, double roughness);

/** (kAlbedoNodes - 1)^2 texels: the values at a cell's corners. */
std::vector<glm::vec4> sheenTable();

}  // namespace helio::pack
