#pragma once
/** @file Normals and tangents as shading wants them. */
#include <heliograph/scene.hpp>

namespace helio::gltf {

/** Unit normals; where the file has a zero, the area-weighted mean of the triangles around. */
void fixNormals(Primitive& primitive);

/** Unit tangents with a sign of 1 or -1; a zero becomes any direction across the normal. */
void fixTangents(Primitive& primitive);

}  // namespace helio::gltf
