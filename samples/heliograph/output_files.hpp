#pragma once
/** @file Refuses, before any work, an output that could not be written after it. */
#include <filesystem>
#include <string>

namespace helio::cli {

/** Whether an image file takes more than R, G and B. */
bool holdsEveryChannel(const std::filesystem::path& file);

/** An image: its type must be known (else wrong usage of the option) and its folder be there and writable. */
void checkImageOutput(const std::string& option, const std::filesystem::path& file);

/** A text: its folder must be there and writable, unless the file is a pipe, a device or the like. */
void checkTextOutput(const std::filesystem::path& file);

}  // namespace helio::cli
