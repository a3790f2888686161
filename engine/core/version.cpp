#include <heliograph/version.hpp>

namespace helio {
std::string_view version() { return HELIOGRAPH_VERSION; }
}  // namespace helio
