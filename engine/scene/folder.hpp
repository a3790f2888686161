#pragma once
/** @file Files that a scene's file may lead to: those in its folder and below. */
#include <filesystem>
#include <optional>
#include <string_view>

namespace helio {

/** A relative path that stays in its folder, as it is written in a file: / or \ part its names. Empty for one
 * that is absolute, leads out by "..", or is none. */
std::optional<std::filesystem::path> pathBelow(std::string_view text);

/** Where such a path, named in the scene file `file`, leads. Throws InputError where a symbolic link leads
 * out of the folder, that in which the scene file is named or that in which it lies. */
std::filesystem::path fileBelow(const std::filesystem::path& file, const std::filesystem::path& relative);

}  // namespace helio
