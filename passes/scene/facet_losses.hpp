#pragma once
/** @file
 * What one scattering at microfacets loses, as the compensation of
 * shaders/scattering/multiple_scattering.glsl needs it: a table for each material that asks for it, behind
 * the materials.
 */
#include <heliograph/scene.hpp>

#include <array>
#include <vector>

namespace helio::pack {

/** Nodes over the square root of the cosine, 0 to 1. */
inline constexpr int kLossNodes = 48;
/** Texels of a table: two of weights, then one for each cell. */
inline constexpr int kLossTexels = kLossNodes + 1;

/** Albedo of one scattering under `cosine`, of facets that absorb nothing: conductors as if they reflected
 * all, dielectrics with what goes through, by power. `inside`: seen from the side of the index n. */
double facetAlbedo(const Scattering& scattering, bool inside, double cosine);

/** Texels of a Conductor's or Dielectric's table: see shaders/scattering/multiple_scattering.glsl. */
std::array<glm::vec4, kLossTexels> facetLosses(const Scattering& scattering);

}  // namespace helio::pack
