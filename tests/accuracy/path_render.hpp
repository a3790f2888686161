#pragma once
/** @file Path-traced images for the accuracy tests, straight from the tracer, and statistics over them. */
#include "passes/pathtrace/path_tracer.hpp"

#include <heliograph/scene.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace helio::test {

struct Traced {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> mean;      ///< per pixel
    std::vector<glm::dvec3> variance;  ///< of the mean; independent samples only
    std::uint64_t rejected = 0;
    PathCounters counters;
    FirstHits hits;
    std::size_t guideTables = 0;  ///< that guided paths; 0 where they went unguided
};

/** Square pictures of independent samples, whose variance the statistics below take. */
PathTraceOptions independentOptions(std::uint32_t size, std::uint32_t maxDepth = kUnlimitedDepth);

/** Traces `samples` per pixel in steps of `step` through the camera `name`; guided to caustics where the
 * options have photonTargets and the scene allows it. */
Traced trace(Scene scene, const PathTraceOptions& options, std::uint32_t samples, std::uint32_t step = 64,
             const std::string& camera = {});

/** Mean over pixels that `wanted` accepts (by pixel index), and its standard error. */
struct Estimate {
    double mean = 0, error = 0;
    std::size_t pixels = 0;
};
Estimate estimate(const Traced& image, int channel, const std::function<bool(std::size_t)>& wanted);

}  // namespace helio::test
