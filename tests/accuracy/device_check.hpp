#pragma once
/** @file
 * One piece of shared code run three ways over the same inputs: on the device, in the C++ float build and in
 * the C++ double build.
 *
 *     DEVICE_CHECK(Mat3, 5e-7, (return rotationAbout(a, b);), axes, angles);
 *
 * runs `return rotationAbout(a, b);` as a function's body in GLSL and C++. Errors are the largest component's
 * difference from the double build, over the largest component's magnitude there or 1, whichever is greater
 * (over the magnitude alone with DEVICE_CHECK_RELATIVE). Prints the worst of device and host.
 */
#include "engine/core/shared.hpp"
#include "tests/support/shader_harness.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace helio::test {

struct DeviceCheckResult {
    double device = 0, host = 0;
    std::size_t index = 0;      ///< of the device's worst
    std::size_t different = 0;  ///< results that are not the host's bit by bit
};

template <typename R, typename F32, typename F64, typename... Inputs>
DeviceCheckResult deviceCheck(const std::string& body, F32 f32, F64 f64, double floor,
                              const std::vector<Inputs>&... inputs) {
    const std::vector<R> device = runOnDevice<R>(
        {"#include \"shaders/shared/math.glsl\"", "#include \"shaders/shared/color.glsl\"",
         "#include \"shaders/shared/projection.glsl\"", "#include \"shaders/shared/transform.glsl\""},
        body, inputs...);
    DeviceCheckResult result;
    constexpr std::size_t words = deviceType<R>().words;
    for (std::size_t i = 0; i < device.size(); ++i) {
        const typename DoubleOf<R>::Type exact(f64(typename DoubleOf<Inputs>::Type(inputs[i])...));
        const R host(f32(inputs[i]...));
        float onDevice[words], onHost[words];
        double wanted[words];
        std::memcpy(onDevice, &device[i], sizeof(onDevice));
        std::memcpy(onHost, &host, sizeof(onHost));
        std::memcpy(wanted, &exact, sizeof(wanted));
        double scale = floor, deviceError = 0, hostError = 0;
        for (std::size_t k = 0; k < words; ++k) {
            scale = std::max(scale, std::fabs(wanted[k]));
            const double d = std::fabs(onDevice[k] - wanted[k]), h = std::fabs(onHost[k] - wanted[k]);
            deviceError = !(d <= deviceError) ? d : deviceError;
            hostError = !(h <= hostError) ? h : hostError;
        }
        if (!(deviceError / scale <= result.device)) result.device = deviceError / scale, result.index = i;
        result.host = std::max(result.host, hostError / scale);
        result.different += std::memcmp(onDevice, onHost, sizeof(onDevice)) != 0;
    }
    return result;
}

}  // namespace helio::test

#define HELIO_UNWRAP(...) __VA_ARGS__
#define HELIO_TEXT(...) #__VA_ARGS__
#define HELIO_DEVICE_CHECK(R, floor, tolerance, body, ...)                                             \
    do {                                                                                               \
        const auto result = helio::test::deviceCheck<helio::shared32::R>(                              \
            HELIO_TEXT body,                                                                           \
            helio::test::padded([]([[maybe_unused]] auto a, [[maybe_unused]] auto b,                   \
                                   [[maybe_unused]] auto c, [[maybe_unused]] auto d) {                 \
                using namespace helio::shared32;                                                       \
                HELIO_UNWRAP body                                                                      \
            }),                                                                                        \
            helio::test::padded([]([[maybe_unused]] auto a, [[maybe_unused]] auto b,                   \
                                   [[maybe_unused]] auto c, [[maybe_unused]] auto d) {                 \
                using namespace helio::shared64;                                                       \
                HELIO_UNWRAP body                                                                      \
            }),                                                                                        \
            floor, __VA_ARGS__);                                                                       \
        std::printf("%-60.60s device %.3g, host %.3g (tolerance %.3g), %zu differ in bits\n",          \
                    HELIO_TEXT body, result.device, result.host, double(tolerance), result.different); \
        EXPECT_LE(result.device, tolerance) << HELIO_TEXT body << " at input " << result.index;        \
        EXPECT_LE(result.host, tolerance) << HELIO_TEXT body;                                          \
    } while (false)
#define DEVICE_CHECK(R, tolerance, body, ...) HELIO_DEVICE_CHECK(R, 1, tolerance, body, __VA_ARGS__)
#define DEVICE_CHECK_RELATIVE(R, tolerance, body, ...) HELIO_DEVICE_CHECK(R, 0, tolerance, body, __VA_ARGS__)

namespace helio::test {

/** A function of four as one of up to four: the rest are 0. */
template <typename F>
auto padded(F f) {
    return [f](const auto&... inputs) {
        if constexpr (sizeof...(inputs) == 1)
            return f(inputs..., 0, 0, 0);
        else if constexpr (sizeof...(inputs) == 2)
            return f(inputs..., 0, 0);
        else if constexpr (sizeof...(inputs) == 3)
            return f(inputs..., 0);
        else
            return f(inputs...);
    };
}

}  // namespace helio::test
