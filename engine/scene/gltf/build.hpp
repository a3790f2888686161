#pragma once
/** @file The parts of a glTF asset turned into parts of a Scene. */
#include "engine/scene/gltf/accessors.hpp"
#include "engine/scene/gltf/memory_budget.hpp"
#include "engine/scene/image_decoding.hpp"
#include "engine/scene/load_monitor.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/scene.hpp>

#include <set>
#include <string>
#include <vector>

namespace helio::gltf {

/** Extensions whose meaning the scene model holds, in alphabetical order. */
bool isSupported(const std::string& extension);

/** Fills Scene::meshes and variants. */
void buildMeshes(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene);

/** Weights of a mesh or of a node, one per morph target of the mesh, or none. Throws InputError for another
 * number of them. */
std::vector<float> morphWeights(const Asset& asset, const nlohmann::json& object, std::size_t targets,
                                const std::string& place);

/** Fills Scene::skins; after the meshes and nodes. */
void buildSkins(const Asset& asset, MemoryBudget& memory, helio::Scene& scene);

/** Fills Scene::animations; after the meshes and nodes. */
void buildAnimations(const Asset& asset, MemoryBudget& memory, helio::Scene& scene);

/** Fills Scene::materials, textures and images: the materials in `used` with their textures, the others
 * without. */
void buildMaterials(const Asset& asset, const std::set<int>& used, MemoryBudget& memory, LoadMonitor& monitor,
                    helio::Scene& scene);

/** Fills Scene::nodes, roots, cameras and lights. Refuses cycles and nodes with two parents. */
void buildNodes(const Asset& asset, MemoryBudget& memory, helio::Scene& scene);

/** Fills Scene::environment, and appends its image; after the materials. */
void buildEnvironment(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene);

/** Decodes images for textures: each distinct content once. */
class ImageLoader {
public:
    ImageLoader(const Asset& asset, MemoryBudget& memory) : asset_(asset), memory_(memory) {}
    /** The scene's image for an index into the asset's images. Reads it; decoding waits for decodeAll. */
    int use(int image);
    /** Decodes what was used, side by side, into Scene::images. */
    void decodeAll(LoadMonitor& monitor, helio::Scene& scene);
    /** Width and height of the file of the scene's image, which is one texel where it is of one colour. */
    glm::uvec2 fileSize(std::size_t image) const { return sizes_[image]; }

private:
    const Asset& asset_;
    MemoryBudget& memory_;
    std::vector<glm::uvec2> sizes_;
    std::vector<int> known_;  ///< per image of the asset: into sources_, -1 for not used yet
    std::vector<EncodedImage> sources_;
};

}  // namespace helio::gltf
