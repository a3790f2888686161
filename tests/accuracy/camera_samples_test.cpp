// The samples about cameras, each by a number that is known: row F5 (Snell's window), the disc of a lamp out
// of focus, and where a rolling shutter finds a wheel.
#include "samples/lectures/materials.hpp"
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(CameraSamples, SnellsWindowIsACone) {
    Renderer renderer(deviceOptions());
    const std::vector<lectures::Figure> figures = lectures::measureSnell(renderer);
    EXPECT_TRUE(lectures::print("snell", figures));
    EXPECT_NEAR(figures.at(0).truth, 97.2133, 1e-4);
}

TEST(CameraSamples, TheFarthestLampIsItsCircleOfConfusion) {
    Renderer renderer(deviceOptions());
    EXPECT_TRUE(lectures::print("lenses", lectures::measureLenses(renderer)));
}

TEST(CameraSamples, TheRollingShutterFindsTheWheelWhereItIs) {
    Renderer renderer;
    RenderOptions options;
    options.size = {480, 270};
    options.samples = 1;
    options.camera = "rolling";
    options.motionSteps = 32;
    const Scene scene = load("sample:wheel");
    const RenderResult image = renderer.render(scene, options);
    const int ids = image.image.channel("id.instance");
    // The hub's row: the rim's outer ends lie one radius to both sides of where the hub is at that row's
    // time. Seen from 0.4 above and 9 away, the row is that through the middle of the picture.
    const std::uint32_t row = 135;
    int first = 480, last = -1;
    for (std::uint32_t x = 0; x < 480; ++x)
        if (image.image.at(x, row, std::size_t(ids)) == 1) {
            first = std::min(first, int(x));
            last = std::max(last, int(x));
        }
    ASSERT_GE(last, first);
    const double time = 0.3 + 0.4 * (row + 0.5) / 270, hub = kPi * (2 * time - 1);
    const double distance = std::hypot(9.0, 0.4), perUnit = 135 / std::tan(13 * kPi / 180) / distance;
    const double centre = 0.5 * (first + last + 1), truth = 240 + hub * perUnit;
    fmt::print("wheel: hub at {:.2f} px, truth {:.2f}\n", centre, truth);
    EXPECT_NEAR(centre, truth, 1.0);
}

}  // namespace
}  // namespace helio::test
