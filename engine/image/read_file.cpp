#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>

namespace helio {

FileSource::FileSource(const std::filesystem::path& file) : file_(file) {
    const auto refuseIrregular = [&] {
        throw InputError(file.string(), "", "is no regular file", "give a file");
    };
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) {
        const bool isMissing = errno == ENOENT || errno == ENOTDIR;
        throw InputError(
            file.string(), "",
            isMissing ? "does not exist" : std::string("cannot be read: ") + std::strerror(errno),
            "give a file that can be read");
    }
    if (!S_ISREG(status.st_mode)) refuseIrregular();  // to open a device may already do something
    // A pipe that took the file's place meanwhile would wait for a writer.
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
        const std::string reason = std::strerror(errno);
        if (descriptor_ >= 0) ::close(descriptor_);
        throw InputError(file.string(), "", "cannot be opened: " + reason, "give a file that can be read");
    }
    if (!S_ISREG(status.st_mode)) {
        ::close(descriptor_);
        refuseIrregular();
    }
    size_ = std::uint64_t(status.st_size);
}

FileSource::~FileSource() {
    ::close(descriptor_);
}

void FileSource::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = ::pread(descriptor_, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            throw InputError(file_.string(), "", "cannot be read whole",
                             "give a file that stays as it is while it is read");
        }
        offset += std::uint64_t(count);
        bytes = bytes.subspan(std::size_t(count));
    }
}

void MemorySource::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    assert(offset <= content_.size() && bytes.size() <= content_.size() - offset);
    if (!bytes.empty()) std::memcpy(bytes.data(), content_.data() + offset, bytes.size());
}

std::vector<std::byte> readFile(const std::filesystem::path& file) {
    const FileSource source(file);
    std::vector<std::byte> content(source.size());
    source.read(0, content);
    return content;
}

}  // namespace helio
