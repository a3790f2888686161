#include "output_files.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>

#include <CLI/CLI.hpp>
#include <unistd.h>

namespace helio::cli {
namespace {

void checkFolder(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw InputError(file.string(), "", "is a folder", "name a file");
    }
    const std::filesystem::path folder = followLinks(file).parent_path();
    if (!std::filesystem::is_directory(folder, error)) {
        throw InputError(file.string(), "", "the folder does not exist",
                         "create '" + folder.string() + "' first");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        throw InputError(file.string(), "", "the folder cannot be written to",
                         "change the permissions of '" + folder.string() + "' or name another folder");
    }
}

/** There, and neither a regular file nor a folder. */
bool isSpecial(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
           !std::filesystem::is_directory(status);
}

}  // namespace

bool holdsEveryChannel(const std::filesystem::path& file) {
    return lowerCaseExtension(file) == ".exr";
}

void checkImageOutput(const std::string& option, const std::filesystem::path& file) {
    const std::string extension = lowerCaseExtension(file);
    if (extension != ".exr" && extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
        throw CLI::ValidationError(
            option, file.string() + ": unknown image type '" + extension + "', use .exr, .png or .jpg");
    }
    if (isSpecial(file)) {
        throw InputError(file.string(), "", "is not a regular file", "name a file that can be replaced");
    }
    checkFolder(file);
}

void checkTextOutput(const std::filesystem::path& file) {
    // Also what /dev/stdout leads to where that is a regular file, in whatever folder.
    if (!isSpecial(file) && file.native().rfind("/dev/", 0) != 0) checkFolder(file);
}

}  // namespace helio::cli
