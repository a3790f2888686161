#include "bench_page.hpp"

#include "../output_files.hpp"

#include <heliograph/error.hpp>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace helio::cli {
namespace {

/** Beside the installed program, else where the program was built from; empty where it is in neither place.
 */
std::filesystem::path findScript() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    for (const std::filesystem::path& script :
         {program.parent_path().parent_path() / "share/heliograph/report/report.py",
          std::filesystem::path(HELIOGRAPH_REPORT_SCRIPT)}) {
        if (std::filesystem::is_regular_file(script, error)) return script;
    }
    return {};
}

/** Runs Python; whether it ended well. */
bool runPython(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "python3");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    pid_t child = 0;
    int status = 0;
    return ::posix_spawnp(&child, "python3", nullptr, nullptr, pointers.data(), environ) == 0 &&
           ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void checkPage(const std::filesystem::path& page) {
    checkTextOutput(page);
    if (findScript().empty())
        throw InputError(page.string(), "", "the script that makes pages is not there",
                         "leave out --html and run tests/bench/report/report.py of the source tree");
    const std::string probe = "import sys\ntry:\n import matplotlib\nexcept ImportError:\n sys.exit(1)";
    if (!runPython({"-c", probe}))
        throw InputError(page.string(), "", "there is no python3 that has matplotlib",
                         "install the package python3-matplotlib, or leave out --html");
}

void writePage(const std::filesystem::path& record, const std::filesystem::path& page) {
    if (!runPython({findScript().string(), std::filesystem::absolute(record).string(), "-o",
                    std::filesystem::absolute(page).string()}))
        throw InputError(page.string(), "", "the page could not be made",
                         "see above for what the script says");
}

}  // namespace helio::cli
