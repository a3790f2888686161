#pragma once
/** @file Whether this build runs under AddressSanitizer, which makes arithmetic some ten times as slow: long
 * series of numbers are shorter there, and whole in the Release build. */
namespace helio::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/** How long a series of numbers is that has `whole` in the Release build. */
constexpr int series(int whole) {
    return kSanitized ? whole / 10 : whole;
}

}  // namespace helio::test
