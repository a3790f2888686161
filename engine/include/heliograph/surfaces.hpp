#pragma once
/** @file Changes to the surfaces of a scene before it is rendered. */
#include <heliograph/scene.hpp>

namespace helio {

/** What a triangle's normal counts at a corner where several meet: as much as any other; by its area; or by
 * the angle that it takes up there, which is the one that does not depend on how faces are cut into
 * triangles (Thuermer and Wuethrich, "Computing vertex normals from polygonal facets", 1998). */
enum class NormalWeight : std::uint8_t { Equal, Area, Angle };

/** Gives every mesh normals that are the mean of those of the triangles around: corners of a mesh at one
 * place share theirs, whatever primitives or texture coordinates they are of. Replaces what the scene has;
 * morph targets then move the corners, and their normals stay. Where triangles have no area or cancel, a
 * corner takes the normal of one of them. Throws InputError for an index that does not exist. */
void smoothNormals(Scene& scene, NormalWeight weight);

/** Takes normals and tangents away: surfaces are shaded flat. */
void flatNormals(Scene& scene);

}  // namespace helio
