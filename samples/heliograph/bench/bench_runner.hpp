#pragma once
/** @file Renders what a benchmark's record lacks. */
#include "bench_cases.hpp"
#include "bench_record.hpp"

#include <heliograph/renderer.hpp>

#include <functional>
#include <string>
#include <vector>

namespace helio::cli {

class BenchRunner {
public:
    struct Callbacks {
        std::function<bool()> interrupted;               ///< asked between dispatches
        std::function<void(const std::string&)> report;  ///< what is being done, a line
    };
    BenchRunner(Renderer& renderer, BenchRecord& record, const BenchSettings& settings, Callbacks callbacks);

    /** Measures; false where it was interrupted. */
    bool run(const std::vector<BenchCase>& cases);

private:
    /** Nothing where it was interrupted. */
    std::optional<RenderResult> render(const Scene& scene, RenderOptions options);
    bool makeTruth(const BenchCase& measured, const Scene& scene);
    /** A point of a series over sizes. */
    void measureSize(const BenchCase& measured, std::uint32_t size, std::uint32_t repeat);
    bool measure(const BenchCase& measured, const Scene& scene, std::uint32_t samples, std::uint32_t repeat);

    Renderer& renderer_;
    BenchRecord& record_;
    BenchSettings settings_;
    Callbacks callbacks_;
    std::string truthKey_;  ///< of truth_
    Truth truth_;
};

}  // namespace helio::cli
