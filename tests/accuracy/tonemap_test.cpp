/** @file Tone map and encode: 8-bit codes as the host's exact curve gives them. */
#include "passes/tonemap/tonemap.hpp"

#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace helio::test {
namespace {

std::vector<std::uint32_t> encode(std::vector<glm::vec4> values, std::uint32_t width,
                                  const TonemapOptions& options = {}) {
    const auto height = std::uint32_t((values.size() + width - 1) / width);
    values.resize(std::size_t(width) * height);
    DeviceBuffer linear = makeBuffer(device(), "linear", values);
    Graph graph(device());
    const auto pixels =
        graph.readback<std::uint32_t>(declareTonemap(graph, graph.import(linear), width, height, options));
    Plan plan = graph.compile();
    return pixels.wait(plan.execute());
}

std::uint32_t code(std::uint32_t word, int channel) {
    return word >> (8 * channel) & 255u;
}

TEST(Tonemap, EveryCodeComesBack) {
    std::vector<glm::vec4> values;
    for (int i = 0; i < 256; ++i)
        values.emplace_back(srgbDecode(i / 255.0), srgbDecode((255 - i) / 255.0), srgbDecode(i / 255.0),
                            0.0f);
    const auto words = encode(values, 16);
    for (std::uint32_t i = 0; i < 256; ++i) {
        EXPECT_EQ(code(words[i], 0), i);
        EXPECT_EQ(code(words[i], 1), 255 - i);
        EXPECT_EQ(code(words[i], 2), i);
        EXPECT_EQ(code(words[i], 3), 255u);
    }
}

TEST(Tonemap, CodesChangeHalfway) {
    // Just below and above the linear value whose code is i + 1/2; the curve itself is good to some 1e-7.
    std::vector<glm::vec4> values;
    for (int i = 0; i < 255; ++i) {
        const double edge = srgbDecode((i + 0.5) / 255.0);
        values.emplace_back(edge * (1 - 1e-6), edge * (1 + 1e-6), edge * 0.5, 1.0f);
    }
    const auto words = encode(values, 51);
    for (std::uint32_t i = 0; i < 255; ++i) {
        EXPECT_EQ(code(words[i], 0), i);
        EXPECT_EQ(code(words[i], 1), i + 1);
        EXPECT_EQ(code(words[i], 2),
                  std::uint32_t(std::floor(srgbEncode(double(values[i].z)) * 255.0 + 0.5)));
    }
}

TEST(Tonemap, ValuesOutsideAreClampedAndExposureIsInStops) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const auto words =
        encode({{-1.0f, 0.0f, 2.0f, 0.0f}, {nan, inf, -inf, nan}, {1e30f, 1e-30f, -0.0f, 0.0f}}, 3);
    EXPECT_EQ(words[0], 0xffff0000u);
    EXPECT_EQ(words[1], 0xff00ff00u);
    EXPECT_EQ(words[2], 0xff0000ffu);
    // 0.18 a stop up and 0.36 as it is are one grey.
    EXPECT_EQ(encode({{0.18f, 0.18f, 0.18f, 0.0f}}, 1, {.exposure = 1.0f}),
              encode({{0.36f, 0.36f, 0.36f, 0.0f}}, 1));
    EXPECT_EQ(code(encode({{0.5f, 0, 0, 0}}, 1)[0], 0), 188u);
}

}  // namespace
}  // namespace helio::test
