// The C++ twins of the kernels' push constants have the layout that the kernels' reflection says.
#include "engine/shader/reflection.hpp"
#include "passes/pathtrace/parameters.hpp"
#include "passes/raster/push.hpp"
#include "tests/support/struct_layout.hpp"

#include <gtest/gtest.h>
#include <heliograph_kernels/pathtrace.hpp>
#include <heliograph_kernels/raster.hpp>

namespace helio::test {
namespace {

TEST(KernelLayout, TraceParameters) {
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(TraceParameters, camera, environment, size, sampleEnd, seed,
                                             maxDepth, countCut, budget, begin),
                                reflect(shaders::trace).pushConstants),
              "");
}

TEST(KernelLayout, FirstHitParameters) {
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(FirstHitParameters, camera, size),
                                reflect(shaders::first_hit).pushConstants),
              "");
}

TEST(KernelLayout, RasterPush) {
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(RasterPush, rowX, rowY, rowW, depthOffset, depthSlope, size,
                                             first, count, flags),
                                reflect(shaders::rasterSetup).pushConstants),
              "");
}

}  // namespace
}  // namespace helio::test
