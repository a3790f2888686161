#pragma once
/** @file What can be rendered, and is probably not what was meant. */
#include <heliograph/scene.hpp>

namespace helio {

/** Warns of triangles without area and of instances whose transform flattens space. */
void warnOfDegenerates(Scene& scene);

}  // namespace helio
