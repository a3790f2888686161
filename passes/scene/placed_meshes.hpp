#pragma once
/** @file
 * Meshes that stand in a scene many times and are packed once, in their own space, with a tree of their own
 * each: shaders/scene/placed.glsl. All other surfaces are flattened.
 */
#include "passes/scene/packed_scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace helio::pack {

/** A mesh in its own space; for mirrored placements another one, wound the other way. */
struct PlacedMesh {
    std::uint32_t mesh = 0;
    bool mirrored = false;
    std::uint32_t triangles = 0;
    std::uint32_t firstG = 0;  ///< set by geometry()
};

struct MeshPlacement {
    std::uint32_t instance = 0;  ///< as Scene::instances() counts
    std::uint32_t mesh = 0;      ///< into PlacedMeshes::meshes
    glm::dmat4 toWorld{1.0};     ///< about PackOptions::origin
};

struct PlacedMeshes {
    std::vector<PlacedMesh> meshes;
    std::vector<MeshPlacement> placements;  ///< in the order of instances
    std::uint32_t triangleBits = 0;         ///< of a triangle's place in its mesh
};

/** Which meshes are placed, see Placing. Flattened are: shapes, meshes that emit (lights are sampled in the
 * world) or need tangents, several placements of a mesh in one place, of which the first is shown
 * (collapseTwins), and placements that are singular, or so skewed or far away that rounding would swell
 * their boxes. */
PlacedMeshes choosePlaced(const Scene& scene, const PackOptions& options);

/** Some triangles of each placed mesh in the world, as corners in threes: where light falls, for estimates.
 */
std::vector<glm::vec3> placedSamples(const PlacedMeshes& placed, std::span<const glm::vec3> positions);

/** Trees over the placed meshes, before the scene's. */
class PlacedTrees {
public:
    /** `positions`: as geometry() gives them. */
    PlacedTrees(const PlacedMeshes& placed, std::span<const glm::vec3> positions);
    /** Corners of a triangle with the same box, for each placement: what stands for it in the scene's tree.
     */
    std::vector<glm::vec3> boxes() const;
    /** Appends nodes, triangles and PackedScene::placed behind the scene's own. */
    void append(std::span<const glm::vec3> positions, std::span<const Surface> surfaces,
                PackedScene& packed) const;

private:
    const PlacedMeshes& placed_;
    std::vector<Bvh> trees_;
};

}  // namespace helio::pack
