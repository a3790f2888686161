#pragma once
/** @file Runs another program and looks at what it printed. */
#include <sys/wait.h>

#include <cstdio>
#include <stdexcept>
#include <string>

namespace helio::test {

struct Finished {
    int status = -1;     ///< exit status, or 128 + signal
    std::string output;  ///< standard output and error together
};

/** Runs a shell command line under the given environment assignments ("A=1 B=2"). */
inline Finished runProgram(const std::string& environment, const std::string& command) {
    std::FILE* pipe = ::popen(("env " + environment + " " + command + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot start " + command);
    Finished finished;
    char buffer[4096];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe))
        finished.output.append(buffer, count);
    const int status = ::pclose(pipe);
    finished.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return finished;
}

}  // namespace helio::test
