#pragma once
/** @file
 * glTF 2.0 and GLB import, in steps that each refuse what the next could not bear:
 * container (file, chunks, JSON text), schema (types, ranges, every index), lists (typed), buffers
 * and accessors (sizes, offsets), then meshes, materials, images, nodes.
 */
#include "engine/scene/load_monitor.hpp"

#include <heliograph/scene.hpp>

#include <string>

namespace helio {

/**
 * Loads a .gltf or .glb file. Throws InputError with the file and the place in it, e.g. "accessors[3].count".
 * Read: meshes (all index and component types, sparse, strips, fans), nodes, cameras, metallic-roughness
 * materials, textures (PNG, JPEG, WebP; from files inside the file's folder, data URIs, buffer views), and
 * the extensions that gltf.cpp lists. Everything else that the file has is named in Scene::skipped or
 * Material::unsupported; refused if it is required. Images are decoded once each, and only those that a
 * material of the shown scene uses; other materials come without their textures.
 */
Scene loadGltf(const std::string& file, const LoadOptions& options, LoadMonitor& monitor);

}  // namespace helio
