#pragma once
/** @file
 * The types, ranges and references of a glTF document, checked before anything is built from it. What passes
 * may be read without asking again: members have their type, numbers are finite, every index points at
 * something.
 */
#include <nlohmann/json.hpp>

#include <string>

namespace helio::gltf {

/** Throws InputError with the place, e.g. "meshes[0].primitives[2].attributes.POSITION". */
void checkSchema(const std::string& file, const nlohmann::json& document);

}  // namespace helio::gltf
