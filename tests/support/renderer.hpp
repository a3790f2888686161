#pragma once
/** @file The renderer of GPU tests, with the options of the shared device. */
#include "tests/support/device.hpp"

#include <heliograph/renderer.hpp>

namespace helio::test {

/** One validated renderer shared by the tests of an executable, opened at the first call. */
inline Renderer& renderer() {
    static Renderer one(deviceOptions());
    return one;
}

}  // namespace helio::test
