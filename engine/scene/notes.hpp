#pragma once
/** @file What importers tell of a file that they could read: what was left out, what is odd. */
#include <heliograph/scene.hpp>

#include <string>

namespace helio {

/** Notes in Scene::skipped, each once. */
void skip(Scene& scene, const std::string& what, const std::string& why);
/** Notes in Scene::warnings, no more than anyone would read. */
void warn(Scene& scene, const std::string& message);

}  // namespace helio
