#pragma once
/** @file Whether this build runs under AddressSanitizer, which makes arithmetic some ten times as slow: long
 * series of numbers are shorter there, and whole in the Release build. */
namespace helio::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace helio::test
