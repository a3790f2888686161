#pragma once
/** @file Files that a scene's file may lead to: those in its folder and below. */
#include <filesystem>
#include <optional>
#include <string_view>

namespace helio {

/** A relative path that stays in its folder, as it is written in a file: / or \ part its names. Empty for one
 * that is absolute, leads out by "..", or is none. */
std::optional<std::filesystem::path> pathBelow(std::string_view text);

}  // namespace helio
