#pragma once
/** @file What a lecture's samples are measured by. */
#include <heliograph/heliograph.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace helio::lectures {

/** A number that a picture holds, and what it should be. */
struct Figure {
    std::string what;
    double measured = 0, truth = 0;
    double tolerance = 0;  ///< absolute
    bool holds() const { return std::abs(measured - truth) <= tolerance; }
};

/** Prints a sample's figures, one a line. Returns whether all of them hold. */
inline bool print(const char* sample, const std::vector<Figure>& figures) {
    bool all = true;
    for (const Figure& figure : figures) {
        std::printf("%-8s %-58s %10.5f  truth %10.5f  within %.2g: %s\n", sample, figure.what.c_str(),
                    figure.measured, figure.truth, figure.tolerance, figure.holds() ? "holds" : "FAILS");
        all = all && figure.holds();
    }
    return all;
}

}  // namespace helio::lectures
