#include "passes/renderer/process_clock.hpp"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <string>

namespace helio {
namespace {

double clockSeconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

double secondsSinceProcessStart() {
    // proc(5): field 22 of /proc/self/stat is the start in clock ticks since boot; the fields before it begin
    // after the last ')' of the program's name.
    std::ifstream file("/proc/self/stat");
    std::string line;
    std::getline(file, line);
    const std::size_t close = line.rfind(')');
    if (close == std::string::npos) return 0;
    std::size_t at = close + 1;
    for (int field = 3; field <= 22; ++field) {
        at = line.find(' ', at);
        if (at == std::string::npos) return 0;
        ++at;
    }
    const double start = std::strtod(line.c_str() + at, nullptr) / double(sysconf(_SC_CLK_TCK));
    return std::max(0.0, clockSeconds(CLOCK_BOOTTIME) - start);
}

double processCpuSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peakHostBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

Stopwatch::Stopwatch() : start_(clockSeconds(CLOCK_MONOTONIC)), cpuStart_(processCpuSeconds()) {}

double Stopwatch::seconds() const {
    return clockSeconds(CLOCK_MONOTONIC) - start_;
}

Stopwatch Stopwatch::sinceProcessStartOnce() {
    static std::atomic<bool> taken{false};
    Stopwatch watch;
    if (!taken.exchange(true)) {
        watch.start_ -= secondsSinceProcessStart();
        watch.cpuStart_ = 0;
    }
    return watch;
}

}  // namespace helio
