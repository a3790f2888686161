#pragma once
/** @file PNG by its own library: OpenImageIO 2.4 lets libpng write its complaints to standard error. */
#include "engine/image/backend.hpp"

namespace helio {

/** As ImageBackend::decode. */
std::string decodePng(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                      DecodedImage& image);

}  // namespace helio
