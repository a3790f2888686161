#pragma once
/** @file Whether words are valid SPIR-V for Vulkan 1.3, by SPIRV-Tools. */
#include <cstdint>
#include <span>
#include <string>

namespace helio {

/** The first fault, or nothing. Never throws for a fault of the words. */
std::string spirvFault(std::span<const std::uint32_t> spirv);

/** Whether the words are part of the program or of a library that it loaded: embedded by the build, which
 * made them itself. */
bool isEmbedded(std::span<const std::uint32_t> spirv);

}  // namespace helio
