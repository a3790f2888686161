#pragma once
/** @file How often the error interval holds the true error. */
#include <heliograph/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>

namespace helio {
class Device;
}

namespace helio::test {

struct CoverageOptions {
    std::uint32_t seeds = 1000, samples = 64, size = 64;
    std::filesystem::path keep;   ///< folder for the films, to judge them again elsewhere; empty: not kept
    std::filesystem::path judge;  ///< folder of kept films to judge in place of rendering
};

/** What the experiment counts over all seeds. */
struct Coverage {
    std::uint32_t seeds = 0, reliable = 0;
    std::uint32_t covered = 0, above = 0, below = 0;  ///< of all: the truth in, above, below the interval
    std::uint32_t coveredReliable = 0;
    double truth = 0, estimate = 0;  ///< mean relMSE, true and estimated
    double width = 0;                ///< mean of log(high / low)
    /** Mean and deviation of estimate - truth in standard errors that the width stands for: 0 and 1 where the
     * estimate is as good as it says. */
    double offset = 0, spread = 0;
};

/** Renders the scene under every seed. The truth is the mean of all pictures: it has 1 / seeds of the
 * variance of one picture, by which the true error is corrected. */
Coverage measureCoverage(Device& device, const Scene& scene, const std::string& name,
                         const CoverageOptions& options);

}  // namespace helio::test
