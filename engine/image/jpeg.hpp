#pragma once
/** @file JPEG by its own library: OpenImageIO 2.4 shows what is cut off or damaged as if it were whole. */
#include "engine/image/backend.hpp"

namespace helio {

/** As ImageBackend::decode. What libjpeg mends and warns of (data that end early, codes that are none) is a
 * fault; bytes between segments, which damage leaves but some cameras too, are a remark. */
std::string decodeJpeg(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                       DecodedImage& image);

}  // namespace helio
