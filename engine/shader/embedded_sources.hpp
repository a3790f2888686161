#pragma once
/** @file The library's own GLSL files; the build generates the definition from the folders shaders and
 * passes. */
#include <heliograph/kernel.hpp>

#include <span>

namespace helio {

std::span<const ShaderSource> libraryShaderSources();

}  // namespace helio
