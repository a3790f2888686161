#pragma once
/** @file Scenes for experiments on errors. */
#include <heliograph/scene.hpp>

#include <string>

namespace helio::test {

/** A sample by its name, or one of
 *   room     a white room of albedo 0.8, its lamp behind the camera: nearly all light is indirect
 *   spheres  diffuse spheres on a checkered plane under a constant sky
 * or one of held_out_scenes.hpp.
 * In room and spheres no sample is worth more than a bounded multiple of the picture's brightness: all
 * moments of the error are finite. */
Scene errorScene(const std::string& name);

}  // namespace helio::test
