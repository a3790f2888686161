#pragma once
/** @file Scenes that no estimate was set on. */
#include <heliograph/scene.hpp>

#include <map>
#include <string>

namespace helio::test {

/** By name, without samples that are worth more than a bounded multiple of the picture's brightness (all
 * moments of their errors are finite), but for the last two:
 *   yard     blocks between three walls under sky and a point light
 *   metals   rough metal spheres on a glossy floor under two coloured lamps
 *   blinds   a wide lamp behind slats
 *   garden   a textured floor under an environment image with a veiled sun
 *   shelf    spheres before and behind the plane that a lens is focused at
 *   pane     a block of smooth glass before another on a checkered floor, under a constant sky
 *   hall     a box like Cornell's with two lamps near its ceiling
 *   cellar   the same, its lamps shining upwards too: few samples see the gap above them
 *   lacquer  clear coats and glossy plastic under a point light and a dim sky
 *   quilt    a weave finer than a pixel
 *   workshop metal spheres, two of them glossy, and a small lamp in a room
 *   sunlit   an environment image with a sun of two texels, and a glossy ball
 * and, where no interval can be trusted,
 *   stars    24 lamps in view from a twentieth of a pixel to two across
 *   aquarium a glass sphere under a wide lamp: a broad caustic
 * and those of unseen_scenes.hpp: studio, parlour, bazaar, frost, portico. */
const std::map<std::string, Scene (*)()>& heldOutScenes();

}  // namespace helio::test
