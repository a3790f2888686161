#pragma once
/** @file Kernels without what their constants rule out, so that no driver reads, inlines and throws it away.
 */
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace helio {

/** Takes what its constants rule out from a kernel of a variant: branches that they decide, functions that
 * nothing calls then. Interfaces, names and arithmetic stay. What cannot be trimmed is returned as it is. */
std::vector<std::uint32_t> trimmedSpirv(std::vector<std::uint32_t> spirv);

/** Of words of fewer bytes the driver makes a pipeline sooner than they are trimmed and kept. */
inline constexpr std::size_t kWorthSpecializing = 48 << 10;

/** The kernel with its specialization constants (words by constant_id; the rest at their defaults) written in
 * and trimmed: it has none left. Kept on disk between processes, as variants are. Where that cannot be done,
 * nothing: the constants are the driver's to write in. Thread-safe. */
std::vector<std::uint32_t> specializedSpirv(
    std::span<const std::uint32_t> spirv, std::span<const std::pair<std::uint32_t, std::uint32_t>> constants);

}  // namespace helio
