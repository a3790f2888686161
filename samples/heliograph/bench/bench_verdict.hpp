#pragma once
/** @file Whether what the benchmark measured is as theory says. */
#include "bench_cases.hpp"
#include "bench_record.hpp"

#include <string>
#include <vector>

namespace helio::cli {

struct Verdict {
    std::string text;
    /** What was found cannot be by chance or by what else the machine does. */
    bool isFailure = false;
};

/** Of pictures that are not finite; of the exponent of the error over samples; of RMSE times the root of CPU
 * time with independent samples, which is constant within 10 %; of what is the same in double precision. */
std::vector<Verdict> verdicts(const BenchRecord& record, const std::vector<BenchCase>& cases);

}  // namespace helio::cli
