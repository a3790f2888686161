#pragma once
/** @file What a scene may hold beyond diffuse triangles, each as a change to one plain room. */
#include "tests/accuracy/path_scenes.hpp"

#include <functional>
#include <string>
#include <vector>

namespace helio::test {

/** A box of one grey Lambertian material, seen from inside; no light at all. */
SceneBuilder plainRoom();

struct Feature {
    const char* name;
    std::function<void(SceneBuilder&)> add;
    std::vector<std::string> bindings;  ///< that it needs and nothing else does
};

/** All of them. */
const std::vector<Feature>& features();

}  // namespace helio::test
