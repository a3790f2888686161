#pragma once
/** @file A mesh's vertices, moved by morph targets and a skin. */
#include <heliograph/scene.hpp>

#include <span>
#include <vector>

namespace helio {

/** A mesh with its vertices moved. Positions are relative to `origin`, in the mesh's own space or, under a
 * skin, in the world. */
struct DeformedMesh {
    Mesh mesh;
    glm::dvec3 origin{0.0};
};

/** `mesh` with its targets added, `weights` each; what has no weight counts 0. Throws std::range_error for
 * numbers that no float holds. */
DeformedMesh morphed(const Mesh& mesh, std::span<const float> weights);

/** The same, then moved by a skin: `joints` take from the mesh's space to the world, joint matrix times
 * inverse bind matrix each. Primitives without joints stand at `unskinned`. */
DeformedMesh skinned(const Mesh& mesh, std::span<const float> weights, std::span<const glm::dmat4> joints,
                     const glm::dmat4& unskinned);

}  // namespace helio
