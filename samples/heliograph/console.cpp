#include "console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace helio::cli {

void prepareConsole() {
    std::signal(SIGPIPE, SIG_IGN);
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        // open() takes the lowest free descriptor: this one. Read-only, so that writing still fails.
        if (::fcntl(descriptor, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) < 0) return;
    }
}

std::string printable(std::string_view text) {
    std::string result(text);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto c = static_cast<unsigned char>(result[i]);
        const unsigned char next = i + 1 < result.size() ? static_cast<unsigned char>(result[i + 1]) : 0;
        if (c == '\n' || c == '\t') {
            result[i] = ' ';
        } else if (c < 0x20 || c == 0x7f) {
            result[i] = '?';
        } else if (c == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 to U+009F in UTF-8
            result[i] = result[i + 1] = '?';
        }
    }
    return result;
}

void writeError(std::string_view text) {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
    (void)std::fflush(stderr);
}

void writeOutput(std::string_view text) {
    (void)std::fwrite(text.data(), 1, text.size(), stdout);
}

bool outputWritten() {
    const bool isFlushed = std::fflush(stdout) == 0;
    return isFlushed && std::ferror(stdout) == 0;
}

}  // namespace helio::cli
