#include "engine/scene/folder.hpp"

#include <heliograph/error.hpp>

#include <algorithm>
#include <string>

namespace helio {
namespace {

namespace fs = std::filesystem;

/** Both without links. */
bool liesBelow(const fs::path& path, const fs::path& folder) {
    return !folder.empty() &&
           std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

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

std::filesystem::path fileBelow(const std::filesystem::path& file, const std::filesystem::path& relative) {
    const fs::path folder = file.parent_path(), named = folder / relative;
    std::error_code error;  // what cannot be resolved is empty
    const fs::path real = fs::canonical(named, error);
    if (real.empty() || liesBelow(real, fs::canonical(folder / ".", error)) ||
        liesBelow(real, fs::canonical(file, error).parent_path())) {
        return named;
    }
    throw InputError(named.string(), "", "leads out of the scene's folder by a symbolic link",
                     "put the file itself beside the scene");
}

}  // namespace helio
