#pragma once
/** @file
 * extras.heliograph, what glTF can't say. heliograph.schema.json describes it; a new property is added there,
 * to the scene model, and to the reader of its kind in extras.cpp.
 */
#include "engine/image/backend.hpp"

#include <heliograph/scene.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace helio::extras {

/** Checks extras.heliograph of an object, `index` of the glTF document's list of that name, against the
 * schema. Throws InputError with the JSON pointer, the fault, and what the schema asks for. */
void check(const std::string& file, std::string_view list, std::size_t index, const nlohmann::json& object);
/** The same for the document's own. */
void checkDocument(const std::string& file, const nlohmann::json& document);

/** Reads what check() has accepted. `object` is a material, camera, node or scene of the document, `pointer`
 * leads to it. An environment's image is appended to Scene::images. */
void readMaterial(const nlohmann::json& object, Material& material);
/** `index`: of the camera in the document. */
void readCamera(const std::string& file, const nlohmann::json& object, int index, Camera& camera);
/** A node's meter is appended to Scene::meters, its shape as a mesh to Scene::meshes. `index`: of the node in
 * the document, which has so many `materials`. */
void readNode(const std::string& file, const nlohmann::json& object, std::size_t index, std::size_t materials,
              Node& node, Scene& scene);
void readScene(const std::string& file, const std::string& pointer, const nlohmann::json& object,
               ImageBudget& budget, Scene& scene);

}  // namespace helio::extras
