#include "engine/image/atomic_file.hpp"

#include <heliograph/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

namespace helio {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* step, int error) {
    throw InputError(file.string(), "", fmt::format("cannot be {}: {}", step, std::strerror(error)),
                     "give a folder that exists and can be written to");
}

/** Closes, and removes the temporary unless it has been renamed. */
struct Temporary {
    std::filesystem::path path;
    int descriptor = -1;
    bool isKept = false;
    ~Temporary() {
        if (descriptor >= 0) ::close(descriptor);
        if (!isKept) ::unlink(path.c_str());
    }
};

/** The file a symbolic link leads to, there or not: renaming over the link would replace the link. */
std::filesystem::path followLinks(std::filesystem::path file) {
    std::error_code error;
    for (int links = 0; links < 40 && std::filesystem::is_symlink(file, error); ++links) {
        file = file.parent_path() / std::filesystem::read_symlink(file, error);
    }
    return file;
}

int writeAll(int descriptor, std::span<const std::byte> content) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        content = content.subspan(std::size_t(written));
    }
    return ::fsync(descriptor) != 0 ? errno : 0;
}

}  // namespace

void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> content) {
    static std::atomic<unsigned> count{0};
    const std::filesystem::path target = followLinks(std::filesystem::absolute(file));
    const std::filesystem::path folder = target.parent_path();

    Temporary temporary;
    temporary.path =
        folder / fmt::format(".{}.{}-{}.partial", target.filename().string(), ::getpid(), count++);
    temporary.descriptor = ::open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (temporary.descriptor < 0) {
        const int error = errno;
        temporary.isKept = true;  // not ours to remove
        fail(file, "created", error);
    }
    if (const int error = writeAll(temporary.descriptor, content); error != 0) fail(file, "written", error);
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail(file, "replaced", errno);
    temporary.isKept = true;
    // The new name is on disk once its folder is. Some file systems cannot sync folders; the content is safe.
    const int folderDescriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folderDescriptor >= 0) {
        ::fsync(folderDescriptor);
        ::close(folderDescriptor);
    }
}

}  // namespace helio
