#pragma once
/** @file relMSE of plain and other pictures at equal samples. */
#include <heliograph/scene.hpp>

#include <cstdint>
#include <vector>

namespace helio {
class Device;
}

namespace helio::test {

struct TableOptions {
    std::uint32_t seeds = 16, size = 64, reference = 4096;
};

/** Mean relMSE over seeds, and what is told of it. */
struct TableRow {
    double plain = 0, adaptive = 0, denoised = 0;
    double worst = 0;                                ///< largest denoised / plain of a seed
    double plainMeasured = 0, denoisedMeasured = 0;  ///< Denoised::undenoised, error
    std::uint32_t reliable = 0, held = 0;            ///< denoised ones; of these, true error in the interval
    double farthest = 1;  ///< of the reliable ones, the largest factor between measured and true error
};

/** Renders plainly and otherwise under every seed, for each number of samples. The truth is a plain picture
 * of `reference` samples, whose own error is subtracted. */
std::vector<TableRow> measureRows(Device& device, const Scene& scene,
                                  const std::vector<std::uint32_t>& samples, const TableOptions& options);

}  // namespace helio::test
