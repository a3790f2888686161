#pragma once
/** @file relMSE of plain and other pictures at equal samples. */
#include <heliograph/scene.hpp>

#include <cstdint>

namespace helio {
class Device;
}

namespace helio::test {

struct TableOptions {
    std::uint32_t seeds = 32, size = 64;
};

/** Mean relMSE over seeds. */
struct TableRow {
    double plain = 0, adaptive = 0;
};

/** Renders plainly and otherwise under every seed. The truth is the mean of the plain pictures, whose own
 * error is corrected for: it has 1 / seeds of the variance of one. */
TableRow measureRow(Device& device, const Scene& scene, std::uint32_t samples, const TableOptions& options);

}  // namespace helio::test
