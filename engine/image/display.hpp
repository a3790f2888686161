#pragma once
/** @file Exposure and tone curve of images that are displayed. */
#include <heliograph/image.hpp>

#include <array>

namespace helio {

/** Linear display values of a linear colour. What is negative or no number becomes 0. */
std::array<float, 3> displayed(const std::array<float, 3>& linear, const Display& display);

}  // namespace helio
