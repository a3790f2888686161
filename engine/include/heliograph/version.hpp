#pragma once
/** @file The library's version. */
#include <string_view>

namespace helio {
/** "MAJOR.MINOR.PATCH" of the library that is linked. */
std::string_view version();
}  // namespace helio
