#include <heliograph/error.hpp>
#include <heliograph/file.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
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

int writeAll(int descriptor, std::span<const std::byte> content) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        content = content.subspan(std::size_t(written));
    }
    return 0;
}

int writeAndSync(int descriptor, std::span<const std::byte> content) {
    if (const int error = writeAll(descriptor, content); error != 0) return error;
    return ::fsync(descriptor) != 0 ? errno : 0;
}

/** Whether the descriptor is open on the very file that the status is of. */
bool isSameFile(const struct stat& status, int descriptor) {
    struct stat open {};
    return ::fstat(descriptor, &open) == 0 && open.st_dev == status.st_dev && open.st_ino == status.st_ino;
}

}  // namespace

std::string lowerCaseExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::filesystem::path followLinks(const std::filesystem::path& file) {
    std::filesystem::path result = std::filesystem::absolute(file);
    std::error_code error;
    for (int links = 0; links < 40 && std::filesystem::is_symlink(result, error); ++links) {
        result = result.parent_path() / std::filesystem::read_symlink(result, error);
    }
    return result;
}

void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> content) {
    static std::atomic<unsigned> count{0};
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        throw InputError(file.string(), "", "is not a regular file", "name a file that can be replaced");
    }
    const std::filesystem::path target = followLinks(file);
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
    if (const int error = writeAndSync(temporary.descriptor, content); error != 0)
        fail(file, "written", error);
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail(file, "replaced", errno);
    temporary.isKept = true;
    // The new name is on disk once its folder is. Some file systems cannot sync folders; the content is safe.
    const int folderDescriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folderDescriptor >= 0) {
        ::fsync(folderDescriptor);
        ::close(folderDescriptor);
    }
}

void writeTextFile(const std::filesystem::path& file, std::string_view text) {
    const std::span<const std::byte> content = std::as_bytes(std::span(text.data(), text.size()));
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return writeFileAtomically(file, content);
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        if (!isSameFile(status, descriptor)) continue;
        // Renaming over it would leave what is printed later in a file without a name.
        if (const int error = writeAll(descriptor, content); error != 0) fail(file, "written", error);
        return;
    }
    if (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) return writeFileAtomically(file, content);
    Temporary target;
    target.isKept = true;  // not ours to remove
    target.descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (target.descriptor < 0) fail(file, "opened", errno);
    if (const int error = writeAll(target.descriptor, content); error != 0) fail(file, "written", error);
}

}  // namespace helio
