#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace helio {

std::vector<std::byte> readFile(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        const bool exists = std::filesystem::exists(file, error);
        throw InputError(file.string(), "", exists ? "is no regular file" : "does not exist", "give a file");
    }
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = in ? std::streamoff(in.tellg()) : -1;
    if (size < 0)
        throw InputError(file.string(), "", "cannot be opened: " + std::string(std::strerror(errno)), "");
    std::vector<std::byte> content(static_cast<std::size_t>(size));
    in.seekg(0);
    if (!in.read(reinterpret_cast<char*>(content.data()), size)) {
        throw InputError(file.string(), "", "cannot be read whole", "");
    }
    return content;
}

}  // namespace helio
