#pragma once
/** @file Files that are there whole or not at all. */
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace helio {

/**
 * Writes a file so that a reader, or whoever looks after a crash, finds the old content or the new, never a
 * part: into a temporary in the same folder, synced, then renamed, then the folder synced. What a killed
 * process leaves behind is named ".NAME.PID-N.partial"; a failed write removes it. A symbolic link is
 * followed. Throws InputError naming the file, also where it exists and is not a regular file.
 */
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> content);

/**
 * Writes text as above; but what exists and is not a regular file (a pipe, a terminal, /dev/stdout) is
 * written into, and so is the file that standard output or standard error goes to. Throws InputError naming
 * the file.
 */
void writeTextFile(const std::filesystem::path& file, std::string_view text);

/** The file a symbolic link leads to, there or not; the file itself where it is no link. Absolute. */
std::filesystem::path followLinks(const std::filesystem::path& file);

/** A file name's extension in lower case with its dot: ".png" of "A.PNG"; empty where there is none. */
std::string lowerCaseExtension(const std::filesystem::path& file);

}  // namespace helio
