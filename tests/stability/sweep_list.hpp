#pragma once
/** @file Quantities that are swept beyond what single precision can say, over scenes with known answers. */
#include <functional>
#include <string>
#include <vector>

namespace helio::test {

/** What a value of the swept quantity makes wrong. */
struct Outcome {
    double error = 0;  ///< relative; infinite where the picture is not finite, NaN for a refusal
    double noise = 0;  ///< its standard error
    bool warned = false;
    std::string refusal;
};

struct Sweep {
    std::string name;
    double tolerance = 0;
    std::vector<double> values;
    std::function<Outcome(double)> run;

    /** Within the tolerance, noise apart. */
    bool isRight(const Outcome& outcome) const { return outcome.error <= tolerance + 4 * outcome.noise; }
};

std::vector<Sweep> sweeps();

}  // namespace helio::test
