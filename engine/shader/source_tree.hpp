#pragma once
/** @file The GLSL source tree as run-time compiling sees it: embedded files, over which a folder may lie. */
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace helio {

/** Folder whose files take the place of embedded ones, from HELIOGRAPH_SHADER_DIR; empty where that is unset.
 * Read anew on every call. */
std::filesystem::path shaderOverlay();

/** Text of a file of the tree, by its path from the include root: from the overlay where it is there, else
 * the embedded text. Nothing where neither has it; a path that leaves the root is never found. */
std::optional<std::string> readShaderSource(std::string_view path);

}  // namespace helio
