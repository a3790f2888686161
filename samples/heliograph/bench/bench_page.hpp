#pragma once
/** @file The benchmark's HTML page, which a Python script makes with matplotlib. */
#include <filesystem>

namespace helio::cli {

/** Refuses, before any work, a page that could not be made after it: without the script, Python or
 * matplotlib. Throws InputError. */
void checkPage(const std::filesystem::path& page);

/** Makes the page of a record. Throws InputError. */
void writePage(const std::filesystem::path& record, const std::filesystem::path& page);

}  // namespace helio::cli
