#pragma once
/** @file Push constants of the path tracer's kernels; a test holds them against the kernels' reflection. */
#include "passes/pathtrace/camera_frame.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace helio {

/** Push constants of trace.comp. */
struct TraceParameters {
    CameraFrame camera;
    glm::vec4 environment;
    std::array<std::uint32_t, 2> size;
    std::uint32_t sampleEnd;
    std::uint32_t seed;
    std::uint32_t maxDepth;
    std::uint32_t countCut;
    std::uint32_t budget;
    std::uint32_t begin;
};
static_assert(sizeof(TraceParameters) == 112);

/** Push constants of first_hit.comp. */
struct FirstHitParameters {
    CameraFrame camera;
    std::array<std::uint32_t, 2> size;
};
static_assert(sizeof(FirstHitParameters) == 72);

}  // namespace helio
