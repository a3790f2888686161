#pragma once
/** @file Files that are there whole or not at all. */
#include <cstddef>
#include <filesystem>
#include <span>

namespace helio {

/**
 * Writes a file so that a reader, or whoever looks after a crash, finds the old content or the new, never a
 * part: into a temporary in the same folder, synced, then renamed, then the folder synced. What a killed
 * process leaves behind is named ".NAME.PID-N.partial". A symbolic link is followed. Throws InputError naming
 * the file.
 */
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> content);

}  // namespace helio
