#pragma once
/** @file What a picture may show otherwise than its scene's author meant. */
#include <heliograph/scene.hpp>

#include <string>
#include <vector>

namespace helio {

/** Textures in use that name a set of texture coordinates which their primitive does not have. */
void warnOfTexcoords(const Scene& scene, std::vector<std::string>& warnings);

}  // namespace helio
