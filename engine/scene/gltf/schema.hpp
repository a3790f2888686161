#pragma once
/** @file
 * The types, ranges and references of a glTF document, checked before anything is built from it. What passes
 * may be read without asking again: members have their type, numbers are finite, every index points at
 * something.
 */
#include "engine/scene/gltf/json_reader.hpp"

#include <string>

namespace helio::gltf {

/** Throws InputError with the place, e.g. "meshes[0].primitives[2].attributes.POSITION". Checks every
 * extras.heliograph too. Returns about how many bytes the largest object of a list takes. */
std::size_t checkSchema(const std::string& file, const Document& document);

}  // namespace helio::gltf
