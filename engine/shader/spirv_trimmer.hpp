#pragma once
/** @file */
#include <cstdint>
#include <vector>

namespace helio {

/** Takes what its constants rule out from a kernel of a variant: branches that they decide, functions that
 * nothing calls then. Interfaces, names and arithmetic stay. What cannot be trimmed is returned as it is. */
std::vector<std::uint32_t> trimmedSpirv(std::vector<std::uint32_t> spirv);

}  // namespace helio
