#pragma once
/** @file Which point of a surface each texel of an image shows. */
#include <heliograph/bake.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace helio::bake {

/** The surface at a texel's middle, in the world. */
struct AtlasTexel {
    std::uint32_t texel;     ///< row times width + column
    std::uint32_t triangle;  ///< of the instance, over its primitives
    glm::dvec3 position;
    glm::dvec3 normal;  ///< unit, interpolated
    glm::dvec3 face;    ///< unit, of the front side
};

/** Texels that the instance's triangles cover by this set of coordinates, in order. Throws InputError as
 * bakeAmbientOcclusion() says. */
std::vector<AtlasTexel> atlasTexels(const Scene& scene, const Instance& instance, int texcoord,
                                    std::uint32_t size);

/** The instance of a node by name; of the first with a mesh where none is named. Throws InputError. */
std::size_t chosenInstance(const Scene& scene, const std::vector<Instance>& instances,
                           const std::string& node);

/** Refuses numbers out of range, by InputError. */
void check(const Scene& scene, const BakeOptions& options);

/** Texels that nothing covers take the mean of the covered about them, ring by ring. */
void fillGaps(std::vector<float>& values, std::vector<bool> covered, std::uint32_t size);

}  // namespace helio::bake
