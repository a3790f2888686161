#pragma once
/** @file What two contenders' times in turn say of their ratio. */
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace helio::test {

/** Runs both in turn, each first in every other pair, and prints the median of general's seconds over
 * stripped's with its 95 % interval by order statistics. `unit` names what a run has so many of. */
inline void printRatios(std::uint32_t pairs, std::uint32_t count, std::string_view unit,
                        const std::function<double()>& general, const std::function<double()>& stripped) {
    std::vector<double> ratios;
    for (std::uint32_t pair = 0; pair < pairs; ++pair) {
        double a = 0, b = 0;
        if (pair % 2 == 0) {
            a = general();
            b = stripped();
        } else {
            b = stripped();
            a = general();
        }
        ratios.push_back(a / b);
    }
    std::sort(ratios.begin(), ratios.end());
    // The rank of the median is binomial: 1.96 standard deviations of it.
    const double half = 0.98 * std::sqrt(double(pairs)), middle = 0.5 * double(pairs - 1);
    const auto at = [&](double rank) {
        return ratios[std::size_t(std::clamp(rank, 0.0, double(pairs - 1)))];
    };
    fmt::print("general / stripped: median {:.4f}, 95 % interval {:.4f} to {:.4f}, {} pairs of {} {}\n",
               at(middle), at(std::floor(middle - half)), at(std::ceil(middle + half)), pairs, count, unit);
}

}  // namespace helio::test
