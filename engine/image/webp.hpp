#pragma once
/** @file WebP by its own library: OpenImageIO 2.4 multiplies colours by alpha on the way. */
#include "engine/image/backend.hpp"

namespace helio {

/** As ImageBackend::decode. */
std::string decodeWebp(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                       DecodedImage& image);

}  // namespace helio
