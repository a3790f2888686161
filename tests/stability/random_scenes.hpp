#pragma once
/** @file Scenes drawn at random from what breaks renderers. */
#include <heliograph/scene.hpp>

#include <cstdint>

namespace helio::test {

/** The scene of a number, always the same: soups with triangles of no area, slivers and copies that coincide,
 * balls, sheets that lie in each other; materials of every kind with parameters at their ends; lights from a
 * millionth to a million of the scene's size and power, some within surfaces; the whole at scales from 1e-6
 * to 1e6 and up to 1e4 times its size from the origin. Valid: Scene::validate() passes. */
Scene randomScene(std::uint64_t number);

}  // namespace helio::test
