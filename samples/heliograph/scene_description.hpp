#pragma once
/** @file What `heliograph info SCENE` tells of a scene. */
#include <heliograph/scene.hpp>

#include <nlohmann/json.hpp>

namespace helio::cli {

using Json = nlohmann::ordered_json;

/** Counts and lists of what the scene holds, `needs` (features of the engine), `does_not_need` and `skipped`.
 */
Json describeScene(const Scene& scene);

/** The same to read: a line per entry. */
void printScene(const Json& description);

}  // namespace helio::cli
