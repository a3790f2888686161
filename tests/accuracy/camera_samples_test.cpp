// The samples about cameras, each by a number that is known: row F5 (Snell's window), the disc of a lamp out
// of focus, and where a rolling shutter finds a wheel.
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
    Scene scene = load("sample:snell");
    // Only what comes through the surface shines: the sky alone, without sun, in a black pool.
    for (Material& material : scene.materials)
        if (!material.scattering) material.baseColor = glm::vec4(0, 0, 0, 1);
    scene.lights.clear();
    for (Node& node : scene.nodes) node.light = -1;
    scene.roots.erase(std::remove_if(scene.roots.begin(), scene.roots.end(),
                                     [&](int root) {
                                         const std::string& name = scene.nodes[std::size_t(root)].name;
                                         return name.starts_with("post") || name.starts_with("ball");
                                     }),
                      scene.roots.end());
    // The diver looks at the rim on two opposite sides, 2 degrees over 64 pixels.
    constexpr std::uint32_t size = 64;
    const auto diver = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [](const Camera& camera) { return camera.name == "diver"; });
    const auto node =
        std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.name == "diver"; });
    ASSERT_TRUE(diver != scene.cameras.end() && node != scene.nodes.end());
    diver->projection = Projection::Plane;
    diver->yfov = float(2 * kPi / 180);
    Renderer renderer;
    RenderOptions options;
    options.size = {size, size};
    options.samples = 256;
    options.camera = "diver";
    options.maxDepth = 2;
    options.auxiliary = false;
    double cone = 0;
    for (const double tilt : {48.6, -48.6}) {
        const double turn = (90 + tilt) * kPi / 180;  // about x; -z points up after 90 degrees
        node->rotation = glm::quat(float(std::cos(turn / 2)), float(std::sin(turn / 2)), 0, 0);
        const RenderResult image = renderer.render(scene, options);
        // Rows of the middle columns that see the sky: below the rim where the picture's top is farther from
        // the zenith, else above it.
        double rows = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 28; x < 36; ++x) rows += image.image.at(x, y, 0) > 0 ? 0.125 : 0;
        const double edge = tilt > 0 ? size - rows : rows;
        const double angle = tilt * kPi / 180 + std::atan((1 - 2 * edge / size) * std::tan(kPi / 180));
        cone += std::abs(angle) * 180 / kPi;
    }
    const double truth = 2 * std::asin(1 / 1.333) * 180 / kPi;
    fmt::print("Snell's window: cone {:.4f} degrees, truth {:.4f}\n", cone, truth);
    EXPECT_NEAR(truth, 97.2133, 1e-4);
    EXPECT_NEAR(cone, truth, 0.1);
}

TEST(CameraSamples, TheFarthestLampIsItsCircleOfConfusion) {
    Scene scene = load("sample:lenses");
    const auto lens = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                   [](const Camera& camera) { return camera.lens.has_value(); });
    ASSERT_NE(lens, scene.cameras.end());
    // Only the lamp, 8 m away.
    std::erase_if(scene.roots, [&](int root) {
        const Node& node = scene.nodes[std::size_t(root)];
        return node.camera < 0 && node.name != "lamp 5";
    });
    Renderer renderer;
    RenderOptions options;
    options.size = {320, 180};
    options.samples = 512;
    options.camera = lens->name;
    options.maxDepth = 0;
    options.auxiliary = false;
    options.environment = Environment{};
    const RenderResult image = renderer.render(scene, options);
    double sum = 0, xx = 0, yy = 0;
    glm::dvec2 mean(0.0);
    const auto each = [&](auto visit) {
        for (std::uint32_t y = 0; y < 180; ++y)
            for (std::uint32_t x = 0; x < 320; ++x) visit(double(image.image.at(x, y, 0)), glm::dvec2(x, y));
    };
    each([&](double v, glm::dvec2 p) { sum += v, mean += v * p; });
    mean /= sum;
    each([&](double v, glm::dvec2 p) {
        xx += v * (p.x - mean.x) * (p.x - mean.x) / sum;
        yy += v * (p.y - mean.y) * (p.y - mean.y) / sum;
    });
    // Along the axis, in the sharp plane: blur A |z - s| / z, as pixels s tan(yfov / 2) 2 / 180 each.
    const PlacedCamera placed = chooseCamera(scene, lens->name);
    const auto lamp = scene.instances().at(0).transform;
    const glm::dvec3 seen = glm::inverse(placed.transform) * lamp[3];
    const double z = -seen.z, s = double(lens->lens->focusDistance);
    const double pixel = 2 * s * std::tan(double(lens->yfov) / 2) / 180;
    const double circle = double(lens->lens->apertureDiameter) * (z - s) / z / pixel;
    const double own = 0.003 * 8 * s / z / pixel;  // the lamp's radius
    const double blades = 2 * kPi / lens->lens->blades;
    const double truth = circle * circle / 4 * (2 + std::cos(blades)) / 12 + own * own / 4 + 1.0 / 12;
    fmt::print("lamp: circle of confusion {:.2f} px, second moments {:.2f} {:.2f}, truth {:.2f} px^2\n",
               circle, xx, yy, truth);
    EXPECT_NEAR(xx / truth, 1, 0.05);
    EXPECT_NEAR(yy / truth, 1, 0.05);
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
