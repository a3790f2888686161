#pragma once
/** @file What kernels that include shaders/intersection/traverse.glsl are compiled with for a TreeAccess. */
#include "passes/scene/packed_scene.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/kernel.hpp>
#include <heliograph/tree_access.hpp>

#include <map>
#include <string>

namespace helio {

/** Storage buffers are read only where one spans the scene's nodes. */
std::map<std::string, std::string> accessDefines(const TreeAccess& access, const Device& device,
                                                 const PackedScene& packed);
SpecConstants accessConstants(const TreeAccess& access);

}  // namespace helio
