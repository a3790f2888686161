#pragma once
/** @file What decoders keep of a whole image while they decode it, by the file's header. */
#include <cstddef>
#include <cstdint>
#include <span>

namespace helio {

struct DecoderMemory {
    std::uint64_t bytes = 0;  ///< 0 where rows come one after the other
    std::uint32_t width = 0, height = 0;
    std::uint32_t texel = 4;  ///< bytes of one, decoded

    /** With the decoded texels. */
    std::uint64_t inAll() const { return bytes + std::uint64_t(width) * height * texel; }
};

/** An interlaced PNG's pixels, the coefficients of a JPEG whose scans refine it or hold single components, a
 * lossless WebP's pixels, those of a BMP of run lengths. */
DecoderMemory decoderMemory(std::span<const std::byte> file);

}  // namespace helio
