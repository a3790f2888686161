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

/** Moves surfaces whose material has a height map by it: every triangle is cut into `cuts` x `cuts`, and the
 * new corners are moved along their normals (those of the mesh, else the mean of the triangles around by
 * angle). Normals become those of the moved surface, and the material's heights 0, since the surface has them
 * now. Corners that two triangles share stay shared; at a seam of the texture coordinates heights may differ
 * and the surface open. Throws InputError for meshes that bend (morph targets and skins; posed() gives them a
 * shape), cuts of 0 or more than 1024, and more triangles than a scene may have, 2^24. */
void displace(Scene& scene, std::uint32_t cuts);

/** Takes normals and tangents away: surfaces are shaded flat. */
void flatNormals(Scene& scene);

}  // namespace helio
