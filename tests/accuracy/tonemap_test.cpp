/** @file Tone map and encode: 8-bit codes as the host's exact curve gives them. */
#include "passes/tonemap/tonemap.hpp"

#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
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

/** The curves as they were published, in double. */
double hable(double x) {
    const double a = 0.15, b = 0.5, c = 0.1, d = 0.2, e = 0.02, f = 0.3;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}
glm::dvec3 published(ToneCurve curve, const glm::dvec3& c) {
    const double y = glm::dot(c, glm::dvec3(0.2126390058715104, 0.7151686787677559, 0.07219231536073371));
    if (curve == ToneCurve::Reinhard) return c / (1 + y);
    if (curve == ToneCurve::Filmic)
        return glm::dvec3(hable(2 * c.r), hable(2 * c.g), hable(2 * c.b)) / hable(11.2);
    if (curve == ToneCurve::None) return c;
    const glm::dmat3 in = glm::transpose(
        glm::dmat3(0.59719, 0.35458, 0.04823, 0.076, 0.90834, 0.01566, 0.0284, 0.13383, 0.83777));
    const glm::dmat3 out = glm::transpose(
        glm::dmat3(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602));
    const glm::dvec3 v = in * c;
    const glm::dvec3 a = v * (v + 0.0245786) - 0.000090537, b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return out * glm::max(a / b, glm::dvec3(0));
}

TEST(Tonemap, CurvesAreThePublishedOnes) {
    std::vector<glm::vec4> values;
    for (int i = 0; i < 4096; ++i) {
        const auto at = [&](int shift) { return float(0.001 * std::exp2(((i >> shift) % 16) * 1.1)); };
        values.emplace_back(at(0), at(4), at(8), 0.0f);
    }
    for (const ToneCurve curve : {ToneCurve::None, ToneCurve::Reinhard, ToneCurve::Filmic, ToneCurve::Aces}) {
        const auto words = encode(values, 64, {.exposure = 0.5f, .curve = curve});
        ImageF image{64, 64, {"R", "G", "B"}, {}, {}};
        for (const glm::vec4& v : values) image.data.insert(image.data.end(), {v.r, v.g, v.b});
        const auto file =
            std::filesystem::temp_directory_path() / ("heliograph-tone-" + std::to_string(getpid()) + ".png");
        saveImage(file, image, {.exposure = 0.5, .curve = curve});
        const ImageF saved = loadImage(file);
        std::filesystem::remove(file);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::dvec3 linear = glm::dvec3(values[i]) * std::exp2(0.5);
            const glm::dvec3 wanted = glm::clamp(published(curve, linear), 0.0, 1.0);
            for (int c = 0; c < 3; ++c) {
                // Codes are the nearest ones: half a code and the device's rounding.
                const double exact = srgbEncode(wanted[c]) * 255;
                EXPECT_NEAR(double(code(words[i], c)), exact, 0.501) << int(curve) << " " << i;
                EXPECT_NEAR(double(saved.data[i * 3 + std::size_t(c)]) * 255, exact, 0.5005)
                    << int(curve) << " " << i;
            }
        }
    }
}

TEST(Tonemap, CurvesHaveTheirKnownPoints) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const auto red = [&](ToneCurve curve, float v) {
        return srgbDecode(code(encode({{v, v, v, 0.0f}}, 1, {.curve = curve})[0], 0) / 255.0);
    };
    // Reinhard: middle grey 0.18 to 0.18 / 1.18, 1 to 1/2. Hable: white is 11.2 at twice the exposure. The
    // Academy's transforms show a grey card at a tenth of white.
    EXPECT_NEAR(red(ToneCurve::Reinhard, 0.18f), 0.18 / 1.18, 0.004);
    EXPECT_NEAR(red(ToneCurve::Reinhard, 1.0f), 0.5, 0.005);
    EXPECT_EQ(red(ToneCurve::Filmic, 5.6f), 1.0);
    EXPECT_LT(red(ToneCurve::Filmic, 5.0f), 1.0);
    EXPECT_NEAR(red(ToneCurve::Aces, 0.18f), 0.1, 0.008);
    for (const ToneCurve curve : {ToneCurve::Reinhard, ToneCurve::Filmic, ToneCurve::Aces}) {
        double last = 0;
        for (int i = -40; i < 60; ++i) {
            const double shown = red(curve, float(std::exp2(i * 0.5)));
            EXPECT_GE(shown, last) << int(curve) << " " << i;
            last = shown;
        }
        EXPECT_EQ(last, 1.0);
        EXPECT_EQ(encode({{0.0f, -1.0f, nan, 0.0f}}, 1, {.curve = curve})[0], 0xff000000u) << int(curve);
        EXPECT_EQ(encode({{inf, inf, inf, 0.0f}}, 1, {.curve = curve})[0], 0xffffffffu) << int(curve);
    }
}

TEST(Tonemap, TheLinearImageIsKept) {
    ImageF image{2, 1, {"R", "G", "B"}, {0.25f, 3, 1e-6f, 100, -1, 0.5f}, {}};
    const auto file =
        std::filesystem::temp_directory_path() / ("heliograph-tone-" + std::to_string(getpid()) + ".exr");
    saveImage(file, image, {.exposure = 4, .curve = ToneCurve::Aces});
    EXPECT_EQ(loadImage(file).data, image.data);
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace helio::test
