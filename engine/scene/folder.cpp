#include "engine/scene/folder.hpp"

#include <algorithm>
#include <string>

namespace helio {

std::optional<std::filesystem::path> pathBelow(std::string_view text) {
    std::string name(text);
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
    const bool hasDrive = name.size() > 1 && name[1] == ':';
    if (name.empty() || name.find('\0') != std::string::npos || hasDrive || path.is_absolute() ||
        path.empty() || *path.begin() == "..") {
        return std::nullopt;
    }
    return path;
}

}  // namespace helio
