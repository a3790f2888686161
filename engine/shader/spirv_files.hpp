#pragma once
/** @file
 * Run-time variants kept between processes, one file each in the folder "spirv" beside the pipeline cache
 * ($XDG_CACHE_HOME/heliograph or ~/.cache/heliograph), so that a second start compiles nothing. A file holds
 * everything its words were made from and is used only where all of it is the same; a damaged one is passed
 * over.
 */
#include "engine/shader/glsl_compiler.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>

namespace helio {

/** Empty where the environment names no home. */
std::filesystem::path spirvFolder();

/** Most files kept; the ones written longest ago go first. */
inline constexpr std::size_t maxSpirvFiles = 512;

/** What an earlier process compiled from the same text, variant, included files and compiler. */
std::optional<CompiledGlsl> loadSpirv(const std::string& path, const std::string& glsl,
                                      const KernelVariant& variant);

/** Keeps a result that is ok. A failure is logged, never thrown. */
void storeSpirv(const std::string& path, const std::string& glsl, const KernelVariant& variant,
                const CompiledGlsl& compiled);

}  // namespace helio
