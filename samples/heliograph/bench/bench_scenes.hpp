#pragma once
/** @file Scenes of the benchmark, and what is known of their pictures without rendering them. */
#include <heliograph/scene.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace helio::cli {

/** A built-in sample by its name, or one with a closed form:
 *   furnace     inside of a closed box that emits 1 and reflects 0.8
 *   irradiance  a floor of reflectance 1/2 under a triangular lamp, seen in parallel from above */
Scene benchScene(const std::string& name);

/** The picture of a scene with a closed form under the box filter: R = G = B, one number a pixel, rows from
 * the top. Nothing for other scenes. */
std::optional<std::vector<double>> closedForm(const std::string& name,
                                              const std::array<std::uint32_t, 2>& size);

}  // namespace helio::cli
