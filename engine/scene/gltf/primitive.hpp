#pragma once
/** @file A primitive's attributes and indices, decoded. */
#include "engine/scene/gltf/accessors.hpp"
#include "engine/scene/gltf/memory_budget.hpp"

#include <heliograph/scene.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace helio::gltf {

/** What a primitive's indices make. */
Mode modeOf(const nlohmann::json& primitive);

/** How many elements a primitive's accessors have together. */
std::size_t elementsOf(const Asset& asset, const nlohmann::json& primitive);

/** A primitive of triangles but for its variants. What is odd or left out is noted in `notes`, of which
 * nothing else is touched. Throws InputError naming `place`. May be called from several threads, each with a
 * budget and notes of its own. */
Primitive readPrimitive(const Asset& asset, const nlohmann::json& from, const std::string& place,
                        MemoryBudget& memory, helio::Scene& notes);

}  // namespace helio::gltf
