#include "engine/scene/notes.hpp"

#include <algorithm>

namespace helio {

void skip(Scene& scene, const std::string& what, const std::string& why) {
    const std::pair<std::string, std::string> entry{what, why};
    if (std::find(scene.skipped.begin(), scene.skipped.end(), entry) == scene.skipped.end()) {
        scene.skipped.push_back(entry);
    }
}

void warn(Scene& scene, const std::string& message) {
    constexpr std::size_t enough = 100;  // a file may have a fault in each of a million places
    if (scene.warnings.size() < enough) scene.warnings.push_back(message);
}

}  // namespace helio
