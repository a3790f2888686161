// The preamble itself: both precisions live side by side, and constants are right to the last bit of each.
#include "engine/core/shared.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <type_traits>

namespace shared32 = helio::shared32;
namespace shared64 = helio::shared64;

TEST(SharedPreamble, TypesAndConstantsOfBothPrecisions) {
    static_assert(std::is_same_v<shared32::Real, float>);
    static_assert(std::is_same_v<shared64::Real, double>);
    EXPECT_EQ(shared32::PI, std::numbers::pi_v<float>);
    EXPECT_EQ(shared64::PI, std::numbers::pi_v<double>);
    EXPECT_EQ(shared64::INV_PI, std::numbers::inv_pi_v<double>);
    EXPECT_EQ(shared64::LN_TWO, std::numbers::ln2_v<double>);
    EXPECT_EQ(shared64::SQRT_TWO, std::numbers::sqrt2_v<double>);
    EXPECT_EQ(shared32::UNIT_ROUNDOFF, std::numeric_limits<float>::epsilon() / 2);
    EXPECT_EQ(shared64::UNIT_ROUNDOFF, std::numeric_limits<double>::epsilon() / 2);
    EXPECT_EQ(shared32::REAL_MAX, std::numeric_limits<float>::max());
    EXPECT_EQ(shared64::REAL_MAX, std::numeric_limits<double>::max());
    EXPECT_EQ(shared32::REAL_MIN_NORMAL, std::numeric_limits<float>::min());
    EXPECT_EQ(shared64::REAL_MIN_NORMAL, std::numeric_limits<double>::min());
}

TEST(SharedPreamble, LiteralsNextToDoublesAreAccepted) {
    using namespace helio::shared64;
    Vec3 v(1.0, 2.0, 3.0);
    EXPECT_EQ((v * 0.5 + 1.0).y, 2.0);
    EXPECT_EQ(shared64::max(shared64::Real(0.25), -1.0), 0.25);
    EXPECT_EQ(shared64::clamp(v, 1.5, 2.5).z, 2.5);
}
