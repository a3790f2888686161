#pragma once
/** @file The patches of a diffuse scene: triangles cut into parts that are alike in size. Host only. */
#include "passes/scene/packed_scene.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace helio {

/** Triangles that a scene for radiosity may have, and patches that they may be cut into. */
inline constexpr std::uint32_t kMostPatches = 2048;

struct Patch {
    std::array<glm::dvec3, 3> corners;  ///< counter-clockwise is front
    glm::dvec3 reflectance{0.0};
    std::array<glm::dvec3, 2> emission{};  ///< radiance of front and back
};

/** A triangle in `slot` is cut into divisions^2 parts by lines parallel to its edges: u and v run from the
 * first corner to the second and third. Part `first` + i (2 divisions - i) + 2 j is that of u from i, v from
 * j (in steps of 1 / divisions), the next one the other half of the same parallelogram. */
struct PatchList {
    std::vector<Patch> patches;
    std::vector<glm::uvec4> places;  ///< a patch: slot, 2 divisions (+ 1 for the other half), i, j
    std::vector<glm::uvec4> slots;   ///< a slot: first, divisions, 0, 0
};

/** Cuts the triangles of a packed scene into about `count` parts of like area, at least one each and at most
 * kMostPatches, which the scene has no more triangles than. Throws InputError where there is what is not
 * Lambertian with one colour a material, or light that is neither emission nor a constant environment. */
PatchList cutIntoPatches(const PackedScene& packed, std::uint32_t count);

}  // namespace helio
