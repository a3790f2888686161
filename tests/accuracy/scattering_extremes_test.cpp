/** @file A small part of what scattering_soak runs. */
#include "tests/accuracy/scattering_extremes.hpp"

#include <gtest/gtest.h>

namespace helio::test {
namespace {

TEST(Extremes, NoNumberIsLost) {
    std::uint64_t samples = 0;
    for (const std::string& name : extremeLobes()) {
        const Extremes found = runExtremes(lobe(name), 0, 8192);
        EXPECT_EQ(found.faults, 0u) << found.first;
        samples += found.samples;
    }
    EXPECT_GT(samples, 1'000'000u);
}

}  // namespace
}  // namespace helio::test
