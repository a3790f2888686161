#pragma once
/** @file
 * Tables of directional albedos that kernels read behind the materials (shaders/scene/surface_material.glsl):
 * of sheen, of GGX facets that reflect all light, and the latter's mean.
 */
#include <glm/glm.hpp>

#include <vector>

namespace helio::pack {

/** Nodes along each axis: square roots of the cosine and of the width, 0 to 1. */
inline constexpr int kAlbedoNodes = 32;

/** Albedo of KHR_materials_sheen's sheen of colour 1 under `cosine` to the viewer. */
double sheenDirectionalAlbedo(double cosine, double roughness);
/** Albedo of GGX facets with height-correlated masking that reflect all light. */
double ggxDirectionalAlbedo(double cosine, double alpha);

/** (kAlbedoNodes - 1)^2 texels each of sheen, GGX and GGX's mean: the values at a cell's corners. Tables that
 * are not asked for hold zeros. */
std::vector<glm::vec4> albedoTables(bool sheen, bool ggx);

}  // namespace helio::pack
