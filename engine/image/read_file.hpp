#pragma once
/** @file Whole files in memory. */
#include <cstddef>
#include <filesystem>
#include <vector>

namespace helio {

/** The bytes of a regular file. Throws InputError naming it where it cannot be opened or read. */
std::vector<std::byte> readFile(const std::filesystem::path& file);

}  // namespace helio
