#pragma once
/** @file
 * An independent path tracer on the host, in double, to judge the device by. Shares no code with it: every
 * triangle is tested, directions come from a rejection-sampled ball, lights are sampled uniformly by area
 * with no weighting, random numbers are a Mersenne twister's, roulette takes the albedo.
 */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace helio::test {

struct ReferenceImage {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> mean;
    std::vector<glm::dvec3> variance;  ///< of the mean
    /** What the ray through the pixel's centre meets; -1 for a miss. */
    std::vector<int> instance, triangle;
    std::vector<double> depth;
};

/** Traces a scene of constant Lambertian materials and emissive surfaces through its first camera. `samples`:
 * those of a pixel, by its index and the instance its centre sees; pixels without any are black. Depth counts
 * scatterings; negative for no limit. Deterministic. */
ReferenceImage traceReference(const Scene& scene, std::array<std::uint32_t, 2> size,
                              const std::function<std::uint32_t(const ReferenceImage&, std::size_t)>& samples,
                              int maxDepth = -1, std::uint64_t seed = 1);

}  // namespace helio::test
