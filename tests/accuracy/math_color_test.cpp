// The sRGB curve against its definition in long double, published values and OpenImageIO's implementation.
#include "engine/core/shared.hpp"

#include <OpenImageIO/color.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace {

using namespace helio;

long double encodeReference(long double x) {
    return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}
long double decodeReference(long double x) {
    return x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L);
}

TEST(MathColor, SrgbCurveHasPublishedValues) {
    EXPECT_NEAR(shared32::encodeSrgb(0.5f), 0.7353569831L, 2e-7);
    EXPECT_NEAR(shared32::decodeSrgb(0.5f), 0.2140411405L, 1e-7);
    EXPECT_NEAR(shared32::encodeSrgb(0.18f), 0.4613561295L, 1e-7);
    EXPECT_NEAR(shared64::encodeSrgb(0.5L), 0.7353569831L, 1e-10L);
    EXPECT_NEAR(shared64::decodeSrgb(0.5L), 0.2140411405L, 1e-10L);
    EXPECT_EQ(shared32::encodeSrgb(0.f), 0.f);
    EXPECT_EQ(shared32::decodeSrgb(0.f), 0.f);
    EXPECT_NEAR(shared32::encodeSrgb(1.f), 1, 1.2e-7);
    EXPECT_EQ(shared32::decodeSrgb(1.f), 1.f);
    EXPECT_TRUE(std::isnan(shared32::encodeSrgb(NAN)));
    EXPECT_TRUE(std::isnan(shared32::decodeSrgb(NAN)));
    EXPECT_GT(shared32::encodeSrgb(INFINITY), 1e15f);
    EXPECT_EQ(shared32::encodeSrgb(-0.5f), -6.46f);
    // The published constants leave a step of 2.9e-8 where the two parts meet.
    const long double step = encodeReference(std::nextafter(0.0031308L, 1.L)) - encodeReference(0.0031308L);
    EXPECT_NEAR(std::fabs(step), 2.9e-8L, 1e-9L);
}

TEST(MathColor, SrgbCurveOverAMillionValues) {
    double worstEncode = 0, worstDecode = 0, worstDouble = 0;
    for (int i = 0; i <= 1'000'000; ++i) {
        const float x = static_cast<float>(i) * 1e-6f;
        worstEncode = std::max(worstEncode, double(std::fabs(shared32::encodeSrgb(x) - encodeReference(x))));
        worstDecode = std::max(worstDecode, double(std::fabs(shared32::decodeSrgb(x) - decodeReference(x))));
        worstDouble = std::max(worstDouble, double(std::fabs(shared64::encodeSrgb(x) - encodeReference(x))));
    }
    std::printf("sRGB worst absolute error: encode %.3g, decode %.3g, double build %.3g\n", worstEncode,
                worstDecode, worstDouble);
    EXPECT_LE(worstEncode, 2e-7);  // tolerance 1e-6
    EXPECT_LE(worstDecode, 3e-7);
    EXPECT_LE(worstDouble, 1e-15L);
}

TEST(MathColor, SrgbBytesRoundTripAndAgreeWithOpenImageIO) {
    for (int byte = 0; byte < 256; ++byte) {
        const float encoded = static_cast<float>(byte) / 255.f;
        const float linear = shared32::decodeSrgb(encoded);
        EXPECT_EQ(std::lround(shared32::encodeSrgb(linear) * 255.f), byte);
        EXPECT_NEAR(linear, OIIO::sRGB_to_linear(encoded), 1e-6);
        EXPECT_NEAR(shared32::encodeSrgb(encoded), OIIO::linear_to_sRGB(encoded), 1e-6);
    }
}

TEST(MathColor, LuminanceOfPrimariesAndWhite) {
    EXPECT_NEAR(shared64::luminance({1, 0, 0}), 0.2126390059L, 1e-10L);
    EXPECT_NEAR(shared64::luminance({0, 1, 0}), 0.7151686788L, 1e-10L);
    EXPECT_NEAR(shared64::luminance({0, 0, 1}), 0.0721923154L, 1e-10L);
    EXPECT_NEAR(shared64::luminance({1, 1, 1}), 1, 1e-15L);
    EXPECT_NEAR(shared32::luminance({1, 1, 1}), 1, 1.2e-7);
}

}  // namespace
