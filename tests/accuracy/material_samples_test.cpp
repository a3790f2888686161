// The samples about materials, each by numbers that are known: where a ring's caustic has its cusp, and how
// wide the highlight of brushed metal is along its scratches and across.
#include "samples/lectures/materials.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

namespace helio::test {
namespace {

TEST(MaterialSamples, TheCausticsCuspIsAtHalfTheRadius) {
    Renderer renderer(deviceOptions());
    EXPECT_TRUE(lectures::print("caustic", lectures::measureCaustic(renderer)));
}

TEST(MaterialSamples, BrushedMetalsHighlightHasItsFacetsWidths) {
    Renderer renderer(deviceOptions());
    EXPECT_TRUE(lectures::print("brushed", lectures::measureBrushed(renderer)));
}

}  // namespace
}  // namespace helio::test
