#pragma once
/** @file What the operating system knows of this process: when it began, what it used. */
#include <cstdint>

namespace helio {

/** Seconds since the process was started by the system (before main and dynamic linking), to 10 ms. */
double secondsSinceProcessStart();
/** User plus system CPU seconds of all threads so far. */
double processCpuSeconds();
/** Largest resident set so far, bytes. */
std::uint64_t peakHostBytes();

/** Wall and CPU seconds from construction, or from the start of the process. */
class Stopwatch {
public:
    Stopwatch();
    double seconds() const;
    double cpuSeconds() const { return processCpuSeconds() - cpuStart_; }
    /** One that counts from the start of the process the first time this is called in the process, and from
     * now later: what an application did before its later renders is not their set-up. */
    static Stopwatch sinceProcessStartOnce();

private:
    double start_;  ///< on the monotonic clock
    double cpuStart_;
};

}  // namespace helio
