#pragma once
/** @file Scenes on which the error estimate was judged after its last constant was set. */
#include <heliograph/scene.hpp>

namespace helio::test {

/** Lamps of three sizes, none in view, over a tiled floor, plastic and metal. */
Scene studioScene();
/** A room with a window to a bright sky and a lamp in view. */
Scene parlourScene();
/** Cloth, coats and a patterned wall under an image of surroundings. */
Scene bazaarScene();
/** Frosted glass over a striped floor under a sky that brightens upwards. */
Scene frostScene();
/** A portico in a low sun, which is a disc of 6 degrees of the surroundings. */
Scene porticoScene();

}  // namespace helio::test
