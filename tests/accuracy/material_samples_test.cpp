// The samples about materials, each by a number that is known: where a ring's caustic has its cusp, and how
// wide the highlight of brushed metal is along its scratches and across.
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace helio::test {
namespace {

/** Red of an image's columns, means over the rows. */
std::vector<double> columns(const ImageF& image) {
    std::vector<double> result(image.width);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) result[x] += double(image.at(x, y, 0)) / image.height;
    return result;
}

TEST(MaterialSamples, TheCausticsCuspIsAtHalfTheRadius) {
    Scene scene = load("sample:caustic");
    Renderer renderer(deviceOptions());
    RenderOptions options;
    options.size = {40, 4};
    options.samples = 32768;
    options.camera = "above";
    options.maxDepth = 2;
    options.auxiliary = false;
    options.environment = Environment{};
    const std::vector<double> both = columns(renderer.render(scene, options).image);
    std::erase_if(scene.roots, [&](int root) { return scene.nodes[std::size_t(root)].name == "ring"; });
    options.samples = 256;
    const std::vector<double> direct = columns(renderer.render(scene, options).image);
    // A circular mirror brings parallel rays to 1 / |1 - 2 s / (R cos i)| of their irradiance at the distance
    // s. On the axis s = 1 - x, i = 0: between the centre and the cusp c the mirrored light is 1 / (1 - x /
    // c) of the direct light, m, so that the sum of m (1 - x / c) is the number of columns.
    double sum = 0, moment = 0, count = 0, middle = 0;
    for (std::size_t i = 0; i < both.size(); ++i) {
        const double x = -0.1 + (double(i) + 0.5) / 100, mirrored = both[i] / direct[i] - 1;
        ASSERT_GT(direct[i], 0);
        if (std::abs(x) < 0.1) middle += mirrored / 20;
        if (x < 0) continue;
        sum += mirrored;
        moment += mirrored * x;
        ++count;
    }
    const double cusp = moment / (sum - count);
    double mean = 0;
    for (int i = 0; i < 20; ++i) mean += 0.05 / (1 - 2 * (-0.095 + 0.01 * i));
    fmt::print(
        "caustic: cusp at {:.4f} of the radius, truth 0.5; light about the centre {:.4f}, truth {:.4f}\n",
        cusp, middle, mean);
    EXPECT_NEAR(cusp, 0.5, 0.015);
    EXPECT_NEAR(middle, mean, 0.02);
}

/** Distance from the middle of `profile` at which it falls to half, by linear interpolation. */
double halfWidth(const std::vector<double>& profile) {
    const std::size_t middle = profile.size() / 2;
    const double half = 0.5 * profile[middle];
    std::size_t i = middle;
    while (i + 1 < profile.size() && profile[i] > half) ++i;
    return double(i - middle) - (half - profile[i]) / (profile[i - 1] - profile[i]);
}

TEST(MaterialSamples, BrushedMetalsHighlightHasItsFacetsWidths) {
    const Scene scene = load("sample:brushed");
    const glm::dvec2 alpha(scene.materials.at(1).scattering->alpha);
    Renderer renderer(deviceOptions());
    RenderOptions options;
    options.size = {257, 257};
    options.samples = 16;
    options.camera = "lamp";
    options.maxDepth = 1;
    options.auxiliary = false;
    options.environment = Environment{};
    const ImageF image = renderer.render(scene, options).image;
    std::vector<double> along, across;
    for (std::uint32_t i = 0; i < 257; ++i) {
        along.push_back(double(image.at(i, 128, 0)));
        across.push_back(double(image.at(128, i, 0)));
    }
    // Seen from the lamp, of slope s: 1 / r^2 of the lamp, the cosine, D and G of equal directions, over 4
    // cosines squared: (1 + s^2)^(3/2) / ((1 + s^2 / a^2)^2 sqrt(1 + a^2 s^2)) of the middle's.
    const auto truth = [](double a) {
        double low = 0, high = 10 * a;
        while (high - low > 1e-9) {
            const double s = 0.5 * (low + high),
                         ratio = std::pow(1 + s * s, 1.5) /
                                 (std::pow(1 + s * s / (a * a), 2) * std::sqrt(1 + a * a * s * s));
            (ratio > 0.5 ? low : high) = s;
        }
        return low;
    };
    const double pixel = 2 * 0.28 / 257;
    const glm::dvec2 widths(halfWidth(along) * pixel, halfWidth(across) * pixel);
    fmt::print(
        "brushed metal: highlight's half widths {:.5f} {:.5f} (slopes), truth {:.5f} {:.5f}; ratio {:.3f}, "
        "truth "
        "{:.3f}, of the facets {:.3f}\n",
        widths.x, widths.y, truth(alpha.x), truth(alpha.y), widths.y / widths.x,
        truth(alpha.y) / truth(alpha.x), alpha.y / alpha.x);
    EXPECT_NEAR(widths.x / truth(alpha.x), 1, 0.003);
    EXPECT_NEAR(widths.y / truth(alpha.y), 1, 0.002);
    EXPECT_NEAR(widths.y / widths.x / (truth(alpha.y) / truth(alpha.x)), 1, 0.003);
}

}  // namespace
}  // namespace helio::test
