#pragma once
/** @file What benchmarks on the host measure by. */
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace helio::bench {

/** User and system time of the process: of a CPU device's threads too, and steadier than the clock on a
 * machine with other work. */
inline double cpuSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

inline double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return 0.5 * (values[n / 2] + values[(n - 1) / 2]);
}

}  // namespace helio::bench
