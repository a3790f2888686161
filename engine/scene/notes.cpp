#include "engine/scene/notes.hpp"

#include <algorithm>

namespace helio {
namespace {

constexpr std::size_t enough = 100;  // a file may have a fault in each of a million places

}  // namespace

void skip(Scene& scene, const std::string& what, const std::string& why) {
    const std::pair<std::string, std::string> entry{what, why}, rest{"further parts", "the list ends here"};
    if (std::find(scene.skipped.begin(), scene.skipped.end(), entry) != scene.skipped.end()) return;
    if (scene.skipped.size() < enough) {
        scene.skipped.push_back(entry);
    } else if (scene.skipped.back() != rest) {
        scene.skipped.push_back(rest);
    }
}

void warn(Scene& scene, const std::string& message) {
    if (scene.warnings.size() >= enough) return;
    if (std::find(scene.warnings.begin(), scene.warnings.end(), message) == scene.warnings.end())
        scene.warnings.push_back(message);
}

}  // namespace helio
