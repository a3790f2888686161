#include "tests/support/shader_harness.hpp"

#include <heliograph/error.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio::test {
namespace {

const Preamble none = "";

template <typename T>
void expectRoundTrip(const std::vector<T>& values) {
    const std::vector<T> back = runOnDevice<T>(none, "a", values);
    ASSERT_EQ(back.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(std::memcmp(&back[i], &values[i], sizeof(T)), 0)
            << describeWords(deviceType<T>(), &values[i]) << " came back as "
            << describeWords(deviceType<T>(), &back[i]);
    }
}

TEST(Harness, CarriesEveryTypeThereAndBackBitForBit) {
    expectRoundTrip(specialFloats());
    expectRoundTrip<glm::vec2>({{1, 2}, {3, 4}});
    expectRoundTrip<glm::vec3>({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
    expectRoundTrip<glm::vec4>({{1, 2, 3, 4}, {-5, 6, -7, 8}});
    glm::mat2 m2;
    glm::mat3 m3;
    glm::mat4 m4;
    std::iota(&m2[0][0], &m2[0][0] + 4, 1.0f);
    std::iota(&m3[0][0], &m3[0][0] + 9, 1.0f);
    std::iota(&m4[0][0], &m4[0][0] + 16, 1.0f);
    expectRoundTrip<glm::mat2>({m2, 2.0f * m2});
    expectRoundTrip<glm::mat3>({m3, 2.0f * m3});
    expectRoundTrip<glm::mat4>({m4, 2.0f * m4});
    expectRoundTrip<std::int32_t>({0, -1, std::numeric_limits<std::int32_t>::min(), 7});
    expectRoundTrip<std::uint32_t>({0, 1, 0xffffffffu});
    expectRoundTrip<glm::ivec2>({{-1, 2}});
    expectRoundTrip<glm::ivec3>({{-1, 2, -3}, {4, -5, 6}});
    expectRoundTrip<glm::ivec4>({{-1, 2, -3, 4}});
    expectRoundTrip<glm::uvec2>({{1, 2}});
    expectRoundTrip<glm::uvec3>({{1, 2, 3}, {4, 5, 6}});
    expectRoundTrip<glm::uvec4>({{1, 2, 3, 0xfffffff0u}});
}

TEST(Harness, TakesFourInputsOfDifferentTypes) {
    glm::mat4 m(2.0f);
    m[3] = {10, 20, 30, 1};
    const std::vector<glm::vec4> r =
        runOnDevice<glm::vec4>(none, "a * b + float(c) * vec4(d)", std::vector{m, m},
                               std::vector{glm::vec4(1, 2, 3, 1), glm::vec4(0, 0, 0, 1)},
                               std::vector<std::int32_t>{-1, 1}, std::vector<std::uint32_t>{100, 200});
    EXPECT_EQ(r[0], glm::vec4(12 - 100, 24 - 100, 36 - 100, 1 - 100));
    EXPECT_EQ(r[1], glm::vec4(210, 220, 230, 201));
}

TEST(Harness, TakesBodiesIncludesAndDirectives) {
    const std::vector<float> r =
        runOnDevice<float>({"#define THREE 3.0", "shaders/shared/real.glsl"},
                           "float s = 0.0;\nfor (int i = 0; i < 4; ++i) s += THREE * square(a);\nreturn s;",
                           std::vector{1.0f, 2.0f});
    EXPECT_EQ(r, (std::vector{12.0f, 48.0f}));
}

TEST(Harness, HandlesMoreInputsThanOneDispatchTakes) {
    std::vector<std::uint32_t> values((std::size_t(1) << 21) + 77);
    std::iota(values.begin(), values.end(), 0u);
    const std::vector<std::uint32_t> results = runOnDevice<std::uint32_t>(none, "a * 3u + 1u", values);
    ASSERT_EQ(results.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(results[i], values[i] * 3u + 1u) << i;
    EXPECT_TRUE(runOnDevice<float>(none, "a", std::vector<float>{}).empty());
}

TEST(Harness, ReportsTheWorstInput) {
    std::vector<float> x = floatsBetween(1.0f, 1.75f, 1000);
    x[123] = 1.5f;
    const UlpReport exact = compareOnDevice<float>(
        none, "sqrt(a)", [](double a) { return std::sqrt(a); }, x);
    EXPECT_LE(exact.worst, 0.5000001) << exact;  // correctly rounded on lavapipe
    EXPECT_EQ(exact.count, x.size());
    EXPECT_GT(exact.mean, 0.2) << exact;  // 0.25 on average for results spread evenly between floats
    EXPECT_LT(exact.mean, 0.3) << exact;

    // Seven units too much at one input only.
    const UlpReport wrong = compareOnDevice<float>(
        none, "uintBitsToFloat(floatBitsToUint(a) + (a == 1.5 ? 7u : 0u))", [](double a) { return a; }, x);
    EXPECT_EQ(wrong.worst, 7.0) << wrong;
    EXPECT_EQ(x[wrong.index], 1.5f) << wrong;
    EXPECT_EQ(wrong.input, "a = 1.5 [0x3fc00000]");
}

TEST(Harness, ComparesVectorsByComponentOrByTheirLargest) {
    const std::vector v{glm::vec3(1024, 1, 0)};
    const auto reference = [](glm::dvec3 a) { return a; };
    const std::string expression = "a + vec3(0.0, 0.0001220703125, 0.0)";  // 2^-13: an ulp of 1024
    EXPECT_EQ(compareOnDevice<glm::vec3>(none, expression, reference, v).worst, 1024.0);
    const UlpReport largest = compareOnDevice<glm::vec3>(none, expression, reference, UlpScale::Largest, v);
    EXPECT_EQ(largest.worst, 1.0) << largest;
    EXPECT_EQ(largest.component, 1u);
}

TEST(Harness, NanOnOneSideIsInfinitelyFar) {
    const auto report = compareOnDevice<float>(
        none, "a", [](double) { return 1.0; },
        std::vector{1.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f});
    EXPECT_TRUE(std::isinf(report.worst));
    EXPECT_EQ(report.index, 1u);
}

TEST(Harness, ErrorsNameTheExpressionsLine) {
    try {
        runOnDevice<float>(none, "float s = a;\nreturn s + nothing;", std::vector{1.0f});
        FAIL();
    } catch (const ShaderError& error) {
        EXPECT_NE(std::string(error.what()).find("\nexpression:2: 'nothing' : undeclared"), std::string::npos)
            << error.what();
    }
}

TEST(Inputs, FloatsBetweenCoverTheBinades) {
    const std::vector<float> x = floatsBetween(-1.0f, 1.0f, 1001);
    EXPECT_EQ(x.front(), -1.0f);
    EXPECT_EQ(x.back(), 1.0f);
    EXPECT_EQ(x[500], 0.0f);
    EXPECT_TRUE(std::is_sorted(x.begin(), x.end()));
    // Half of the floats of (0, 1] lie below 2^-63.
    EXPECT_NEAR(x[750], std::ldexp(1.0, -63), std::ldexp(1.0, -63));
}

}  // namespace
}  // namespace helio::test
