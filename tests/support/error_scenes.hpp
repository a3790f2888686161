#pragma once
/** @file Scenes for experiments on errors. */
#include <heliograph/scene.hpp>

#include <string>

namespace helio::test {

/** A sample by its name, or one of
 *   room     a white room of albedo 0.8, its lamp behind the camera: nearly all light is indirect
 *   spheres  diffuse spheres on a checkered plane under a constant sky
 * and, which the interval was not set on,
 *   yard     blocks between three walls under sky and a point light
 *   metals   rough metal spheres on a glossy floor under two coloured lamps
 *   blinds   a wide lamp behind slats
 * in which no sample is worth more than a bounded multiple of the picture's brightness: all moments of the
 * error are finite. */
Scene errorScene(const std::string& name);

}  // namespace helio::test
